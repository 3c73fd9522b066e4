#pragma once
#include <atomic>

#include "src/catalogue.hpp"
#include "src/reference_states.hpp"
#include "src/scene.hpp"

namespace gnomon {

/// The state at t_end by the catalogue's reference solvers, for motions so stiff that the explicit methods
/// are out of reach. Each solver runs at two tolerances; the bound is twice the largest of its own change and
/// of its distance from the first solver's tight solution, which is the reference. Without a kind if a run
/// does not end well within `time_limit` seconds,
/// or `stop` becomes true.
ReferenceStates solver_reference(const Catalogue& catalogue, const Scene& scene, double time_limit = 20.0,
                                 const std::atomic<bool>* stop = nullptr);

}  // namespace gnomon
