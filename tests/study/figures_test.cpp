#include "src/study/figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/catch.hpp"
#include "tests/example/pendulum.hpp"

using namespace gnomon;

namespace {

const double unknown = std::numeric_limits<double>::quiet_NaN();

template <class Study>
Study drawn_study() {
  Study study;
  study.scene.name = "pendulum";
  study.scene.t_end = 10.0;
  study.scene.model = box(example::Pendulum(1.0));
  return study;
}

Row drawn_row(const Catalogue& catalogue, double step, Status status) {
  Row row;
  row.scheme = &catalogue.schemes.front();
  row.setting.step = step;
  row.result.status = status;
  row.result.t = status == Status::ok ? 10.0 : 4.0;
  return row;
}

DriftRow drawn_drift(std::size_t row, double largest) {
  DriftRow drift;
  drift.row = row;
  drift.invariant.info.name = "energy";
  drift.invariant.times = {0.0, 1.0, 5.0, 10.0};
  drift.invariant.drift = {0.0, 0.01 * largest, 0.1 * largest, -largest};
  drift.drift.max_abs = largest;
  return drift;
}

}  // namespace

TEST_CASE("figures: drift over a ladder is drawn against the step, clipped to what can be read", "[study]") {
  const Catalogue catalogue = example::catalogue();
  DriftStudy study = drawn_study<DriftStudy>();
  const double drifts[] = {0.0, 1e-3, 1e-2, 1e200, 1e290, unknown};
  for (std::size_t k = 0; k < 6; ++k) {
    study.rows.push_back(
        drawn_row(catalogue, std::ldexp(0.01, static_cast<int>(k)), k < 4 ? Status::ok : Status::diverged));
    study.drifts.push_back(drawn_drift(k, drifts[k]));
  }
  const output::Figure figure = drift_figure(catalogue, study, "energy");
  REQUIRE(figure.panels.size() == 1);
  const output::Panel& panel = figure.panels.front();
  CHECK(panel.x_label == "step [s]");
  REQUIRE(panel.series.size() == 1);
  const output::Series& series = panel.series.front();
  CHECK(series.label == catalogue.schemes.front().name);
  REQUIRE(series.y.size() == 6);
  CHECK(series.x[5] == 0.32);
  CHECK(series.y[0] == std::numeric_limits<double>::epsilon());
  CHECK(series.hollow[0]);
  CHECK_FALSE(series.hollow[1]);
  CHECK(series.y[1] == 1e-3);
  CHECK(series.y[2] == 1e-2);
  for (std::size_t k = 3; k < 6; ++k) CHECK(std::isnan(series.y[k]));
  REQUIRE(panel.failures.size() == 3);
  std::vector<double> places;
  for (const output::Failure& failure : panel.failures) places.push_back(failure.x);
  CHECK(places == std::vector<double>{0.08, 0.16, 0.32});
  CHECK(figure.failure_note.starts_with("3 runs failed or drifted by more than 10: "));
  CHECK(figure.failure_note.ends_with("\u00a03"));
}

TEST_CASE("figures: drift of one step is drawn against time, up to where it can be read", "[study]") {
  const Catalogue catalogue = example::catalogue();
  DriftStudy study = drawn_study<DriftStudy>();
  study.rows = {drawn_row(catalogue, 0.1, Status::ok)};
  study.drifts = {drawn_drift(0, 50.0)};
  const output::Figure figure = drift_figure(catalogue, study, "energy");
  REQUIRE(figure.panels.size() == 1);
  const output::Panel& panel = figure.panels.front();
  CHECK(panel.x_label == "time [s]");
  CHECK(panel.series.at(0).x == std::vector<double>{1.0, 5.0});
  REQUIRE(panel.failures.size() == 1);
  CHECK(panel.failures[0].x == 10.0);
  study.drifts = {drawn_drift(0, 5.0)};
  const output::Figure small = drift_figure(catalogue, study, "energy");
  CHECK(small.panels.front().failures.empty());
  CHECK(small.panels.front().series.at(0).x == std::vector<double>{1.0, 5.0, 10.0});
  CHECK(small.failure_note.empty());
}

TEST_CASE("figures: failed runs and the front are marked in both panels of a comparison", "[study]") {
  const Catalogue catalogue = example::catalogue();
  Comparison study = drawn_study<Comparison>();
  for (int k = 0; k < 3; ++k) {
    study.rows.push_back(drawn_row(catalogue, std::ldexp(0.1, -k), Status::ok));
    Row& row = study.rows.back();
    row.error = {std::pow(0.1, k)};
    row.below_bound = {false};
    row.result.cost.rhs = 100 << k;
    row.timing.emplace();
    row.timing->median = row.timing->min = row.timing->max = 1e-6 * (1 << k);
  }
  study.rows.push_back(drawn_row(catalogue, 0.4, Status::diverged));
  study.rows.back().result.cost.rhs = 25;
  study.rows.back().result.cpu_seconds = 2e-7;
  study.rows.push_back(drawn_row(catalogue, 0.8, Status::crashed));
  study.front_in_time = {true, true, true, false, false};
  study.front_in_evaluations = {true, false, true, false, false};
  const output::Figure figure = work_precision_figure(catalogue, study);
  REQUIRE(figure.panels.size() == 2);
  for (const output::Panel& panel : figure.panels) {
    REQUIRE(panel.failures.size() == 2);
    CHECK(std::isnan(panel.failures[1].x));
    CHECK(panel.series.front().x.size() == 3);
  }
  CHECK(figure.panels[0].failures[0].x == 2e-7);
  CHECK(figure.panels[1].failures[0].x == 25.0);
  CHECK(figure.panels[0].front.size() == 3);
  REQUIRE(figure.panels[1].front.size() == 2);
  CHECK(figure.panels[1].front[1].x == 400.0);
  CHECK(figure.panels[1].front[1].y == study.rows[2].error[0]);
  CHECK(figure.failure_note.starts_with("2 runs failed: "));
  CHECK(figure.failure_note.ends_with("at the left edge: cost not known"));
}
