#include "src/measure/timing.hpp"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <random>

#include "src/measure/statistics.hpp"

namespace gnomon {
namespace {

constexpr long max_batch = 1'048'576;

long batch_size(double seconds_per_run, double min_seconds) {
  const double calls = std::ceil(min_seconds / seconds_per_run);  // infinite if not even that could be timed
  if (!(calls > 1.0)) return 1;
  return calls < static_cast<double>(max_batch) ? static_cast<long>(calls) : max_batch;
}

struct TaskState {
  long batch = 1;
  bool failed = false, over = false;
  double last = 0.0;            // seconds of the budget that the last repetition took
  std::vector<double> seconds;  // per run, one entry for each repetition
};

// Total of `calls` runs; nothing if stopped or failed.
std::optional<double> run_batch(const TimedTask& task, long calls, TaskState& state,
                                const std::function<bool()>& stop) {
  double total = 0.0;
  for (long call = 0; call < calls; ++call) {
    if (stop && stop()) return std::nullopt;
    total += task.run();
    state.failed = !std::isfinite(total);
    if (state.failed) return std::nullopt;
  }
  return total;
}

}  // namespace

TimingStats summarise(const std::vector<double>& seconds) {
  TimingStats stats;
  stats.repetitions = static_cast<int>(seconds.size());
  if (seconds.empty()) return stats;
  const auto [least, most] = std::minmax_element(seconds.begin(), seconds.end());
  stats.min = *least;
  stats.max = *most;
  stats.median = median(seconds);
  std::vector<double> deviations;
  for (const double x : seconds) deviations.push_back(std::abs(x - stats.median));
  const double deviation = median(deviations);
  stats.mdape = deviation == 0.0 ? 0.0 : deviation / stats.median;
  stats.unstable = stats.mdape > 0.05 || stats.repetitions < enough_repetitions;
  return stats;
}

double thread_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double timer_cost() {
  constexpr int batches = 11;
  constexpr int calls = 1000;
  double least = std::numeric_limits<double>::infinity();
  for (int batch = 0; batch < batches; ++batch) {
    const double begin = thread_cpu_seconds();
    double end = begin;
    for (int call = 0; call < calls; ++call) end = thread_cpu_seconds();
    least = std::min(least, (end - begin) / calls);
  }
  return least;
}

std::vector<TimingStats> measure_interleaved(const std::vector<TimedTask>& tasks, const TimingPlan& plan,
                                             const std::function<bool()>& stop) {
  const double begin = plan.clock();
  std::mt19937_64 random(plan.seed);
  std::vector<TaskState> states(tasks.size());
  bool stopped = false;
  // Mean seconds of a run, over a batch of `calls`.
  const auto measure = [&](std::size_t i, long calls) -> std::optional<double> {
    const auto total = run_batch(tasks[i], calls, states[i], stop);
    stopped = !total && !states[i].failed;
    if (!total) return std::nullopt;
    return std::max(0.0, *total / static_cast<double>(calls) - plan.timer_cost);
  };

  for (std::size_t i = 0; i < tasks.size() && !stopped; ++i) {
    // A run too short for the clock is called more and more often until it can be timed roughly.
    for (long calls = 1; calls <= max_batch; calls *= 4) {
      const auto seconds = measure(i, calls);
      if (!seconds) break;
      states[i].batch = batch_size(*seconds, plan.min_seconds);
      // What is cold at its beginning does not count in so long a run: it is the first repetition.
      if (calls == 1 && *seconds >= plan.warm_seconds) {
        states[i].seconds.push_back(*seconds);
        states[i].last = *seconds;
      }
      if (*seconds * static_cast<double>(calls) >= plan.min_seconds / 20.0) break;
    }
  }

  double end = begin + plan.budget_seconds;
  std::vector<std::size_t> shortest(tasks.size());
  std::iota(shortest.begin(), shortest.end(), 0);
  for (int round = 0; round < plan.repetitions && !stopped; ++round) {
    // A few long runs may have used it up, which the short ones should not suffer for.
    if (round == 1) end = std::max(end, plan.clock() + 0.1 * plan.budget_seconds);
    if (round > 0) {
      std::ranges::stable_sort(shortest, {}, [&](std::size_t i) { return states[i].last; });
      double left = end - plan.clock();
      for (const std::size_t i : shortest) {
        const double all = states[i].last * (plan.repetitions - round);
        if (all > left && states[i].last > left) states[i].over = true;
        if (!states[i].over) left -= all <= left ? all : states[i].last;
      }
    }
    for (std::size_t i = 0; i < tasks.size() && !stopped; ++i) {
      if (states[i].failed || states[i].over || (round == 0 && !states[i].seconds.empty())) continue;
      const double from = plan.clock();
      const auto extra = static_cast<long>(random() % static_cast<std::uint64_t>(states[i].batch / 5 + 1));
      if (const auto seconds = measure(i, states[i].batch + extra)) states[i].seconds.push_back(*seconds);
      states[i].last = plan.clock() - from;
    }
  }

  std::vector<TimingStats> stats;
  for (const TaskState& state : states) stats.push_back(summarise(state.seconds));
  return stats;
}

}  // namespace gnomon
