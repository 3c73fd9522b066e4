#pragma once
#include <atomic>

#include "src/catalogue.hpp"
#include "src/reference_states.hpp"
#include "src/scene.hpp"

namespace gnomon {

/// The state at t_end by the first two of the catalogue's reference solvers that come to it, adaptive ones
/// first, for motions so stiff that the explicit methods are out of reach. An adaptive solver runs at two
/// tolerances; one of equal steps halves them until that changes the solution less than the other solver is
/// uncertain, or to no end, or its time is over. The bound is twice the largest of the last change of each
/// solver and of their distance; the first solver's tight solution is the reference. Without a kind if fewer
/// than two solvers end well, each within its share of `time_limit` seconds, or `stop` becomes true.
ReferenceStates solver_reference(const Catalogue& catalogue, const Scene& scene, double time_limit = 60.0,
                                 const std::atomic<bool>* stop = nullptr);

}  // namespace gnomon
