#include "src/solver_reference.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace gnomon {

ReferenceStates solver_reference(const Catalogue& catalogue, const Scene& scene, double time_limit,
                                 const std::atomic<bool>* stop) {
  ReferenceStates reference, none;
  const AnyModel& model = *scene.model;
  const double deadline = wall_seconds() + time_limit;
  std::vector<double> bound(model.metrics().size(), 0.0);
  const auto widen = [&](const std::vector<double>& a, const std::vector<double>& b) {
    const std::vector<double> distance = model.distance(a, b);
    for (std::size_t k = 0; k < bound.size(); ++k) bound[k] = std::max(bound[k], 2.0 * distance[k]);
  };
  for (const ReferenceSolver& solver : catalogue.reference_solvers) {
    const Pair* pair = catalogue.pair(solver.integrator, model);
    if (!pair) {
      none.message = fmt::format("{} does not run on the model", solver.integrator);
      return none;
    }
    std::vector<double> states[2];
    for (int k = 0; k < 2; ++k) {
      RunSpec spec;
      spec.t_end = scene.t_end;
      spec.tol = k == 0 ? solver.loose : solver.tight;
      spec.record = false;
      spec.stop = stop;
      spec.time_limit = std::max(0.1, deadline - wall_seconds());
      const RunResult result = pair->run(model.get(), spec);
      if (result.status != Status::ok) {
        none.message = fmt::format("{}, tolerance {:g}: {}", solver.integrator, *spec.tol, result.message);
        return none;
      }
      states[k] = result.state;
    }
    if (reference.states.empty()) reference.states = {states[1]};
    widen(states[0], states[1]);
    widen(states[1], reference.states.front());
    reference.methods.push_back(
        fmt::format("{}, tolerances {:g} and {:g}", solver.integrator, solver.tight, solver.loose));
  }
  if (reference.states.empty()) return none;
  reference.kind = "certified";
  reference.times = {scene.t_end};
  reference.bounds = {bound};
  return reference;
}

}  // namespace gnomon
