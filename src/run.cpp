#include "src/run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <map>

namespace gnomon {

StepPlan plan_steps(double t_end, double requested, const std::vector<double>& breaks) {
  constexpr double most = 9e15;  // beyond, a count is no longer exact in double precision
  const long count = std::lround(std::clamp(std::ceil(t_end / requested - 1e-9), 1.0, most));
  const double h = t_end / static_cast<double>(count);
  bool misses = false;
  for (double at : breaks) {
    if (at <= 0.0 || at >= t_end) continue;
    const double steps = at / h;
    misses = misses || std::abs(steps - std::round(steps)) > 1e-9 * std::max(1.0, steps);
  }
  return {count, h, misses};
}

std::vector<Stop> plan_stops(const RunSpec& spec, const StepPlan& plan,
                             const std::vector<InvariantInfo>& infos) {
  std::map<long, Stop> stops;
  const auto at = [&](double t) -> Stop& {
    const long index = std::clamp(std::lround(t / plan.h), 1L, plan.count);
    return stops.try_emplace(index, Stop{index, false, false}).first->second;
  };
  if (spec.record) {
    for (double t : jittered_times(0.0, spec.t_end, spec.watch, 1)) at(t).watch = true;
    for (const InvariantInfo& info : infos)
      if (info.since > 0.0 && info.since < spec.t_end) at(info.since).watch = true;
  }
  for (int k = 1; k <= spec.samples; ++k) at(spec.t_end * k / spec.samples).sample = true;
  std::vector<Stop> list;
  for (const auto& [index, stop] : stops) list.push_back(stop);
  return list;
}

bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string failure_message(Status status, long step_index, double t, double h, bool by_scheme) {
  const char* what = "the step failed";
  if (status == Status::newton_failed) what = "Newton's iteration did not converge";
  if (status == Status::diverged)
    what = by_scheme ? "the motion grew beyond any scale" : "the state was no longer finite";
  return fmt::format("{} in step {} from t = {:.6g} s, step {:.3g} s", what, step_index + 1, t, h);
}

std::string limit_message(Status status, const RunSpec& spec) {
  switch (status) {
    case Status::step_limit:
      return fmt::format("reached --max-steps {}", spec.max_steps);
    case Status::time_limit:
      return fmt::format("reached --time-limit {:g} s", spec.time_limit);
    case Status::interrupted:
      return "interrupted";
    default:
      return "";
  }
}

namespace {

/// Copies what the caller wants to see out of an adaptive run.
class SystemRecorder {
 public:
  SystemRecorder(const FirstOrderSystem& system, RunResult& result)
      : system_(system), result_(result), count_(static_cast<std::size_t>(system.invariant_count())) {}
  void watch(double t, const double* y) {
    Trace& trace = result_.invariants;
    trace.t.push_back(t);
    trace.values.resize(trace.values.size() + count_);
    system_.invariants(t, y, trace.values.data() + trace.values.size() - count_);
  }
  void sample(double t, const double* y) {
    result_.sample_times.push_back(t);
    result_.samples.push_back(system_.model_state(t, y));
  }

 private:
  const FirstOrderSystem& system_;
  RunResult& result_;
  std::size_t count_;
};

/// Notices a solver that takes steps without end and comes nowhere: at the pace of its last steps the end
/// would be more than 1e12 steps away.
class StallGuard {
 public:
  static constexpr long window = AdaptiveSolver::step_window;
  explicit StallGuard(double t_end) : t_end_(t_end) {}
  bool stalls(double t, long steps) {
    if (steps < next_) return false;
    progress_ = t - t_;
    next_ = steps + window;
    t_ = t;
    return (t_end_ - t) * static_cast<double>(window) > progress_ * 1e12;
  }
  double progress() const { return progress_; }

 private:
  double t_end_, t_ = 0.0, progress_ = 0.0;
  long next_ = window;
};

}  // namespace

RunResult run_adaptive(AdaptiveSolver& solver, const FirstOrderSystem& system,
                       const std::vector<InvariantInfo>& infos, const RunSpec& spec) {
  RunResult result;
  SystemRecorder recorder(system, result);

  // Times at which the solver has to stop, and what to do there.
  struct Halt {
    bool sample = false, jump = false, watch = false;
  };
  std::map<double, Halt> halts;
  halts[spec.t_end];
  for (int k = 1; k <= spec.samples; ++k)
    halts[k == spec.samples ? spec.t_end : spec.t_end * k / spec.samples].sample = true;
  for (double at : system.breaks())
    if (at > 0.0 && at < spec.t_end) halts[at].jump = true;
  if (spec.record)
    for (const InvariantInfo& info : infos)
      if (info.since > 0.0 && info.since < spec.t_end) halts[info.since].watch = true;

  std::vector<double> watches;
  if (spec.record) {
    watches = jittered_times(0.0, spec.t_end, spec.watch, 1);
    recorder.watch(0.0, solver.y());
  }
  if (spec.samples > 0) recorder.sample(0.0, solver.y());

  const double deadline = wall_seconds() + spec.time_limit;
  std::size_t next_watch = 0;
  StallGuard stall(spec.t_end);
  for (const auto& [until, halt] : halts) {
    while (result.status == Status::ok && solver.t() < until) {
      const double begin = thread_cpu_seconds();
      result.status = solver.advance(until, spec.record);
      result.cpu_seconds += thread_cpu_seconds() - begin;
      if (result.status == Status::step_limit) result.status = Status::ok;  // only of this call
      if (result.status != Status::ok) {
        result.message = solver.message();
        break;
      }
      if (spec.record && next_watch < watches.size() && solver.t() >= watches[next_watch]) {
        recorder.watch(solver.t(), solver.y());
        while (next_watch < watches.size() && watches[next_watch] <= solver.t()) ++next_watch;
      }
      if (solver.t() >= spec.t_end) break;
      const long steps = solver.cost().steps;
      if (!all_finite(system.model_state(solver.t(), solver.y()))) {
        result.status = Status::diverged;
      } else if (stall.stalls(solver.t(), steps)) {
        result.status = Status::solver_failed;
        result.message = fmt::format("stalls at t = {:.6g} s: {} steps brought it {:.2g} s further",
                                     solver.t(), StallGuard::window, stall.progress());
      } else if (steps >= spec.max_steps) {
        result.status = Status::step_limit;
      } else if (wall_seconds() > deadline) {
        result.status = Status::time_limit;
      } else if (spec.stop && spec.stop->load(std::memory_order_relaxed)) {
        result.status = Status::interrupted;
      }
    }
    if (result.status != Status::ok) break;
    if (halt.watch) recorder.watch(solver.t(), solver.y());
    if (halt.sample) recorder.sample(solver.t(), solver.y());
    if (halt.jump) solver.restart();
  }
  result.t = solver.t();
  result.state = system.model_state(solver.t(), solver.y());
  result.cost = solver.cost();
  if (result.status == Status::ok && !all_finite(result.state)) result.status = Status::diverged;
  if (result.message.empty()) {
    if (result.status == Status::diverged)
      result.message = "the state was no longer finite";
    else if (result.status != Status::ok)
      result.message = limit_message(result.status, spec);
  }
  return result;
}

}  // namespace gnomon
