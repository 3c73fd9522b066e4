#include "src/study/stability.hpp"

#include <atomic>
#include <cmath>
#include <sstream>

#include "src/error.hpp"
#include "src/study/stability_output.hpp"
#include "tests/catch.hpp"
#include "tests/example/pendulum.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;

namespace {

Scene pendulum_scene(double g, double t_end) {
  Scene scene;
  scene.name = "pendulum";
  scene.model_name = "pendulum";
  scene.t_end = t_end;
  scene.model = box(example::Pendulum(g));
  scene.resolved = {{"name", "pendulum"}, {"g", g}};
  return scene;
}

/// The largest energy error of Verlet with n steps, relative to g; infinite where a state is not finite.
double worst_energy(double g, double t_end, long n) {
  const double h = t_end / static_cast<double>(n);
  double angle = 1.0, rate = 0.0, worst = 0.0;
  const auto energy = [&] { return 0.5 * rate * rate + g * (1.0 - std::cos(angle)); };
  const double start = energy();
  for (long k = 0; k < n; ++k) {
    rate += 0.5 * h * (-g * std::sin(angle));
    angle += h * rate;
    rate += 0.5 * h * (-g * std::sin(angle));
    worst = std::max(worst, std::abs(energy() - start) / g);
  }
  return worst;
}

Stability pendulum_stability(const Catalogue& catalogue, const std::vector<Scene>& scenes,
                             const std::optional<Variation>& variation = {}) {
  ReferenceStore references("");
  const std::atomic<bool> stop{false};
  Runner runner(catalogue, references, stop);
  std::ostringstream sink;
  output::Progress progress(1, output::ProgressMode::silent, sink);
  return stability(runner, scenes, variation, {}, {}, progress);
}

}  // namespace

TEST_CASE("stability: Verlet's largest step on a pendulum is found on both sides", "[study][stability]") {
  const Catalogue catalogue = example::catalogue();
  const double t_end = 100.0;
  const Stability study = pendulum_stability(catalogue, {pendulum_scene(1.0, t_end)});
  REQUIRE(study.scenes.size() == 1);
  REQUIRE(study.scenes[0].entries.size() == 1);
  const StabilityEntry& entry = study.scenes[0].entries[0];
  const Breaking& breaking = entry.breaking;
  REQUIRE(breaking.breaks);
  CHECK(breaking.survived < *breaking.breaks);
  CHECK(*breaking.breaks <= 1.1 * breaking.survived);
  CHECK(breaking.how.starts_with("energy off by "));
  CHECK(breaking.status == Status::ok);
  CHECK(breaking.t == horizon(t_end, *breaking.breaks));
  CHECK(breaking.t >= 100.0 * *breaking.breaks);
  CHECK(breaking.t < 200.0 * *breaking.breaks);
  // All its steps, here by themselves, agree; with so few of them none is left out by the sampling.
  const auto worst = [&](double step) {
    const double end = horizon(t_end, step);
    return worst_energy(1.0, end, std::lround(end / step));
  };
  CHECK(worst(breaking.survived) <= 0.5);
  CHECK(worst(*breaking.breaks) > 0.5);
  // The linear limit is a step of 2.
  CHECK(breaking.survived >= 1.2);
  CHECK(breaking.survived <= 2.5);
  // The whole ladder ran, and small steps keep the energy better than large ones.
  REQUIRE(entry.points.size() >= static_cast<std::size_t>(study.search.count));
  CHECK(study.scenes[0].rows.size() == entry.points.size());
  CHECK(entry.points.front().failure.empty());
  for (std::size_t k = 0; k + 1 < entry.points.size(); ++k)
    CHECK(entry.points[k].step < entry.points[k + 1].step);
  const auto drift_at = [&](std::size_t k) {
    return *largest_drift(study.scenes[0].rows[entry.points[k].row]);
  };
  CHECK(drift_at(0) < 1e-3);
  CHECK(drift_at(0) < 0.1 * drift_at(4));
}

TEST_CASE("stability: the limit of a parameter's values follows the theory", "[study][stability]") {
  const Catalogue catalogue = example::catalogue();
  const Variation variation = read_variation("--vary", "g=1,16");
  const Stability study =
      pendulum_stability(catalogue, {pendulum_scene(1.0, 100.0), pendulum_scene(16.0, 100.0)}, variation);
  REQUIRE(study.scenes.size() == 2);
  // Time scales with 1/sqrt(g), the run being long.
  const double ratio =
      study.scenes[0].entries[0].breaking.survived / study.scenes[1].entries[0].breaking.survived;
  CHECK(ratio >= 3.4);
  CHECK(ratio <= 4.6);
  const output::Table table = stability_table(study), map = stability_map(study);
  CHECK(table.rows.size() == 2);
  CHECK(table.columns[1].heading == "g");
  CHECK(table.rows[1][1].text == "16");
  CHECK(map.columns.size() == 2 + static_cast<std::size_t>(study.search.count));
  CHECK(map.rows[0][2].text == "ok");
  CHECK(map.rows[1].back().text != "ok");
  CHECK_FALSE(output::to_markdown(table).empty());
  CHECK_FALSE(output::to_markdown(map).empty());
  const output::Figure figure = stability_figure(catalogue, study);
  REQUIRE(figure.panels.size() == 1);
  CHECK(figure.panels[0].x_label == "g");
  const std::vector<output::Series>& kinds = figure.panels[0].series;
  REQUIRE(kinds.size() >= 2);
  CHECK(kinds[0].label == "survives");
  CHECK(kinds[1].label == "energy off");
  CHECK(kinds[0].x.front() == 1.0);
  CHECK(kinds[0].x.back() == 16.0);
  const auto json = stability_json(study);
  REQUIRE(json.size() == 2);
  CHECK(json[1]["vary"]["g"] == "16");
  CHECK(json[0]["largest_step"] == study.scenes[0].entries[0].breaking.survived);
  CHECK(json[0]["points"].size() == study.scenes[0].entries[0].points.size());
}

TEST_CASE("stability: what does not survive", "[study][stability]") {
  const Scene scene = pendulum_scene(1.0, 1.0);
  Row row;
  row.result.state = {1.0, 0.0};
  const auto energies = [&](std::vector<double> values) {
    row.invariants = summarise_invariants(*scene.model, {{0.0, 0.5, 1.0}, std::move(values)});
  };
  energies({0.4, 0.5, 0.9});
  CHECK(failure_of(scene, row, {}) == "");
  CHECK(largest_drift(row).value() == 0.5);
  energies({0.4, 1.0, 0.4});
  CHECK(failure_of(scene, row, {}) == "energy off by 0.6");
  CHECK(failure_of(scene, row, {.max_drift = 0.7}) == "");
  energies({0.4, std::nan(""), 0.4});
  CHECK(failure_of(scene, row, {}) == "energy off by nan");
  row.result.status = Status::newton_failed;
  CHECK(failure_of(scene, row, {}) == "newton_failed");
  // Errors count only where no energy is constant; a result that is wrong altogether is 3 rad off here.
  row.result.status = Status::ok;
  row.error = {1.6, 0.0};
  energies({0.4, 0.4, 0.4});
  CHECK(failure_of(scene, row, {}) == "");
  row.invariants = {};
  CHECK(failure_of(scene, row, {}) == "angle wrong by 1.6 rad");
  row.error = {1.4, 4.4};
  CHECK(failure_of(scene, row, {}) == "");
}

TEST_CASE("vary: several keys take the same values in step", "[study][vary]") {
  const Variation variation = read_variation("--vary", "beam.EA,beam.GA=1e5,2e5");
  CHECK(variation.key == "beam.EA,beam.GA");
  REQUIRE(variation.values.size() == 2);
  const Catalogue catalogue = test::full_catalogue();
  SceneChanges changes;
  changes.vary = variation.assignment(1);
  const Scene scene = load_scene(catalogue, "soft-beam", changes);
  CHECK(scene.name == "soft-beam[beam.EA,beam.GA=2e5]");
  CHECK(scene.resolved["beam"]["EA"] == 2e5);
  CHECK(scene.resolved["beam"]["GA"] == 2e5);
  CHECK(scene.resolved["beam"]["EI"] == 0.5);
  for (const char* wrong : {"beam.EA,=1", ",beam.EA=1", "beam.EA,beam.GB=1"}) {
    changes.vary = wrong;
    CHECK_THROWS_AS(load_scene(catalogue, "soft-beam", changes), UsageError);
  }
}

TEST_CASE("vary: values are split where no bracket or quote is open", "[study][vary]") {
  const auto values = [](const std::string& text) { return read_variation("--vary", text).values; };
  CHECK(values("a.b=1, 2,3e4") == std::vector<std::string>{"1", "2", "3e4"});
  CHECK(values("a=[1, 2],[3,4]") == std::vector<std::string>{"[1, 2]", "[3,4]"});
  CHECK(values("a=\"x,y\",'z'") == std::vector<std::string>{"\"x,y\"", "'z'"});
  CHECK(values("a={ kind = \"ramp\", over = 1 },1").size() == 2);
  CHECK(read_variation("--vary", "a=1,+2").numbers().value() == std::vector<double>{1.0, 2.0});
  CHECK_FALSE(read_variation("--vary", "a=1,[2]").numbers());
  CHECK(read_variation("--vary", "a.b=1,2").assignment(1) == "a.b=2");
  for (const char* wrong : {"a", "a=", "=1", "a=1,", "a=1,,2", "a=1,1", "a=10,1e1", ""})
    CHECK_THROWS_AS(read_variation("--vary", wrong), UsageError);
}

TEST_CASE("vary: lists that differ in one place have an axis", "[study][vary]") {
  const auto axis = [](const std::string& text) { return read_variation("--vary", text).axis(); };
  const auto numbers = axis("g=1,+2");
  REQUIRE(numbers);
  CHECK(numbers->label == "g");
  CHECK(numbers->values == std::vector<double>{1.0, 2.0});
  const auto lists = axis("a.b=[0, 2, 1e-2],[0.0,2,1e-4],[0,2,0]");
  REQUIRE(lists);
  CHECK(lists->label == "x in a.b = [0, 2, x]");
  CHECK(lists->values == std::vector<double>{1e-2, 1e-4, 0.0});
  for (const char* none : {"a=[1,2],[3,4]", "a=[1,2],[1]", "a=[1],[\"x\"]", "a=1,[2]", "a=\"x\",\"y\""})
    CHECK_FALSE(axis(none));
}
