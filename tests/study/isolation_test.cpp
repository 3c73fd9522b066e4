// Studies on schemes that crash, hang or take all memory: one row each, with its status and reason.
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "src/study/compare.hpp"
#include "src/study/converge.hpp"
#include "src/study/json.hpp"
#include "src/study/keeper.hpp"
#include "src/study/kept_row.hpp"
#include "tests/catch.hpp"
#include "tests/output/temporary_folder.hpp"
#include "tests/run/tiny.hpp"

using namespace gnomon;

namespace {

enum class Vice { none, abort, loop, memory, timing };

/// A good scheme but for one step size.
template <Vice vice>
struct Vicious {
  static constexpr SchemeInfo info{.name = vice == Vice::none     ? "good"
                                           : vice == Vice::abort  ? "aborts"
                                           : vice == Vice::loop   ? "loops"
                                           : vice == Vice::memory ? "eats"
                                                                  : "aborts-when-timed",
                                   .family = "test",
                                   .summary = "",
                                   .citation = "",
                                   .form = "line"};
  template <class M>
  using State = test::Journal;
  static test::Journal start(const test::Line&, const test::Line::State& state) { return {.x = state.x}; }
  static test::Line::State view(const test::Line&, const test::Journal& state) { return {state.x}; }
  static Cost cost(const test::Line&, const test::Journal&, long steps) {
    return {.steps = steps, .rhs = steps};
  }
  static Status step(const test::Line&, test::Journal& state, double t, double h) {
    state.x += h;
    if (h != 0.25 || t < 0.5) return Status::ok;
    if (vice == Vice::abort) std::abort();
    if (vice == Vice::loop)
      for (volatile bool forever = true; forever;) {
      }
    if (vice == Vice::memory)
      for (std::vector<char*> all;;) all.push_back(new char[std::size_t{1} << 24]);
    return Status::ok;
  }
};

/// Runs well once in a process with 500 steps and crashes when that is repeated.
struct CrashesWhenTimed : Vicious<Vice::timing> {
  static Status step(const test::Line& model, test::Journal& state, double t, double h) {
    static long calls = 0;
    if (++calls > 1000) std::abort();
    return Vicious<Vice::timing>::step(model, state, t, h);
  }
};

struct Bench {
  test::TemporaryFolder folder;
  Catalogue catalogue;
  Scene scene;
  ReferenceStore references{""};
  std::atomic<bool> stop{false};

  Bench() {
    add_schemes<TypeList<test::Line>>(catalogue,
                                      TypeList<Vicious<Vice::none>, Vicious<Vice::abort>, Vicious<Vice::loop>,
                                               Vicious<Vice::memory>, CrashesWhenTimed>{});
    scene.name = "line";
    scene.model_name = "line";
    scene.t_end = 1.0;
    scene.model = box(test::Line{});
    scene.resolved = {{"name", "line"}, {"model", "line"}, {"t_end", 1.0}};
  }
};

StudyOptions options_of(std::vector<std::string> integrators) {
  StudyOptions options;
  options.integrators = std::move(integrators);
  options.steps = {0.5, 0.25, 0.125};
  options.time_limit = 0.1;
  options.reference = false;
  options.timing = false;
  return options;
}

}  // namespace

TEST_CASE("isolation: a scheme that crashes, hangs or eats memory costs a row of the study", "[store]") {
  Bench bench;
  const bool limited = default_memory_limit() > 0;
  std::vector<std::string> names{"good", "aborts", "loops"};
  if (limited) names.emplace_back("eats");
  RunStore store(bench.folder.path().string(), RunStore::Access::append);
  Keeper keeper(store, {"code", "machine", true, {0.0, limited ? std::uint64_t{2} << 30 : 0, &bench.stop}});
  Runner runner(bench.catalogue, bench.references, bench.stop);
  runner.keep_in(&keeper);
  std::ostringstream silence;
  output::Progress progress(0, output::ProgressMode::silent, silence);
  const Convergence study = converge(runner, bench.scene, options_of(names), progress);
  REQUIRE(study.rows.size() == 3 * names.size());
  for (std::size_t k = 0; k < study.rows.size(); ++k) {
    const Row& row = study.rows[k];
    INFO(row.scheme->name << " " << row.setting.text() << ": " << row.result.message);
    CHECK(row.scheme->name == names[k / 3]);
    const bool bad = k % 3 == 1 && k / 3 > 0;
    CHECK(row.result.status == (!bad                          ? Status::ok
                                : row.scheme->name == "loops" ? Status::time_limit
                                                              : Status::crashed));
    CHECK(row.result.step.value() == row.setting.step.value());
    if (!bad) {
      CHECK(row.result.t == 1.0);
      CHECK(row.evaluations() == std::lround(1.0 / row.setting.step.value()));
      CHECK(row.result.message.empty());
    }
  }
  CHECK(study.rows[4].result.message == "ended by SIGABRT");
  CHECK(study.rows[7].result.message == "did not end within 1.1 s");
  if (limited) CHECK(study.rows[10].result.message == "out of memory, limit 2.0 GiB");

  // Documents show what there is of such a run, and null for the rest.
  const nlohmann::ordered_json json = run_json(bench.scene, study.rows[4]);
  CHECK(json["status"] == "crashed");
  CHECK(json["step"] == 0.25);
  for (const char* key : {"t", "state", "probes", "error", "below_bound", "cpu_seconds"})
    CHECK(json[key].is_null());

  // The same from the store alone, byte by byte.
  Keeper reader(store, {"code", "machine", false, {}});
  runner.keep_in(&reader);
  const Convergence again = converge(runner, bench.scene, options_of(names), progress);
  CHECK(reader.missing() == 0);
  REQUIRE(again.rows.size() == study.rows.size());
  for (std::size_t k = 0; k < study.rows.size(); ++k)
    CHECK(run_json(bench.scene, again.rows[k]).dump() == run_json(bench.scene, study.rows[k]).dump());
}

TEST_CASE("isolation: a run that ends its process when it is timed loses its times only", "[store]") {
  Bench bench;
  RunStore store(bench.folder.path().string(), RunStore::Access::append);
  Keeper keeper(store, {"code", "machine", true, {0.0, 0, &bench.stop}});
  Runner runner(bench.catalogue, bench.references, bench.stop);
  runner.keep_in(&keeper);
  StudyOptions options = options_of({"good", "aborts-when-timed"});
  options.steps = {0.002};
  std::vector<Row> rows;
  for (const std::string& name : options.integrators)
    rows.push_back(
        runner.run(bench.scene, {}, *bench.catalogue.scheme(name), {0.002, std::nullopt}, options));
  options.timing = true;
  runner.time(bench.scene, rows, options);
  REQUIRE(rows[0].timing);
  CHECK(rows[0].timing->repetitions == 5);
  CHECK(rows[0].timing->median > 0.0);
  CHECK_FALSE(rows[1].timing);
  CHECK(keeper.made() == 4);  // two runs, the times that failed, the times of the rest

  Keeper reader(store, {"code", "machine", false, {}});
  runner.keep_in(&reader);
  std::vector<Row> known = rows;
  for (Row& row : known) row.timing.reset();
  runner.time(bench.scene, known, options);
  CHECK(reader.missing() == 0);
  REQUIRE(known[0].timing);
  CHECK(known[0].timing->median == rows[0].timing->median);
  CHECK_FALSE(known[1].timing);
}

TEST_CASE("isolation: a stored row is the row that was made, drifts included", "[store]") {
  Bench bench;
  Runner runner(bench.catalogue, bench.references, bench.stop);
  StudyOptions options = options_of({"good"});
  options.watch = 2048;
  const SchemeInfo& scheme = *bench.catalogue.scheme("good");
  const Setting setting{0.001, std::nullopt};
  const Row made = runner.run(bench.scene, {}, scheme, setting, options);
  const Row kept = restore_row(bench.scene, scheme, setting,
                               nlohmann::ordered_json::parse(row_json(bench.scene, made, true).dump()));
  CHECK(kept.result.status == made.result.status);
  CHECK(kept.result.t == made.result.t);
  CHECK(kept.result.step == made.result.step);
  CHECK(kept.result.cost.rhs == made.result.cost.rhs);
  REQUIRE(kept.invariants.size() == 1);
  const InvariantSummary &a = made.invariants[0], &b = kept.invariants[0];
  CHECK(a.max_drift == b.max_drift);
  CHECK(a.slope == b.slope);
  CHECK(a.measured.oscillation == b.measured.oscillation);
  CHECK(a.measured.verdict == b.measured.verdict);
  CHECK(a.times.size() > 20);
  CHECK(a.times.size() < 60);
  CHECK(a.times == b.times);
  CHECK(a.drift == b.drift);
  CHECK(run_json(bench.scene, kept).dump() == run_json(bench.scene, made).dump());
}
