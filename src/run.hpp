#pragma once
#include <fmt/format.h>
#include <algorithm>

#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/measure/drift.hpp"
#include "src/measure/timing.hpp"
#include "src/model.hpp"
#include "src/ode.hpp"
#include "src/scheme.hpp"
#include "src/status.hpp"

namespace gnomon {

/// How one run is to be made. Exactly one of step and tol is set; a closed form needs neither.
struct RunSpec {
  double t_end = 1.0;            ///< s
  std::optional<double> step;    ///< requested step, s; the used one is t_end / ceil(t_end/step - 1e-9)
  std::optional<double> tol;     ///< rtol; atol is this times the scale of each component class
  int samples = 0;               ///< equally spaced states to keep, the start not counted; solvers stop there
  int watch = 256;               ///< jittered times at which the invariants are looked at
  bool record = true;            ///< false: only integrate, to be timed
  long max_steps = 100'000'000;  ///< steps
  double time_limit = 600.0;     ///< s of wall-clock time
  SchemeOptions scheme;          ///< of schemes of equal steps
  const std::atomic<bool>* stop = nullptr;  ///< becomes true when the user interrupts
};

/// Invariants along a run: values are times x components.
struct Trace {
  std::vector<double> t;
  std::vector<double> values;
};

struct RunResult {
  Status status = Status::ok;
  std::string message;
  double t = 0.0;              ///< time reached, s
  std::optional<double> step;  ///< the step used, s; none for adaptive solvers and closed forms
  std::vector<double> state;   ///< flattened model state at t, the last good one
  Trace invariants;
  std::vector<double> sample_times;          ///< the start first
  std::vector<std::vector<double>> samples;  ///< flattened model states
  Cost cost;
  double cpu_seconds = 0.0;  ///< CPU time of the threads that integrate, of the integration alone
  std::vector<std::string> flags;
  std::vector<double> own_bound;  ///< of a closed form that bounds its errors: by metric, at t
};

/// Number of equal steps and their size for a requested step, and whether they miss a break of the data.
struct StepPlan {
  long count;
  double h;
  bool misses_break;
};
StepPlan plan_steps(double t_end, double requested, const std::vector<double>& breaks);

/// The step indices at which a fixed-step run is looked at, ascending, each with what to keep there.
struct Stop {
  long index;
  bool watch;
  bool sample;
};
std::vector<Stop> plan_stops(const RunSpec& spec, const StepPlan& plan,
                             const std::vector<InvariantInfo>& infos);

bool all_finite(const std::vector<double>& values);
double wall_seconds();
/// What a failed step means to the user.
std::string failure_message(Status status, long step_index, double t, double h, bool by_scheme = false);
/// The same for a run that a limit ended.
std::string limit_message(Status status, const RunSpec& spec);

namespace detail {

/// Keeps what a run's caller wants to see of the states it passes.
template <Model M>
class Recorder {
 public:
  Recorder(const M& model, RunResult& result) : model_(model), result_(result) {
    for (const InvariantInfo& info : model.invariant_info()) count_ += static_cast<std::size_t>(info.size);
  }
  void watch(double t, const typename M::State& state) {
    Trace& trace = result_.invariants;
    trace.t.push_back(t);
    trace.values.resize(trace.values.size() + count_);
    model_.invariants(t, state, trace.values.data() + trace.values.size() - count_);
  }
  void sample(double t, const typename M::State& state) {
    result_.sample_times.push_back(t);
    result_.samples.push_back(model_.flatten(state));
  }

 private:
  const M& model_;
  RunResult& result_;
  std::size_t count_ = 0;
};

/// The scheme's start, with the user's options where it takes any.
template <Model M, FixedStepOn<M> S>
auto start_of(const M& model, const RunSpec& spec) {
  if constexpr (requires { S::start(model, model.initial(), spec.scheme); })
    return S::start(model, model.initial(), spec.scheme);
  else
    return S::start(model, model.initial());
}

/// CPU time of a run so far: that of this thread and, where a scheme has helpers, of theirs [s].
template <class S, class State>
double run_cpu_seconds(const State& state) {
  if constexpr (requires { S::helper_cpu_seconds(state); })
    return thread_cpu_seconds() + S::helper_cpu_seconds(state);
  else
    return thread_cpu_seconds();
}

/// The inner loop, from step n to step `to`. Stops at the first step that fails.
template <Model M, FixedStepOn<M> S>
[[gnu::noinline]] Status march(const M& model, typename S::template State<M>& state, long& n, long to,
                               double h) {
  for (; n < to; ++n) {
    const Status status = S::step(model, state, static_cast<double>(n) * h, h);
    if (status != Status::ok) return status;
  }
  return Status::ok;
}

}  // namespace detail

/// Integrates with equal steps. Whether the state is still finite, the time limit and an interruption are
/// looked at every few milliseconds; after a failure the last stretch is repeated step by step up to the last
/// good state.
template <Model M, FixedStepOn<M> S>
RunResult run_fixed(const M& model, const RunSpec& spec) {
  RunResult result;
  const StepPlan plan = plan_steps(spec.t_end, *spec.step, model.breaks());
  result.step = plan.h;
  if (plan.misses_break) result.flags.push_back("misses a break of the data");
  const long last = std::min(plan.count, spec.max_steps);

  auto state = detail::start_of<M, S>(model, spec);
  std::string caution;
  if constexpr (requires { S::caution(model, state, plan.h); }) caution = S::caution(model, state, plan.h);
  if (!caution.empty()) {
    caution += " about the start";
    result.flags.push_back(caution);
  }
  auto checkpoint = state;
  const auto finite = [&](const auto& s) { return all_finite(model.flatten(S::view(model, s))); };
  detail::Recorder<M> recorder(model, result);
  std::vector<Stop> stops = plan_stops(spec, plan, model.invariant_info());
  if (spec.record) recorder.watch(0.0, model.initial());
  if (spec.samples > 0) recorder.sample(0.0, model.initial());

  const double deadline = wall_seconds() + spec.time_limit;
  if (spec.samples > 0 && plan.count % spec.samples != 0)
    result.flags.push_back("samples are taken at the nearest steps");
  long n = 0, chunk = 64;
  std::size_t next = 0;
  while (n < last && result.status == Status::ok) {
    while (next < stops.size() && stops[next].index <= n) ++next;
    const long start = n;
    const long to = std::min({n + chunk, last, next < stops.size() ? stops[next].index : last});
    checkpoint = state;
    const double begin = detail::run_cpu_seconds<S>(state);
    result.status = detail::march<M, S>(model, state, n, to, plan.h);
    const double spent = detail::run_cpu_seconds<S>(state) - begin;
    result.cpu_seconds += spent;
    if (to - start == chunk && spent < 5e-3) chunk *= 2;
    if (result.status != Status::ok || !finite(state)) {
      const Status failure = result.status == Status::ok ? Status::diverged : result.status;
      const bool by_scheme = result.status == Status::diverged;
      state = checkpoint;
      for (n = start; n < to; ++n) {
        checkpoint = state;
        const Status status = S::step(model, state, static_cast<double>(n) * plan.h, plan.h);
        if (status != Status::ok || !finite(state)) break;
      }
      state = checkpoint;
      result.status = failure;
      result.message = failure_message(failure, n, static_cast<double>(n) * plan.h, plan.h, by_scheme);
      if (!caution.empty()) result.message += ": " + caution;
      break;
    }
    if constexpr (requires { S::caution(model, state, plan.h); })
      if (caution.empty() && !(caution = S::caution(model, state, plan.h)).empty()) {
        caution += fmt::format(" about t = {:.3g} s", static_cast<double>(n) * plan.h);
        result.flags.push_back(caution);
      }
    if (next < stops.size() && stops[next].index == n) {
      const double t = n == plan.count ? spec.t_end : static_cast<double>(n) * plan.h;
      if (stops[next].watch) recorder.watch(t, S::view(model, state));
      if (stops[next].sample) recorder.sample(t, S::view(model, state));
    }
    if (n < last && spec.stop && spec.stop->load(std::memory_order_relaxed))
      result.status = Status::interrupted;
    if (n < last && wall_seconds() > deadline) result.status = Status::time_limit;
  }
  if (result.status == Status::ok && n < plan.count) result.status = Status::step_limit;
  if (result.status != Status::ok && result.message.empty())
    result.message = limit_message(result.status, spec);
  result.t = n == plan.count ? spec.t_end : static_cast<double>(n) * plan.h;
  result.state = model.flatten(S::view(model, state));
  result.cost = S::cost(model, state, n);
  return result;
}

/// Evaluates a closed form at the end, at the samples and at the watched times.
template <Model M, ClosedFormOn<M> S>
RunResult run_closed_form(const M& model, const RunSpec& spec) {
  RunResult result;
  detail::Recorder<M> recorder(model, result);
  if (spec.record) {
    recorder.watch(0.0, model.initial());
    for (double t : jittered_times(0.0, spec.t_end, spec.watch, 1)) recorder.watch(t, S::at(model, t));
  }
  for (int k = 0; k <= spec.samples && spec.samples > 0; ++k) {
    const double t = spec.t_end * k / spec.samples;
    recorder.sample(t, S::at(model, t));
  }
  const double begin = thread_cpu_seconds();
  const typename M::State state = S::at(model, spec.t_end);
  result.cpu_seconds = thread_cpu_seconds() - begin;
  result.t = spec.t_end;
  result.state = model.flatten(state);
  result.cost.rhs = 1;
  if constexpr (requires { S::error_bound(model, spec.t_end); }) {
    const auto bound = S::error_bound(model, spec.t_end);
    result.own_bound.assign(bound.begin(), bound.end());
  }
  if (!all_finite(result.state)) {
    result.status = Status::diverged;
    result.message = "the closed form gave a value that is not finite";
  }
  return result;
}

/// One integration in progress by a solver that chooses its own steps.
class AdaptiveSolver {
 public:
  static constexpr long step_window = 20'000;
  virtual ~AdaptiveSolver() = default;
  /// Goes on to t_stop exactly, or by one internal step that does not pass it. Without `one_step` it may come
  /// back earlier with Status::step_limit, after `step_window` steps or the run's limit, to be called again.
  /// After a failure `message` says why and t and y are those of the last good step.
  virtual Status advance(double t_stop, bool one_step) = 0;
  /// Forgets the past, for data that jump at the present time.
  virtual void restart() = 0;
  virtual double t() const = 0;
  virtual const double* y() const = 0;
  virtual Cost cost() const = 0;
  virtual std::string message() const = 0;
};

/// Integrates with a solver that chooses its own steps; invariants are taken at its own steps, never
/// interpolated.
RunResult run_adaptive(AdaptiveSolver& solver, const FirstOrderSystem& system,
                       const std::vector<InvariantInfo>& infos, const RunSpec& spec);

/// An adaptive scheme names the form of the model that it integrates and makes a solver on it.
template <class S, class M>
concept AdaptiveOn = Scheme<S> && Model<M> && requires(const M& model, const RunSpec& spec) {
  { S::make(*S::system(model), spec) } -> std::same_as<std::unique_ptr<AdaptiveSolver>>;
};

template <class S, class M>
concept Runs = FixedStepOn<S, M> || ClosedFormOn<S, M> || AdaptiveOn<S, M>;

/// Runs scheme S on a model, whichever kind of scheme it is.
template <Model M, Runs<M> S>
RunResult run(const M& model, const RunSpec& spec) {
  if constexpr (FixedStepOn<S, M>) {
    return run_fixed<M, S>(model, spec);
  } else if constexpr (ClosedFormOn<S, M>) {
    return run_closed_form<M, S>(model, spec);
  } else {
    const auto system = S::system(model);
    const auto solver = S::make(*system, spec);
    return run_adaptive(*solver, *system, model.invariant_info(), spec);
  }
}

}  // namespace gnomon
