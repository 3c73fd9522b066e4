#include "src/measure/floor.hpp"

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "src/measure/drift_scaling.hpp"
#include "tests/catch.hpp"

using gnomon::drift_scaling;
using gnomon::DriftAtStep;
using gnomon::DriftVerdict;
using gnomon::find_floor;

namespace {

struct FloorCurve {
  double order = 4.0;
  double floor = 0.0;
  double growth = 0.0;  // of the floor, ~ h^-growth from the knee on
  double ratio = std::sqrt(2.0);
  int points = 21;
  std::uint64_t seed = 1;
};

// 0.1 h^order + floor, which scatters between a half and three halves of itself.
std::vector<gnomon::OrderPoint> with_floor(const FloorCurve& curve) {
  std::mt19937_64 engine(curve.seed);
  const double knee = std::pow(10.0 * curve.floor, 1.0 / curve.order);
  std::vector<gnomon::OrderPoint> points;
  for (int k = 0; k < curve.points; ++k) {
    const double h = 0.5 * std::pow(curve.ratio, -k);
    const double scatter = 0.5 + static_cast<double>(engine() >> 11) * 0x1p-53;
    const double grown = h < knee ? std::pow(knee / h, curve.growth) : 1.0;
    points.push_back({h, 0.1 * std::pow(h, curve.order) + curve.floor * scatter * grown, true, ""});
  }
  return points;
}

gnomon::OrderOptions scale_of_one() {
  gnomon::OrderOptions options;
  options.scale = 1.0;
  return options;
}

std::vector<DriftAtStep> drifts_at(const std::vector<double>& steps, DriftVerdict verdict, double order) {
  std::vector<DriftAtStep> runs;
  for (const double h : steps) {
    DriftAtStep run{h, {}};
    run.drift.max_abs = 0.3 * std::pow(h, order);
    run.drift.slope = -1e-3 * std::pow(h, order + 1.0);
    run.drift.verdict = verdict;
    runs.push_back(run);
  }
  return runs;
}

}  // namespace

TEST_CASE("measure: floors of known level are found within a factor 3, flat and growing") {
  int curves = 0, found = 0;
  for (const double order : {2.0, 4.0, 6.0, 8.0, 10.0})
    for (const double level : {1e-14, 1e-12, 1e-10, 1e-8})
      for (const double growth : {0.0, 0.5, 1.0})
        for (std::uint64_t seed = 1; seed <= 5; ++seed) {
          FloorCurve curve{.order = order, .floor = level, .growth = growth, .seed = seed};
          // At least six points of the floor, or there is nothing to find.
          const double knee = std::pow(10.0 * level, 1.0 / order);
          if (0.5 * std::pow(curve.ratio, -15) > knee) continue;
          ++curves;
          const auto floor = find_floor(with_floor(curve), scale_of_one());
          INFO("order " << order << " level " << level << " growth " << growth << " seed " << seed);
          if (!floor) continue;
          ++found;
          CHECK(floor->level <= 3.0 * level);
          CHECK(floor->level >= level / 3.0);
          CHECK(floor->points >= 4);
          CHECK(floor->step_from < 3.0 * knee);
          CHECK(floor->typical_step <= floor->step_from);
          for (const auto& point : with_floor(curve)) {
            if (point.step == floor->typical_step) CHECK(point.error >= 0.5 * floor->level);
            if (point.step < floor->typical_step) CHECK(point.error < 0.5 * floor->level);
          }
          CHECK(floor->typical_step >= floor->step_to);
        }
  INFO(found << " of " << curves);
  CHECK(curves >= 150);
  CHECK(found >= (95 * curves) / 100);
}

TEST_CASE("measure: no floor is found where there is none") {
  for (const double order : {1.0, 2.0, 4.0, 8.0})
    for (const double ratio : {std::sqrt(2.0), 2.0})
      CHECK_FALSE(find_floor(with_floor({.order = order, .ratio = ratio, .points = 12}), scale_of_one()));
  // Order 4 that turns into order 1.
  auto changing = with_floor({.order = 4.0, .points = 8});
  for (int k = 0; k < 8; ++k)
    changing.push_back({changing.back().step / 2.0, changing.back().error / 2.0, true, ""});
  CHECK_FALSE(find_floor(changing, scale_of_one()));
  // A lucky change of sign at any place.
  for (std::size_t lucky = 0; lucky < 12; ++lucky) {
    auto points = with_floor({.order = 3.0, .ratio = 2.0, .points = 12});
    points[lucky].error *= 1e-4;
    INFO(lucky);
    CHECK_FALSE(find_floor(points, scale_of_one()));
  }
  // An error that never fell, and scatter.
  std::mt19937_64 engine(3);
  int by_chance = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<gnomon::OrderPoint> flat, scatter;
    for (int k = 0; k < 16; ++k) {
      const double random = static_cast<double>(engine() >> 11) * 0x1p-53;
      flat.push_back({std::ldexp(1.0, -k), 1e-5 * (0.9 + 0.2 * random), true, ""});
      scatter.push_back({std::ldexp(1.0, -k), std::exp(-12.0 + 9.0 * random), true, ""});
    }
    CHECK_FALSE(find_floor(flat, scale_of_one()));
    by_chance += find_floor(scatter, scale_of_one()).has_value();
  }
  CHECK(by_chance <= 4);
}

TEST_CASE("measure: what the reference's bound may hide and runs that failed are no floor") {
  auto points = with_floor({.order = 6.0, .floor = 1e-12});
  gnomon::OrderOptions options = scale_of_one();
  options.bound = 1e-13;
  CHECK(find_floor(points, options));
  options.bound = 1e-12;
  CHECK_FALSE(find_floor(points, options));
  options.bound = 0.0;
  for (auto& point : points)
    if (point.step < 0.011) point.usable = false;
  CHECK_FALSE(find_floor(points, options));
}

TEST_CASE("measure: bounded drift ~ h^2 and secular slope ~ h^3 give their exponents") {
  const std::vector<double> steps{0.1, 0.05, 0.02, 0.01};
  const auto bounded = drift_scaling(drifts_at(steps, DriftVerdict::bounded, 2.0));
  REQUIRE(bounded);
  CHECK(std::abs(bounded->exponent - 2.0) <= 1e-9);
  CHECK_FALSE(bounded->of_slope);
  CHECK(bounded->points == 4);
  const auto secular = drift_scaling(drifts_at(steps, DriftVerdict::secular, 2.0));
  REQUIRE(secular);
  CHECK(std::abs(secular->exponent - 3.0) <= 1e-9);
  CHECK(secular->of_slope);

  // What is at roundoff does not count, and one step has no exponent.
  auto mixed = drifts_at(steps, DriftVerdict::bounded, 2.0);
  mixed[3].drift.verdict = DriftVerdict::roundoff;
  mixed[3].drift.max_abs = 1e-3;
  REQUIRE(drift_scaling(mixed));
  CHECK(std::abs(drift_scaling(mixed)->exponent - 2.0) <= 1e-9);
  CHECK(drift_scaling(mixed)->points == 3);
  CHECK_FALSE(drift_scaling(drifts_at(steps, DriftVerdict::roundoff, 2.0)));
  CHECK_FALSE(drift_scaling(drifts_at(steps, DriftVerdict::failed, 2.0)));
  CHECK_FALSE(drift_scaling(drifts_at({0.1}, DriftVerdict::bounded, 2.0)));
  CHECK_FALSE(drift_scaling(drifts_at({0.1, 0.05}, DriftVerdict::bounded, 2.0)));
  CHECK_FALSE(drift_scaling(drifts_at({0.1, 0.1, 0.05, 0.05}, DriftVerdict::bounded, 2.0)));
  CHECK_FALSE(drift_scaling(drifts_at(steps, DriftVerdict::newton, 2.0)));
  CHECK_FALSE(drift_scaling(drifts_at(steps, DriftVerdict::dissipated, 2.0)));
  // Nor what may be roundoff, or a slope within its error.
  auto tiny = drifts_at(steps, DriftVerdict::secular, 2.0);
  for (DriftAtStep& run : tiny) run.drift.max_abs = 9e-12;
  CHECK_FALSE(drift_scaling(tiny));
  for (DriftAtStep& run : tiny) run.drift.max_abs = 1.1e-11;
  CHECK(drift_scaling(tiny));
  for (DriftAtStep& run : tiny) run.drift.slope_error = 0.4 * std::abs(run.drift.slope);
  CHECK_FALSE(drift_scaling(tiny));
}
