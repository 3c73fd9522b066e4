// The search for the largest step, on made-up survival and on schemes that survive in windows.
#include "src/study/breaking.hpp"

#include <atomic>
#include <cmath>
#include <set>
#include <sstream>

#include "src/study/stability.hpp"
#include "src/study/stability_output.hpp"
#include "tests/catch.hpp"
#include "tests/example/pendulum.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;

namespace {

Scene long_pendulum() {
  Scene scene;
  scene.name = "pendulum";
  scene.t_end = 1000.0;
  scene.model = box(example::Pendulum(1.0));
  return scene;
}

/// From 2^-7 to 8 s.
StepSearch made_up_search(int near, bool whole = false) {
  StepSearch search;
  search.first = std::exp2(-7.0);
  search.count = 11;
  search.whole = whole;
  search.resolution = std::pow(2.0, 0.125);
  search.lowest = search.first / 4096.0;
  search.descent.near = near;
  search.descent.far = near > 0 ? near / 3 : 1;
  return search;
}

/// Searches where `fate(step)` says how a run ends: "" survives, "limit" was cut short.
template <class Fate>
Breaking made_up(const StepSearch& search, Fate&& fate) {
  const Scene scene = long_pendulum();
  BreakingSearch searching(scene, search);
  std::set<double> seen;
  for (auto steps = searching.next(); !steps.empty(); steps = searching.next())
    for (const double step : steps) {
      CHECK(seen.insert(step).second);
      const double runs = horizon(scene.t_end, step) / step;
      CHECK(runs >= 99.999);
      Row row;
      std::string failure = fate(step);
      if (failure == "limit") row.result.status = Status::time_limit;
      searching.take(step, std::move(row), failure);
      REQUIRE(seen.size() < 1000);
    }
  return std::move(searching).result();
}

Stability shipped_stability(const Catalogue& catalogue, const std::vector<Scene>& scenes,
                            const std::vector<std::string>& integrators,
                            const std::optional<Variation>& variation = {}) {
  ReferenceStore references("");
  const std::atomic<bool> stop{false};
  Runner runner(catalogue, references, stop);
  std::ostringstream sink;
  output::Progress progress(1, output::ProgressMode::silent, sink);
  StudyOptions options;
  options.integrators = integrators;
  return stability(runner, scenes, variation, {}, options, progress);
}

}  // namespace

TEST_CASE("stability: a window of failing steps below the largest survivor is found", "[study][stability]") {
  for (const double low : {0.53, 0.61, 0.68, 0.77, 0.85}) {
    // Between two rungs of the ladder, and narrow.
    const auto fate = [low](double step) {
      return step > 1.0 || (step > low && step < 1.1 * low) ? std::string("energy off by 2") : std::string();
    };
    INFO(low);
    const Breaking found = made_up(made_up_search(12), fate);
    REQUIRE(found.breaks);
    CHECK(found.survived <= low);
    CHECK(found.survived >= low / 1.1);
    CHECK(*found.breaks > low);
    CHECK(*found.breaks < 1.1 * low);
    CHECK(found.again > 0.9);
    CHECK(found.again <= 1.0);
    CHECK(found.down_to <= found.survived / 16.0);
    CHECK(found.tried == found.trials.size());
    for (const Trial& trial : found.trials) CHECK((trial.step > found.survived || trial.failure.empty()));
    // The bisection alone does not see it.
    const Breaking bisected = made_up(made_up_search(0), fate);
    CHECK(bisected.survived > 0.9);
    CHECK(bisected.again == 0.0);
  }
}

TEST_CASE("stability: wider windows are found down to a sixteenth of the step", "[study][stability]") {
  for (double low = 1.0 / 15.0; low < 0.5; low *= 1.17) {
    INFO(low);
    const auto fate = [low](double step) {
      return step > 1.0 || (step > low && step < 1.3 * low) ? std::string("newton_failed") : std::string();
    };
    for (const bool whole : {false, true}) {
      const Breaking found = made_up(made_up_search(12, whole), fate);
      REQUIRE(found.breaks);
      CHECK(found.survived <= low);
      CHECK(found.survived >= low / 1.3);
      CHECK(*found.breaks < 1.3 * low);
      CHECK(found.down_to <= found.survived / 16.0);
    }
  }
}

TEST_CASE("stability: where survival is monotone the descent changes nothing", "[study][stability]") {
  for (const double limit : {0.01, 0.3, 1.0, 1.7, 20.0}) {
    INFO(limit);
    const auto fate = [limit](double step) { return std::string(step > limit ? "energy off by 2" : ""); };
    const Breaking with = made_up(made_up_search(12), fate), without = made_up(made_up_search(0), fate);
    CHECK(with.survived == without.survived);
    CHECK(with.breaks == without.breaks);
    CHECK(with.survived <= limit);
    CHECK(with.again == 0.0);
    CHECK(with.breaks.has_value() == (limit < 8.0));
    CHECK(with.trials.size() > without.trials.size());
    CHECK(with.trials.size() <= 50);
    CHECK(with.down_to <= with.survived / 16.0);
  }
}

TEST_CASE("stability: runs that a limit ended say nothing about their steps", "[study][stability]") {
  const auto fate = [](double step) {
    return std::string(step > 1.0 ? "energy off by 2" : step < 0.2 ? "limit" : "");
  };
  const Breaking found = made_up(made_up_search(12), fate);
  CHECK(found.survived == 1.0);
  REQUIRE(found.breaks);
  CHECK(*found.breaks < 1.1);
  CHECK(found.down_to >= 0.2);
  CHECK(found.down_to < 0.25);
  CHECK(found.tried < found.trials.size());
  // The descent goes no further than the octave in which it met the first.
  std::size_t cut = 0;
  for (const Trial& trial : found.trials) cut += trial.failure == "limit" ? 1 : 0;
  CHECK(cut <= 5 + 4);
  const Breaking nothing = made_up(made_up_search(12), [](double) { return std::string("limit"); });
  CHECK(nothing.survived == 0.0);
  CHECK(nothing.tried == 0);
  CHECK(nothing.status == Status::time_limit);
}

TEST_CASE("stability: the search ends whatever the runs do", "[study][stability]") {
  const auto wild = [](double step) {
    return std::string(std::sin(1e4 * step) > 0.8 ? "newton_failed" : "");
  };
  const Breaking found = made_up(made_up_search(12), wild);
  CHECK(found.trials.size() < 300);
  const Breaking none = made_up(made_up_search(12), [](double) { return std::string("diverged"); });
  CHECK(none.survived == 0.0);
  REQUIRE(none.breaks);
  CHECK(*none.breaks < 1e-3 * std::exp2(-7.0));
}

TEST_CASE("stability: long steps are run on beyond the end of the scene", "[study][stability]") {
  CHECK(horizon(10.0, 0.05) == 10.0);
  CHECK(horizon(10.0, 0.1) == 10.0);
  CHECK(horizon(10.0, 0.11) == 20.0);
  CHECK(horizon(10.0, 1.25) == 160.0);
  CHECK(failure_kind("energy off by 0.6") == "energy off");
  CHECK(failure_kind("newton_failed") == "newton_failed");
  CHECK(failure_kind("") == "");
}

TEST_CASE("stability: RKMK's window on the heavy symmetric top is found", "[study][stability]") {
  const Catalogue catalogue = test::full_catalogue();
  const Scene scene = load_scene(catalogue, "heavy-symmetric-top", {});
  const Stability study = shipped_stability(catalogue, {scene}, {"rkmk4"});
  REQUIRE(study.scenes[0].entries.size() == 1);
  const Breaking& breaking = study.scenes[0].entries[0].breaking;
  // 0.145 s fails; bisection from the ladder alone ends at 0.77 s.
  CHECK(breaking.survived < 0.145);
  CHECK(breaking.survived > 0.09);
  CHECK(breaking.down_to <= breaking.survived / 16.0);
}

TEST_CASE("stability: the map shows every step that was run over the values of a list",
          "[study][stability]") {
  const Catalogue catalogue = test::full_catalogue();
  const Variation variation =
      read_variation("--vary", "body.angular_momentum=[0, 2, 1e-2],[0, 2, 1e-4],[0, 2, 1e-6]");
  std::vector<Scene> scenes;
  for (std::size_t k = 0; k < 3; ++k) {
    SceneChanges changes;
    changes.t_end = 20.0;
    changes.vary = variation.assignment(k);
    scenes.push_back(load_scene(catalogue, "near-separatrix", changes));
  }
  const Stability study = shipped_stability(catalogue, scenes, {"dmv2", "rkmk4"}, variation);
  const output::Figure figure = stability_figure(catalogue, study);
  REQUIRE(figure.panels.size() == 2);
  CHECK(figure.panels[0].title == "dmv2");
  CHECK(figure.panels[1].title == "rkmk4");
  for (std::size_t p = 0; p < 2; ++p) {
    const output::Panel& panel = figure.panels[p];
    CHECK(panel.x_label == "x in body.angular_momentum = [0, 2, x]");
    CHECK(panel.y_label == "step [s]");
    CHECK(panel.log_x);
    REQUIRE(panel.x_range);
    CHECK(panel.x_range->low < 1e-6);
    CHECK(panel.x_range->high > 1e-2);
    REQUIRE(panel.levels.size() == 3);
    std::size_t shown = 0, run = 0;
    std::set<int> styles;
    for (const output::Series& series : panel.series) {
      CHECK(series.marks_only);
      CHECK(styles.insert(series.style).second);
      REQUIRE(series.hollow.size() == series.x.size());
      shown += series.x.size();
      for (std::size_t i = 0; i < series.x.size(); ++i) {
        CHECK(series.hollow[i] == (series.label != "survives"));
        CHECK((series.x[i] == 1e-2 || series.x[i] == 1e-4 || series.x[i] == 1e-6));
      }
    }
    for (std::size_t of = 0; of < 3; ++of) {
      const StabilityEntry& entry = study.scenes[of].entries[p];
      run += entry.points.size();
      CHECK(panel.levels[of].y == entry.breaking.survived);
      // Its line is around the value and reaches no other.
      const double x = std::pow(10.0, -2.0 - 2.0 * static_cast<double>(of));
      CHECK(panel.levels[of].x.low < 0.5 * x);
      CHECK(panel.levels[of].x.low > 0.01 * x);
      CHECK(panel.levels[of].x.high > 2.0 * x);
      CHECK(panel.levels[of].x.high < 100.0 * x);
    }
    CHECK(shown == run);
    CHECK(panel.series.front().label == "survives");
  }
  // The discrete Moser-Veselov step has no solution from some size on, and says so in the map.
  REQUIRE(figure.panels[0].series.size() == 2);
  CHECK(figure.panels[0].series[1].label == "newton_failed");
}
