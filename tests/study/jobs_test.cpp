// Runs made several at a time: the same results in the same order, whatever their number.
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <new>
#include <sstream>
#include <thread>

#include "src/measure/core.hpp"
#include "src/study/compare.hpp"
#include "src/study/converge.hpp"
#include "src/study/drift_study.hpp"
#include "src/study/json.hpp"
#include "src/study/keeper.hpp"
#include "src/study/stability.hpp"
#include "src/study/stability_output.hpp"
#include "tests/catch.hpp"
#include "tests/example/pendulum.hpp"
#include "tests/output/temporary_folder.hpp"

using namespace gnomon;

namespace {

using JobJson = Keeper::Json;

/// Counts, across processes, how many are at work at a time.
class Crowd {
 public:
  Crowd()
      : counts_(static_cast<std::atomic<int>*>(::mmap(nullptr, 3 * sizeof(std::atomic<int>),
                                                      PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1,
                                                      0))) {
    for (int k = 0; k < 3; ++k) new (counts_ + k) std::atomic<int>(0);
  }
  ~Crowd() { ::munmap(counts_, 3 * sizeof(std::atomic<int>)); }
  /// Waits, a second at most, until `wanted` are here at once.
  void meet(int wanted) {
    const int here = ++counts_[0];
    for (int most = counts_[1]; most < here && !counts_[1].compare_exchange_weak(most, here);) {
    }
    for (int wait = 0; wait < 1000 && counts_[1] < wanted; ++wait)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    --counts_[0];
    ++counts_[2];
  }
  int most() const { return counts_[1]; }
  int all() const { return counts_[2]; }

 private:
  std::atomic<int>* counts_;
};

std::vector<JobJson> job_identities(std::size_t count) {
  std::vector<JobJson> list;
  for (std::size_t k = 0; k < count; ++k) list.push_back({{"job", k}});
  return list;
}

std::vector<Keeper::Kept> each_kept(Keeper& keeper, std::size_t count,
                                    const std::function<JobJson(std::size_t)>& work) {
  std::vector<Keeper::Kept> all;
  keeper.get_each(
      "test", job_identities(count), [&](std::size_t k, Pulse&) { return work(k); }, [](std::size_t) {},
      [&](std::size_t k, const Keeper::Kept& kept) {
        CHECK(k == all.size());
        all.push_back(kept);
      });
  return all;
}

Scene swinging_scene(double t_end) {
  Scene scene;
  scene.name = "pendulum";
  scene.model_name = "pendulum";
  scene.t_end = t_end;
  scene.model = box(example::Pendulum(1.0));
  scene.resolved = {{"name", "pendulum"}, {"t_end", t_end}};
  return scene;
}

/// All that documents show of studies on a pendulum.
struct Swings {
  std::string converge, drift, compare, stability, map;
  bool operator==(const Swings&) const = default;
};

Swings swings(Runner& runner) {
  std::ostringstream sink;
  output::Progress progress(1, output::ProgressMode::silent, sink);
  StudyOptions options;
  options.timing = false;
  const auto rows = [](const SceneStudy& study) {
    std::string text;
    for (const Row& row : study.rows) text += run_json(study.scene, row).dump() + "\n";
    return text;
  };
  Swings all;
  const Convergence orders = converge(runner, swinging_scene(5.0), options, progress);
  all.converge = rows(orders);
  for (const OrderRow& row : orders.orders) all.converge += row.order.verdict + "\n";
  const DriftStudy drifts = drift(runner, swinging_scene(500.0), options, progress);
  all.drift = rows(drifts);
  for (const DriftRow& row : drifts.drifts) {
    all.drift += std::string(to_string(row.drift.verdict)) + " ";
    for (const double value : row.invariant.drift) all.drift += fmt::format("{:.17g} ", value);
  }
  all.compare = rows(compare(runner, swinging_scene(5.0), options, progress));
  const Stability limits = stability(runner, {swinging_scene(100.0)}, {}, {}, options, progress);
  all.stability = rows(limits.scenes[0]) + stability_json(limits).dump();
  all.map = output::to_csv(stability_map(limits));
  return all;
}

}  // namespace

TEST_CASE("jobs: measurements side by side are kept as one after the other", "[store][jobs]") {
  const auto work = [](std::size_t k) -> JobJson {
    if (k == 3) std::abort();
    if (k == 5) throw std::runtime_error("no such luck");
    if (k == 6)
      for (volatile bool forever = true; forever;) {
      }
    std::this_thread::sleep_for(std::chrono::milliseconds(k % 4 == 0 ? 20 : 1));
    return {{"number", k}, {"third", 1.0 / static_cast<double>(k + 3)}};
  };
  std::vector<std::vector<Keeper::Kept>> results;
  for (const int jobs : {1, 2, 5, 40}) {
    const test::TemporaryFolder folder;
    RunStore store(folder.path().string(), RunStore::Access::append);
    Keeper keeper(store, {"code", "machine", true, {0.3, 0, nullptr}, jobs});
    results.push_back(each_kept(keeper, 12, work));
    CHECK(keeper.made() == 12);
    CHECK(store.size() == 12);
    // All of it is known from then on, in any number.
    Keeper reader(store, {"code", "machine", false, {}, 1});
    const auto again = each_kept(reader, 12, work);
    CHECK(reader.missing() == 0);
    REQUIRE(again.size() == 12);
    for (std::size_t k = 0; k < 12; ++k) CHECK(again[k].result == results.back()[k].result);
  }
  for (const auto& each : results) {
    REQUIRE(each.size() == 12);
    for (std::size_t k = 0; k < 12; ++k) {
      INFO(k << ": " << each[k].message);
      CHECK(each[k].status == results[0][k].status);
      CHECK(each[k].result.dump() == results[0][k].result.dump());
      CHECK(each[k].message == results[0][k].message);
    }
    CHECK(each[3].status == Status::crashed);
    CHECK(each[5].message == "threw an exception: no such luck");
    CHECK(each[6].status == Status::time_limit);
    CHECK(each[7].status == Status::ok);
  }
}

TEST_CASE("jobs: as many as asked for are at work, and timed ones alone", "[store][jobs]") {
  for (const int jobs : {1, 3}) {
    const test::TemporaryFolder folder;
    RunStore store(folder.path().string(), RunStore::Access::append);
    Keeper keeper(store, {"code", "machine", true, {}, jobs});
    Crowd crowd, timed;
    each_kept(keeper, 7, [&](std::size_t k) {
      crowd.meet(jobs);
      return JobJson(k);
    });
    CHECK(crowd.most() == jobs);
    CHECK(crowd.all() == 7);
    keeper.get_all(
        "times", job_identities(3), true,
        [&](std::size_t k, Pulse&) {
          timed.meet(1);
          return JobJson(k);
        },
        [](std::size_t) {}, [](std::size_t, const Keeper::Kept&) { return true; });
    CHECK(timed.most() == 1);
    CHECK(timed.all() == 3);
  }
}

TEST_CASE("jobs: an interruption keeps what is finished", "[store][jobs]") {
  const test::TemporaryFolder folder;
  RunStore store(folder.path().string(), RunStore::Access::append);
  std::atomic<bool> stop{false};
  Keeper keeper(store, {"code", "machine", true, {0.0, 0, &stop}, 2});
  std::vector<Keeper::Kept> all;
  keeper.get_each(
      "test", job_identities(9),
      [&](std::size_t k, Pulse&) {
        if (k >= 4) std::this_thread::sleep_for(std::chrono::hours(1));
        return JobJson(k);
      },
      [&](std::size_t k) { stop = k == 5; },
      [&](std::size_t, const Keeper::Kept& kept) { all.push_back(kept); });
  REQUIRE(all.size() == 6);
  for (std::size_t k = 0; k < 6; ++k) CHECK(all[k].status == (k < 4 ? Status::ok : Status::interrupted));
  CHECK(store.size() == 4);
}

TEST_CASE("jobs: studies are the same whatever the number of runs at a time, kept or not", "[study][jobs]") {
  const Catalogue catalogue = example::catalogue();
  ReferenceStore references("");
  const std::atomic<bool> stop{false};
  Runner alone(catalogue, references, stop);
  const Swings expected = swings(alone);
  CHECK(expected.stability.find("energy off by") != std::string::npos);
  CHECK(expected.converge.find("\"status\":\"ok\"") != std::string::npos);
  for (const int jobs : {2, 5}) {
    INFO(jobs << " at a time");
    Runner several(catalogue, references, stop, jobs);
    CHECK(several.jobs() == jobs);
    const Swings seen = swings(several);
    CHECK(seen.converge == expected.converge);
    CHECK(seen.drift == expected.drift);
    CHECK(seen.compare == expected.compare);
    CHECK(seen.stability == expected.stability);
    CHECK(seen.map == expected.map);
  }
  for (const int jobs : {1, 3}) {
    INFO("kept, " << jobs << " at a time");
    const test::TemporaryFolder folder;
    RunStore store(folder.path().string(), RunStore::Access::append);
    Keeper keeper(store, {"code", "machine", true, {}, jobs});
    Runner keeping(catalogue, references, stop);
    keeping.keep_in(&keeper);
    CHECK(keeping.jobs() == jobs);
    const Swings made = swings(keeping);
    CHECK(made == expected);
    // And once more from the store alone.
    Keeper reader(store, {"code", "machine", false, {}});
    keeping.keep_in(&reader);
    CHECK(swings(keeping) == expected);
    CHECK(reader.missing() == 0);
  }
}

TEST_CASE("jobs: what is timed stays on one core, in a child process or not", "[study][jobs]") {
  const Catalogue catalogue = example::catalogue();
  ReferenceStore references("");
  const std::atomic<bool> stop{false};
  const std::vector<int> before = allowed_cores();
  const std::vector<TimedTask> tasks{
      {[] { return allowed_cores().size() == 1 ? 1.0 : std::nan(""); }},
      {[&] { return allowed_cores() == std::vector<int>{timing_core().value_or(-1)} ? 1.0 : std::nan(""); }}};
  const auto check = [&](Runner& runner) {
    const auto stats = runner.time("test", {}, {"a", "b"}, tasks, {});
    REQUIRE(stats.size() == 2);
    for (const TimingStats& each : stats) CHECK(each.repetitions == 5);
    CHECK(allowed_cores() == before);
  };
  Runner runner(catalogue, references, stop, 4);
  check(runner);
  const test::TemporaryFolder folder;
  RunStore store(folder.path().string(), RunStore::Access::append);
  Keeper keeper(store, {"code", "machine", true, {}, 4});
  runner.keep_in(&keeper);
  check(runner);
}
