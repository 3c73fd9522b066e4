#include "src/solver_reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gnomon {
namespace {

/// Two solutions by one solver, or why there are none.
struct Attempt {
  std::vector<double> tight, loose;  ///< flattened states at t_end
  std::string method, failure;
};

class Attempts {
 public:
  Attempts(const Scene& scene, const std::atomic<bool>* stop) : scene_(scene) {
    spec_.t_end = scene.t_end;
    spec_.record = false;
    spec_.stop = stop;
  }

  /// At the solver's two tolerances.
  Attempt by_tolerance(const ReferenceSolver& solver, const Pair& pair, double seconds) {
    Attempt attempt;
    const double deadline = wall_seconds() + seconds;
    for (const double tol : {solver.loose, solver.tight}) {
      RunSpec spec = spec_;
      spec.tol = tol;
      spec.time_limit = std::max(0.1, deadline - wall_seconds());
      const RunResult result = pair.run(scene_.model->get(), spec);
      if (result.status != Status::ok) {
        attempt.failure = fmt::format("{}, tolerance {:g}: {}", solver.integrator, tol, result.message);
        return attempt;
      }
      (tol == solver.loose ? attempt.loose : attempt.tight) = result.state;
    }
    attempt.method =
        fmt::format("{}, tolerances {:g} and {:g}", solver.integrator, solver.tight, solver.loose);
    return attempt;
  }

  /// With steps that are halved until that changes no metric by more than `aim`, or the change has twice not
  /// become smaller, or the next run would take too long.
  Attempt by_halving(const ReferenceSolver& solver, const Pair& pair, double seconds,
                     const std::vector<double>& aim) {
    Attempt attempt;
    const double deadline = wall_seconds() + seconds;
    std::vector<double> last, change;
    double spent = 0.0;
    long steps = first_steps();
    for (int idle = 0; idle < 2 && wall_seconds() + 2.0 * spent < deadline; steps *= 2) {
      RunSpec spec = spec_;
      spec.step = scene_.t_end / static_cast<double>(steps);
      spec.scheme.newton_tol = 1e-12;
      spec.time_limit = std::max(0.1, deadline - wall_seconds());
      const double begin = wall_seconds();
      const RunResult result = pair.run(scene_.model->get(), spec);
      spent = wall_seconds() - begin;
      if (spec.stop && spec.stop->load(std::memory_order_relaxed)) break;
      if (result.status != Status::ok || !result.flags.empty()) {
        attempt.failure = fmt::format("{}, step {:g}: {}", solver.integrator, *spec.step,
                                      result.status == Status::ok ? result.flags.front() : result.message);
        last.clear();
        continue;
      }
      if (!last.empty()) {
        const std::vector<double> now = scene_.model->distance(last, result.state);
        idle = !change.empty() && !(now[0] < change[0]) ? idle + 1 : 0;
        if (change.empty() || now[0] < change[0]) {
          change = now;
          attempt.loose = last;
          attempt.tight = result.state;
          attempt.method =
              fmt::format("{}, steps {:.4g} and {:.4g}", solver.integrator, *result.step, 2.0 * *result.step);
        }
        if (within(change, aim)) break;
      }
      last = result.state;
    }
    if (attempt.method.empty() && attempt.failure.empty())
      attempt.failure = fmt::format("{}: its time was over", solver.integrator);
    if (!attempt.method.empty()) attempt.failure.clear();
    return attempt;
  }

 private:
  /// About one a time scale, so many that the breaks of the data are met where they can be.
  long first_steps() const {
    const auto least = static_cast<long>(std::ceil(scene_.t_end / scene_.model->time_scale()));
    for (long parts = 1; parts <= 64; ++parts) {
      const long count = std::max(1L, (std::max(least, 32L) + parts - 1) / parts) * parts;
      if (!plan_steps(scene_.t_end, scene_.t_end / static_cast<double>(count), scene_.model->breaks())
               .misses_break)
        return count;
    }
    return least;
  }
  static bool within(const std::vector<double>& change, const std::vector<double>& aim) {
    for (std::size_t k = 0; k < change.size(); ++k)
      if (k >= aim.size() || !(change[k] <= aim[k])) return false;
    return true;
  }

  const Scene& scene_;
  RunSpec spec_;
};

}  // namespace

ReferenceStates solver_reference(const Catalogue& catalogue, const Scene& scene, double time_limit,
                                 const std::atomic<bool>* stop) {
  ReferenceStates reference, none;
  const AnyModel& model = *scene.model;
  std::vector<double> bound(model.metrics().size(), 0.0);
  const auto widen = [&](const std::vector<double>& a, const std::vector<double>& b) {
    const std::vector<double> distance = model.distance(a, b);
    for (std::size_t k = 0; k < bound.size(); ++k)
      bound[k] = distance[k] <= 0.5 * bound[k] ? bound[k] : 2.0 * distance[k];
  };
  Attempts attempts(scene, stop);
  std::vector<ReferenceSolver> solvers = catalogue.reference_solvers;
  std::ranges::stable_partition(solvers, [](const ReferenceSolver& solver) { return solver.tight > 0.0; });
  for (const ReferenceSolver& solver : solvers) {
    if (reference.methods.size() == 2) break;
    const Pair* pair = catalogue.pair(solver.integrator, model);
    Attempt attempt;
    if (!pair)
      attempt.failure = fmt::format("{} does not run on the model", solver.integrator);
    else if (solver.tight > 0.0)
      attempt = attempts.by_tolerance(solver, *pair, solver.share * time_limit);
    else
      attempt = attempts.by_halving(solver, *pair, solver.share * time_limit, bound);
    if (!attempt.failure.empty()) {
      none.message += (none.message.empty() ? "" : "; ") + attempt.failure;
      continue;
    }
    if (reference.states.empty()) reference.states = {attempt.tight};
    widen(attempt.loose, attempt.tight);
    widen(attempt.tight, reference.states.front());
    reference.methods.push_back(attempt.method);
  }
  if (reference.methods.size() < 2) return none;
  reference.kind = "certified";
  reference.times = {scene.t_end};
  reference.bounds = {bound};
  return reference;
}

}  // namespace gnomon
