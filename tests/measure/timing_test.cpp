#include "src/measure/timing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "tests/catch.hpp"

using gnomon::measure_interleaved;
using gnomon::summarise;
using gnomon::TimedTask;
using gnomon::TimingPlan;
using gnomon::TimingStats;

namespace {

// Tasks that take no time but report a scripted one, on a clock of their own.
struct Stage {
  double now = 0.0;
  std::string calls;  // one letter for each call

  TimedTask task(char name, double seconds, double set_up = 0.0) {
    return {[this, name, seconds, set_up] {
      calls += name;
      now += set_up + seconds;
      return seconds;
    }};
  }
  TimingPlan plan(int repetitions, double min_seconds) {
    TimingPlan p;
    p.repetitions = repetitions;
    p.min_seconds = min_seconds;
    p.warm_seconds = std::numeric_limits<double>::infinity();
    p.clock = [this] { return now; };
    return p;
  }
};

// Lengths of the runs of equal letters.
std::vector<int> batches(const std::string& calls) {
  std::vector<int> lengths;
  for (std::size_t i = 0; i < calls.size(); ++i) {
    if (i == 0 || calls[i] != calls[i - 1]) lengths.push_back(0);
    ++lengths.back();
  }
  return lengths;
}

}  // namespace

TEST_CASE("measure: timing statistics") {
  const TimingStats stats = summarise({5.0, 1.0, 2.0, 10.0, 4.0});
  CHECK(stats.median == 4.0);
  CHECK(stats.min == 1.0);
  CHECK(stats.max == 10.0);
  CHECK(stats.mdape == 0.5);  // deviations 1, 3, 2, 6, 0
  CHECK(stats.repetitions == 5);
  CHECK(stats.unstable);

  const TimingStats steady = summarise({1.0, 1.04, 0.96, 1.0, 3.0});
  CHECK(std::abs(steady.mdape - 0.04) <= 1e-12);
  CHECK_FALSE(steady.unstable);
  CHECK(summarise({1.0, 1.06, 0.94, 1.0, 3.0}).unstable);

  const TimingStats none = summarise({});
  CHECK(none.repetitions == 0);
  CHECK(std::isnan(none.median));
  CHECK(std::isnan(none.min));
  CHECK_FALSE(none.unstable);
  CHECK(summarise({0.0, 0.0}).mdape == 0.0);
}

TEST_CASE("measure: long tasks are called once each in turn after one discarded call") {
  Stage stage;
  const std::vector<TimedTask> tasks{stage.task('a', 1.0), stage.task('b', 2.0), stage.task('c', 3.0)};
  const auto stats = measure_interleaved(tasks, stage.plan(4, 0.02), nullptr);
  CHECK(stage.calls == "abcabcabcabcabc");
  REQUIRE(stats.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(stats[i].repetitions == 4);
    CHECK(stats[i].median == static_cast<double>(i + 1));
    CHECK(stats[i].mdape == 0.0);
  }
}

TEST_CASE("measure: the first call does not count") {
  Stage stage;
  int calls = 0;
  const std::vector<TimedTask> tasks{{[&] { return ++calls == 1 ? 9.0 : 1.0; }}};
  TimingPlan plan = stage.plan(3, 0.02);
  auto stats = measure_interleaved(tasks, plan, nullptr);
  CHECK(calls == 4);
  CHECK(stats[0].max == 1.0);

  // Unless it is so long that its beginning does not matter.
  for (const double warm : {9.0, 9.1}) {
    calls = 0;
    plan.warm_seconds = warm;
    stats = measure_interleaved(tasks, plan, nullptr);
    CHECK(stats[0].repetitions == 3);
    CHECK(calls == (warm > 9.0 ? 4 : 3));
    CHECK(stats[0].max == (warm > 9.0 ? 1.0 : 9.0));
  }
}

TEST_CASE("measure: short tasks are batched to the least time, with up to a fifth more calls") {
  Stage stage;
  const std::vector<TimedTask> tasks{stage.task('a', 1.0 / 1024), stage.task('b', 1.0)};
  const auto stats = measure_interleaved(tasks, stage.plan(40, 19.5 / 1024), nullptr);
  const std::vector<int> lengths = batches(stage.calls);
  REQUIRE(lengths.size() == 82);
  CHECK(lengths[0] == 1);
  CHECK(lengths[1] == 1);
  int shortest = 1000, longest = 0;
  for (std::size_t i = 2; i < lengths.size(); i += 2) {
    shortest = std::min(shortest, lengths[i]);
    longest = std::max(longest, lengths[i]);
    CHECK(lengths[i + 1] == 1);
  }
  CHECK(shortest == 20);
  CHECK(longest == 24);
  CHECK(stats[0].median == 1.0 / 1024);
  CHECK(stats[1].median == 1.0);
}

TEST_CASE("measure: a task too short for one call to be timed is called more often before the batch is set") {
  Stage stage;
  // The clock behind the task ticks once in 64 calls: most calls report nothing.
  int count = 0;
  const std::vector<TimedTask> tasks{{[&] { return ++count % 64 == 0 ? 0.01 : 0.0; }}};
  const auto stats = measure_interleaved(tasks, stage.plan(5, 0.1), nullptr);
  // 1 + 4 + 16 calls report nothing, 64 report one tick; then 640 to 768 calls make a batch.
  CHECK(count >= 85 + 5 * 640);
  CHECK(count <= 85 + 5 * 768);
  CHECK(stats[0].repetitions == 5);
  CHECK(std::abs(stats[0].median - 0.01 / 64) <= 0.1 * 0.01 / 64);
}

TEST_CASE("measure: the cost of the timer is subtracted from every run, never below zero") {
  Stage stage;
  TimingPlan plan = stage.plan(2, 0.0);
  plan.timer_cost = 0.25;
  const auto stats = measure_interleaved({stage.task('a', 1.0), stage.task('b', 0.125)}, plan, nullptr);
  CHECK(stats[0].median == 0.75);
  CHECK(stats[1].median == 0.0);
}

TEST_CASE("measure: the budget ends the measurement between rounds, set-up included") {
  Stage stage;
  const std::vector<TimedTask> tasks{stage.task('a', 1.0, 1.0), stage.task('b', 1.0, 2.0)};
  TimingPlan plan = stage.plan(100, 0.02);
  plan.budget_seconds = 21.0;  // a round takes 5 seconds: the warm-up and three rounds fit
  auto stats = measure_interleaved(tasks, plan, nullptr);
  CHECK(stats[0].repetitions == 3);
  CHECK(stats[1].repetitions == 3);
  CHECK(stage.now == 20.0);

  plan.budget_seconds = 0.0;
  stats = measure_interleaved(tasks, plan, nullptr);
  CHECK(stats[0].repetitions == 1);
  CHECK(stats[1].repetitions == 1);
}

TEST_CASE("measure: of a budget too small for all, the short runs get their repetitions") {
  Stage stage;
  const std::vector<TimedTask> tasks{stage.task('a', 10.0), stage.task('b', 1.0), stage.task('c', 2.0)};
  TimingPlan plan = stage.plan(5, 0.02);
  plan.budget_seconds = 2 * 13.0 + 4 * 3.0 + 10.5;  // warm-up and first round, then b and c, and one of a
  const auto stats = measure_interleaved(tasks, plan, nullptr);
  CHECK(stats[0].repetitions == 2);
  CHECK(stats[1].repetitions == 5);
  CHECK(stats[2].repetitions == 5);
  CHECK(stage.now <= plan.budget_seconds);
  CHECK(stats[0].unstable);
  CHECK_FALSE(stats[1].unstable);

  // One that takes the whole budget at once leaves the others a tenth of it.
  plan.budget_seconds = 100.0;
  const auto late = measure_interleaved({stage.task('a', 1000.0), stage.task('b', 1.0)}, plan, nullptr);
  CHECK(late[0].repetitions == 1);
  CHECK(late[1].repetitions == 5);
}

TEST_CASE("measure: stopping keeps the finished repetitions and discards the begun one") {
  Stage stage;
  const std::vector<TimedTask> tasks{stage.task('a', 1.0), stage.task('b', 0.25)};
  TimingPlan plan = stage.plan(10, 1.0);  // b in batches of four
  const auto stats = measure_interleaved(tasks, plan, [&] { return stage.calls.size() >= 10; });
  CHECK(stage.calls == "ababbbbabb");
  CHECK(stats[0].repetitions == 2);
  CHECK(stats[1].repetitions == 1);

  stage.calls.clear();
  const auto none = measure_interleaved(tasks, plan, [] { return true; });
  CHECK(stage.calls.empty());
  CHECK(none[0].repetitions == 0);
}

TEST_CASE("measure: a failed task is left out of the later rounds") {
  Stage stage;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  int calls = 0;
  const std::vector<TimedTask> tasks{
      {[&] { return ++calls == 3 ? nan : 1.0; }}, stage.task('b', 1.0), {[&] { return nan; }}};
  const auto stats = measure_interleaved(tasks, stage.plan(5, 0.02), nullptr);
  CHECK(calls == 3);
  CHECK(stats[0].repetitions == 1);
  CHECK(stats[0].median == 1.0);
  CHECK(stats[1].repetitions == 5);
  CHECK(stats[2].repetitions == 0);
}

TEST_CASE("measure: thread CPU time never runs backwards and reading it costs something") {
  double last = gnomon::thread_cpu_seconds();
  CHECK(last > 0.0);
  double first = last;
  volatile double sink = 0.0;
  for (int i = 0; i < 1000; ++i) {
    for (int j = 0; j < 1000; ++j) sink = sink + 1.0;
    const double now = gnomon::thread_cpu_seconds();
    REQUIRE(now >= last);
    last = now;
  }
  CHECK(last > first);
  const double cost = gnomon::timer_cost();
  CHECK(std::isfinite(cost));
  CHECK(cost >= 0.0);
}
