#include "src/measure/work.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "tests/catch.hpp"

using gnomon::cost_at;
using gnomon::pareto_front;
using gnomon::WorkPoint;

TEST_CASE("measure: cost at an error is interpolated in logarithms") {
  // cost = error^(-1/4): a method of order 4
  std::vector<WorkPoint> curve;
  for (int k = 2; k <= 10; k += 2) curve.push_back({std::pow(10.0, -k), std::pow(10.0, 0.25 * k)});
  for (const double error : {1e-3, 1e-4, 3e-7, 1e-10}) {
    const auto cost = cost_at(curve, error);
    REQUIRE(cost);
    CHECK(std::abs(*cost - std::pow(error, -0.25)) <= 1e-12 * *cost);
  }
  CHECK_FALSE(cost_at(curve, 9e-11));
  CHECK_FALSE(cost_at({}, 1e-3));
}

TEST_CASE("measure: a level reached by the loosest setting costs what that setting costs") {
  const std::vector<WorkPoint> curve{{1e-5, 3.0}, {1e-7, 5.0}};
  CHECK(cost_at(curve, 1e-2) == 3.0);
  CHECK(cost_at(curve, 1e-5) == 3.0);
  REQUIRE(gnomon::level_cost(curve, 1e-2));
  CHECK(gnomon::level_cost(curve, 1e-2)->upper_bound);
  REQUIRE(gnomon::level_cost(curve, 1e-6));
  CHECK_FALSE(gnomon::level_cost(curve, 1e-6)->upper_bound);
  CHECK_FALSE(gnomon::level_cost(curve, 0.99e-7));
}

TEST_CASE("measure: a setting counts only if the two next tighter ones reach the level too") {
  // The second setting is a lucky one: the third, tighter, is worse.
  const std::vector<WorkPoint> curve{{1e-2, 1.0}, {1e-6, 2.0}, {1e-4, 4.0}, {1e-5, 8.0}};
  const auto at_bottom = cost_at(curve, 1e-5);
  REQUIRE(at_bottom);
  CHECK(std::abs(*at_bottom - 8.0) <= 1e-12);
  CHECK_FALSE(cost_at(curve, 1e-6));
  // The envelope from the second setting on is 1e-4.
  const auto at_envelope = cost_at(curve, 1e-4);
  REQUIRE(at_envelope);
  CHECK(std::abs(*at_envelope - 2.0) <= 1e-12);
  const auto between = cost_at(curve, 1e-3);
  REQUIRE(between);
  CHECK(std::abs(*between - std::sqrt(2.0)) <= 1e-12);
  // Two lucky ones do not count, three do, whatever comes after them.
  const double steps[] = {1.0, 2.0, 4.0, 8.0, 16.0};
  const auto with_errors = [&](std::vector<double> errors) {
    std::vector<WorkPoint> points;
    for (std::size_t k = 0; k < errors.size(); ++k) points.push_back({errors[k], steps[k]});
    return points;
  };
  CHECK(cost_at(with_errors({1e-5, 1e-5, 1e-2, 1e-5, 1e-5}), 1e-4) > 4.0);
  CHECK(cost_at(with_errors({1e-5, 1e-5, 1e-5, 1e-2, 1e-2}), 1e-4) == 1.0);
}

TEST_CASE("measure: a looser error never costs more than a tighter one") {
  // The loosest settings need more than tighter ones, as where Newton's iteration hardly converges.
  const std::vector<WorkPoint> stiff{
      {8e-3, 5220.0}, {1e-4, 700.0}, {5e-7, 333.0}, {1e-7, 400.0}, {1e-8, 800.0}};
  CHECK(cost_at(stiff, 1e-2) == 333.0);
  CHECK(cost_at(stiff, 1e-6) == 333.0);
  REQUIRE(gnomon::level_cost(stiff, 1e-2));
  CHECK_FALSE(gnomon::level_cost(stiff, 1e-2)->upper_bound);
  // Whatever the errors and costs are.
  unsigned seed = 1;
  const auto random = [&] { return seed = 1664525u * seed + 1013904223u, seed / 4294967296.0; };
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<WorkPoint> curve;
    for (int k = 0; k < 8; ++k)
      curve.push_back({std::pow(10.0, -1.0 * k - 3.0 * random()), std::pow(10.0, 2.0 * random())});
    double before = std::numeric_limits<double>::infinity();
    for (int k = 60; k >= 0; --k)
      if (const auto cost = cost_at(curve, std::pow(10.0, -0.2 * k))) {
        CHECK(*cost <= before * (1.0 + 1e-12));
        before = *cost;
      }
  }
}

TEST_CASE("measure: failed settings and zero errors do not break the cost curve") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(cost_at(std::vector<WorkPoint>{{nan, 1.0}, {1e-4, 2.0}}, 1e-3) == 2.0);
  CHECK_FALSE(cost_at(std::vector<WorkPoint>{{1e-4, 2.0}, {nan, 4.0}}, 1e-3));
  CHECK_FALSE(cost_at(std::vector<WorkPoint>{{1e-4, 2.0}, {1e-5, nan}}, 1e-3));
  CHECK(cost_at(std::vector<WorkPoint>{{1e-2, 1.0}, {0.0, 2.0}}, 1e-3) == 2.0);
}

TEST_CASE("measure: all costs of a level are those of one setting") {
  // As a solver behaves that fails at its third tolerance: the looser ones do not count for that.
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<WorkPoint> failing{{5e-5, 0.03}, {1e-6, 0.06}, {nan, nan}, {1e-9, 1.2}};
  const double evaluations[] = {54484.0, 108925.0, 200000.0, 1798682.0};
  for (const double level : {1e-2, 1e-6}) {
    const auto setting = gnomon::level_setting(failing, level);
    REQUIRE(setting);
    CHECK(setting->place == 3);
    CHECK(setting->upper_bound);
    CHECK(gnomon::cost_there(*setting, evaluations).cost == 1798682.0);
    CHECK(gnomon::level_cost(failing, level)->cost == 1.2);
  }
  // Chosen by the first cost, even where another setting needs less of the second; mixed in one proportion.
  const std::vector<WorkPoint> curve{{1e-1, 1.0}, {1e-3, 4.0}, {1e-5, 2.0}, {1e-7, 8.0}};
  const double other[] = {10.0, 20.0, 3000.0, 4000.0};
  const auto by_time = gnomon::level_setting(curve, 1e-4);
  REQUIRE(by_time);
  CHECK(by_time->place == 2);
  CHECK(by_time->looser_part == 0.0);  // the looser one costs more
  CHECK(gnomon::cost_there(*by_time, other).cost == 3000.0);
  const auto mixed = gnomon::level_setting(curve, 1e-6);
  REQUIRE(mixed);
  CHECK(mixed->place == 3);
  CHECK(std::abs(mixed->looser_part - 0.5) <= 1e-12);
  CHECK(std::abs(gnomon::cost_there(*mixed, other).cost - std::sqrt(3000.0 * 4000.0)) <= 1e-9);
  CHECK(std::abs(gnomon::level_cost(curve, 1e-6)->cost - 4.0) <= 1e-12);
}

TEST_CASE("measure: the Pareto front keeps what nothing else beats") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<WorkPoint> points{{1e-2, 1.0}, {1e-3, 2.0}, {1e-3, 3.0}, {2e-3, 2.0},
                                      {1e-5, 9.0}, {1e-5, 9.0}, {nan, 0.5},  {1e-9, nan}};
  CHECK(pareto_front(points) == std::vector<bool>{true, true, false, false, true, true, false, false});
  CHECK(pareto_front({}).empty());
}

TEST_CASE("measure: a cost that rests on fewer than three settings says so") {
  const std::vector<WorkPoint> curve{{1e-2, 1.0}, {1e-4, 2.0}, {1e-6, 4.0}, {1e-8, 8.0}};
  const auto few = [&](double level) { return gnomon::level_cost(curve, level).value().few; };
  CHECK_FALSE(few(1e-2));
  CHECK_FALSE(few(1e-4));
  CHECK(few(1e-6));
  CHECK(few(1e-8));
}
