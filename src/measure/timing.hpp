#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace gnomon {

/// Times of one run, in seconds. NaN without repetitions.
struct TimingStats {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double median = none;
  double min =
      none;  ///< the best estimate for a deterministic program: disturbances only add (Chen & Revels 2016)
  double max = none;
  double mdape = none;  ///< median(|x - median|) / median
  int repetitions = 0;
  bool unstable = false;  ///< mdape > 0.05, or too few repetitions to say
};

/// Fewer repetitions say nothing of the spread.
inline constexpr int enough_repetitions = 5;
/// What the mark of unstable times means, for tables.
inline constexpr const char* unstable_note =
    "* repetitions differ by more than 5 % (median deviation), or there was time for fewer than five: read "
    "with care";

TimingStats summarise(const std::vector<double>& seconds);

/// CPU time used by the calling thread, in seconds.
double thread_cpu_seconds();

/// What one call of thread_cpu_seconds costs here, in seconds: the minimum over several batches.
double timer_cost();

/// One integration to be timed.
struct TimedTask {
  /// Integrates once and returns the thread CPU seconds of the integration alone, without set-up and output;
  /// not finite if the integration failed.
  std::function<double()> run;
};

struct TimingPlan {
  int repetitions = 5;
  double min_seconds = 0.02;  ///< shorter runs are batched: a repetition then is the mean over the batch
  double budget_seconds = std::numeric_limits<double>::infinity();  ///< for all tasks, set-up included
  double warm_seconds = 0.5;  ///< a run of this length or more warms itself up: no call of it is discarded
  double timer_cost = 0.0;    ///< subtracted from every run
  std::uint64_t seed = 1;     ///< of the batch lengths
  std::function<double()> clock = thread_cpu_seconds;  ///< what the budget is measured with, seconds
};

/// Times the tasks in turn, one repetition each and then the next round, so that a change of the machine's
/// speed meets all alike. The first calls of each are discarded (one, more if it is too short to be timed,
/// none if it is long enough to warm itself up) and set how many make a batch; up to a fifth more are added
/// at random so that batches do not lock to a periodic disturbance. After the first round, which always runs,
/// what is left of the budget, a tenth of it at least, goes to the shortest that it can finish; others go on
/// while one repetition fits. A task that fails is not called again. `stop`, if set, is asked before every
/// call; when it says true, what is finished is returned.
std::vector<TimingStats> measure_interleaved(const std::vector<TimedTask>& tasks, const TimingPlan& plan,
                                             const std::function<bool()>& stop);

}  // namespace gnomon
