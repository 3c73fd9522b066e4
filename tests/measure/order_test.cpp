#include "src/measure/order.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/catch.hpp"

using gnomon::observe_order;
using gnomon::ObservedOrder;
using gnomon::OrderFinding;
using gnomon::OrderOptions;
using gnomon::OrderPoint;

namespace {

class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : engine_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }

 private:
  std::mt19937_64 engine_;
};

struct Curve {
  double order = 4.0;
  double constant = 0.1;
  double next = 0.0;   // a in C h^p (1 + a h^2)
  double noise = 0.0;  // relative, uniform
  double floor = 0.0;  // added, between a tenth of it and all of it
  double ratio = std::sqrt(2.0);
  int points = 16;
  std::uint64_t seed = 1;
};

std::vector<OrderPoint> sample(const Curve& curve) {
  Uniform uniform(curve.seed);
  std::vector<OrderPoint> points;
  for (int k = 0; k < curve.points; ++k) {
    const double h = 0.5 * std::pow(curve.ratio, -k);
    const double clean = curve.constant * std::pow(h, curve.order) * (1.0 + curve.next * h * h);
    const double noisy = clean * (1.0 + curve.noise * uniform(-1.0, 1.0));
    points.push_back({h, noisy + curve.floor * uniform(0.1, 1.0), true, ""});
  }
  return points;
}

OrderOptions with_scale_one() {
  OrderOptions options;
  options.scale = 1.0;
  return options;
}

double least_squares_over_all(const std::vector<OrderPoint>& points) {
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  const auto n = static_cast<double>(points.size());
  for (const OrderPoint& p : points) {
    x += std::log(p.step) / n;
    y += std::log(p.error) / n;
  }
  for (const OrderPoint& p : points) {
    xx += (std::log(p.step) - x) * (std::log(p.step) - x);
    xy += (std::log(p.step) - x) * (std::log(p.error) - y);
  }
  return xy / xx;
}

bool refused(const ObservedOrder& result) {
  return !result.observed && result.points == 0 && std::isnan(result.interval[0]) &&
         std::isnan(result.step_from) && result.verdict.starts_with("not asymptotic: ");
}

// Errors that fall from `first` with the given local slopes at steps that halve.
std::vector<double> falling(double first, const std::vector<double>& slopes) {
  std::vector<double> errors{first};
  for (const double slope : slopes) errors.push_back(errors.back() * std::exp2(-slope));
  return errors;
}

std::vector<OrderPoint> from_errors(const std::vector<double>& errors) {
  std::vector<OrderPoint> points;
  for (std::size_t k = 0; k < errors.size(); ++k)
    points.push_back({std::ldexp(1.0, -static_cast<int>(k)), errors[k], true, ""});
  return points;
}

}  // namespace

TEST_CASE("measure: a clean power law gives its order exactly, with every point in the window") {
  for (int p = 1; p <= 10; ++p) {
    const ObservedOrder result = observe_order(sample({.order = static_cast<double>(p)}), with_scale_one());
    REQUIRE(result.observed);
    CHECK(std::abs(*result.observed - p) <= 1e-9);
    CHECK(std::abs(result.interval[0] - p) <= 1e-9);
    CHECK(std::abs(result.interval[1] - p) <= 1e-9);
    CHECK(result.points == 16);
    CHECK(result.step_from == 0.5);
    CHECK(std::abs(result.step_to - 0.5 * std::pow(2.0, -7.5)) <= 1e-12);
    CHECK(result.dropped.empty());
  }
}

TEST_CASE("measure: orders 1 to 10 are found above floors of 1e-16 to 1e-10") {
  const bool known = GENERATE(true, false);
  int numbers = 0, refusals = 0;
  for (int p = 1; p <= 10; ++p) {
    for (const double floor : {1e-16, 1e-14, 1e-12, 1e-10}) {
      const auto points = sample({.order = static_cast<double>(p), .constant = 1.0, .floor = floor});
      OrderOptions options = with_scale_one();
      if (known) options.floor = 10.0 * floor;
      int above = 0;  // points that the floor alters by less than 1 %
      for (const OrderPoint& point : points)
        above += point.error < 0.1 && std::pow(point.step, p) > 100.0 * floor;
      const ObservedOrder result = observe_order(points, options);
      INFO("p " << p << " floor " << floor << " above " << above << ": " << result.verdict);
      if (result.observed) {
        ++numbers;
        CHECK(std::abs(*result.observed - p) <= 0.1);
        CHECK(result.points >= 4);
        CHECK(result.points + static_cast<int>(result.dropped.size()) == 16);
      } else {
        ++refusals;
        CHECK(refused(result));
        // Without knowing the floor, its beginning at the end of the ladder may pass for another order.
        CHECK((above < 4 || !known));
      }
    }
  }
  CHECK(numbers >= 36);
  CHECK(numbers + refusals == 40);
}

TEST_CASE(
    "measure: least squares over all points is wrong for orders 6 and 8 with a floor, the window right") {
  for (const int p : {6, 8}) {
    const auto points =
        sample({.order = static_cast<double>(p), .constant = 1.0, .next = 0.5, .floor = 1e-12});
    const ObservedOrder result = observe_order(points, with_scale_one());
    REQUIRE(result.observed);
    CHECK(std::abs(*result.observed - p) <= 0.1);
    CHECK(least_squares_over_all(points) < p - 0.5);
    CHECK(result.dropped.back().reason == "beyond the window");
    // Without the floor both agree: it is the floor that misleads least squares.
    const auto clean = sample({.order = static_cast<double>(p), .constant = 1.0});
    CHECK(std::abs(least_squares_over_all(clean) - p) <= 1e-9);
  }
}

TEST_CASE("measure: pre-asymptotic points are left out of the window") {
  for (int p = 1; p <= 8; ++p) {
    const auto points = sample({.order = static_cast<double>(p), .constant = 1e-3, .next = 10.0});
    const ObservedOrder result = observe_order(points, with_scale_one());
    REQUIRE(result.observed);
    CHECK(std::abs(*result.observed - p) <= 0.1);
    CHECK(result.step_from < 0.2);
    CHECK(result.step_to == points.back().step);
    REQUIRE_FALSE(result.dropped.empty());
    CHECK(result.dropped.front().reason == "before the window");
    const double first_slope = std::log(points[0].error / points[1].error) / std::log(std::sqrt(2.0));
    CHECK(first_slope > p + 1.0);
  }
}

TEST_CASE("measure: noise widens the interval, and beyond the tolerance it is refused rather than guessed") {
  int refusals = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    for (const int p : {2, 4, 8}) {
      Curve curve{.order = static_cast<double>(p), .noise = 0.05, .ratio = 2.0, .points = 10, .seed = seed};
      const ObservedOrder quiet = observe_order(sample(curve), with_scale_one());
      REQUIRE(quiet.observed);
      CHECK(std::abs(*quiet.observed - p) <= 0.05);
      CHECK(quiet.interval[0] <= *quiet.observed);
      CHECK(quiet.interval[1] >= *quiet.observed);
      CHECK(quiet.interval[1] - quiet.interval[0] >= 1e-3);

      curve.noise = 0.2;
      const auto points = sample(curve);
      const ObservedOrder loud = observe_order(points, with_scale_one());
      if (loud.observed)
        CHECK(std::abs(*loud.observed - p) <= 0.3);
      else
        ++refusals;
      OrderOptions tolerant = with_scale_one();
      tolerant.window_tolerance = 0.6;  // > log2(1.2 / 0.8)
      const ObservedOrder fitted = observe_order(points, tolerant);
      REQUIRE(fitted.observed);
      CHECK(std::abs(*fitted.observed - p) <= 0.15);
    }
  }
  CHECK(refusals >= 10);
  CHECK(refusals <= 140);
}

TEST_CASE("measure: curves without an asymptotic range get no order") {
  Uniform uniform(3);
  std::vector<double> scatter, sawtooth, flat, rising;
  for (int k = 0; k < 16; ++k) {
    scatter.push_back(std::exp(uniform(-12.0, -2.0)));
    sawtooth.push_back(std::ldexp(1e-2, -2 * k) * (k % 2 == 0 ? 1.0 : 4.0));
    flat.push_back(1e-5 * (1.0 + 0.01 * k));
    rising.push_back(std::ldexp(1e-12, k));
  }
  CHECK(refused(observe_order(from_errors(scatter), with_scale_one())));
  CHECK(refused(observe_order(from_errors(sawtooth), with_scale_one())));
  CHECK(observe_order(from_errors(sawtooth), with_scale_one()).verdict ==
        "not asymptotic: no 4 successive points share a slope to within 0.25");
  CHECK(refused(observe_order(from_errors(flat), with_scale_one())));
  CHECK(observe_order(from_errors(flat), with_scale_one()).verdict ==
        "not asymptotic: the error does not fall with the step");
  CHECK(refused(observe_order(from_errors(rising), with_scale_one())));
}

TEST_CASE("measure: a long floor does not outvote a short asymptotic range") {
  std::vector<double> errors;
  for (int k = 0; k < 5; ++k) errors.push_back(std::ldexp(1e-2, -4 * k));
  for (int k = 0; k < 11; ++k) errors.push_back(errors.back());
  const ObservedOrder result = observe_order(from_errors(errors), with_scale_one());
  REQUIRE(result.observed);
  CHECK(std::abs(*result.observed - 4.0) <= 1e-9);
  CHECK(result.points == 5);
  CHECK(result.dropped.size() == 11);
}

TEST_CASE("measure: scatter at a floor behind a few steep points is no order") {
  // Order 8 for three points, then scatter in which four points happen to line up at a slope of 0.5.
  const ObservedOrder result = observe_order(
      from_errors({1e-2, 4e-5, 1.5e-7, 3e-12, 2.1e-12, 1.5e-12, 1.06e-12, 3e-12, 1e-13}), with_scale_one());
  CHECK(refused(result));
  CHECK(result.verdict.find("a floor?") != std::string::npos);
  // The same with a long, nearly flat stretch.
  const auto flat = falling(1e-2, {8.0, 8.0, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3});
  CHECK(refused(observe_order(from_errors(flat), with_scale_one())));
}

TEST_CASE("measure: an order that changes inside the ladder is not reported") {
  std::vector<double> errors;
  for (int k = 0; k < 8; ++k) errors.push_back(std::ldexp(1e-2, -4 * k));
  const double corner = errors.back();
  for (int k = 1; k <= 4; ++k) errors.push_back(corner * std::ldexp(1.0, -k));
  const ObservedOrder changing = observe_order(from_errors(errors), with_scale_one());
  CHECK(refused(changing));
  CHECK(changing.verdict.find("order 4.00 turns into 1.00") != std::string::npos);
  // The longer range wins if it lies at the smaller steps: coarse points are pre-asymptotic, whatever they
  // do.
  for (int k = 5; k <= 12; ++k) errors.push_back(corner * std::ldexp(1.0, -k));
  const ObservedOrder settled = observe_order(from_errors(errors), with_scale_one());
  REQUIRE(settled.observed);
  CHECK(std::abs(*settled.observed - 1.0) <= 1e-9);
  CHECK(settled.points == 13);

  // Leaving the order slowly, without reaching a floor, is no asymptotic range either.
  const auto leaving = falling(1e-2, {3.0, 3.0, 3.0, 3.0, 2.6, 2.3, 2.1});
  CHECK(refused(observe_order(from_errors(leaving), with_scale_one())));
  // Near roundoff as few errors say nothing.
  const auto near_roundoff = falling(1e-2, {6.0, 6.0, 6.0, 6.0, 6.0, 5.2, 4.6, 4.2});
  const ObservedOrder sixth = observe_order(from_errors(near_roundoff), with_scale_one());
  REQUIRE(sixth.observed);
  CHECK(std::abs(*sixth.observed - 6.0) <= 0.05);
}

TEST_CASE("measure: a floor or irregular points beyond the window do not spoil it") {
  const std::vector<std::vector<double>> tails{
      {1.0, 2.5, -4.0},      // falls by less than half the order in all
      {0.5, 0.5, 7.0},       // a floor with a lucky zero at its end
      {5.0, 3.0, 4.6, 3.4},  // irregular, but at the same order in all
      {3.0, 2.5}             // too short to tell
  };
  for (const auto& tail : tails) {
    std::vector<double> slopes(6, 4.0);
    slopes.insert(slopes.end(), tail.begin(), tail.end());
    const ObservedOrder result = observe_order(from_errors(falling(1e-2, slopes)), with_scale_one());
    INFO(result.verdict);
    REQUIRE(result.observed);
    CHECK(std::abs(*result.observed - 4.0) <= 1e-9);
    CHECK(result.points == 7);
    CHECK(result.dropped.size() == tail.size());
  }
}

TEST_CASE("measure: one irregular point splits the ladder and the smaller steps win the tie") {
  std::vector<double> errors;
  for (int k = 0; k < 9; ++k) errors.push_back(std::ldexp(1e-2, -3 * k));
  errors[4] *= 1e-3;  // a lucky change of the error's sign
  const ObservedOrder result = observe_order(from_errors(errors), with_scale_one());
  REQUIRE(result.observed);
  CHECK(std::abs(*result.observed - 3.0) <= 1e-9);
  CHECK(result.points == 4);
  CHECK(result.step_from == std::ldexp(1.0, -5));
  CHECK(result.step_to == std::ldexp(1.0, -8));
}

TEST_CASE("measure: points that cannot count are dropped with their reason") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<OrderPoint> points = sample({.order = 2.0, .constant = 0.01, .ratio = 2.0, .points = 6});
  points.push_back({8.0, 0.2, true, ""});
  points.push_back({4.0, 1e-3, false, "misses the break at 2.5"});
  points.push_back({2.0, nan, true, ""});
  points.push_back({1e-3, 0.0, true, ""});
  points.push_back({1e-4, 4e-9, true, ""});
  points.push_back({1e-5, 3e-8, true, ""});
  points.push_back({0.25, 1e-3, true, ""});
  points.push_back({nan, 1e-3, true, ""});
  points.push_back({-1.0, 1e-3, false, ""});
  OrderOptions options = with_scale_one();
  options.bound = 1e-9;
  options.floor = 4e-8;
  const ObservedOrder result = observe_order(points, options);
  REQUIRE(result.observed);
  CHECK(std::abs(*result.observed - 2.0) <= 1e-9);
  CHECK(result.points == 6);
  std::vector<std::string> reasons;
  for (const auto& dropped : result.dropped) reasons.push_back(dropped.reason);
  CHECK(reasons == std::vector<std::string>{"pre-asymptotic: the error is a tenth of the scale or more",
                                            "misses the break at 2.5", "the error is not a number",
                                            "the step occurs twice", "the error is zero: below every floor",
                                            "within ten times the reference's error bound", "below the floor",
                                            "not usable", "the step is not a positive number"});
}

TEST_CASE("measure: fewer points than asked for give no order") {
  const auto points = sample({.order = 4.0, .points = 5});
  CHECK(observe_order(points, with_scale_one()).points == 5);
  OrderOptions options = with_scale_one();
  options.min_points = 6;
  CHECK(refused(observe_order(points, options)));
  CHECK(observe_order(points, options).verdict == "not asymptotic: 5 of the points can count, 6 are needed");
  CHECK(refused(observe_order({}, with_scale_one())));
  options.min_points = 0;  // two points always lie on a line
  CHECK(refused(observe_order({points[0], points[1]}, options)));
  CHECK(observe_order({points[0], points[1], points[2]}, options).points == 3);
}

TEST_CASE("measure: the order does not depend on how the points are sorted") {
  auto points = sample({.order = 3.0, .next = 2.0, .noise = 0.02, .floor = 1e-9});
  const ObservedOrder sorted = observe_order(points, with_scale_one());
  Uniform uniform(9);
  for (std::size_t i = points.size(); i > 1; --i)
    std::swap(points[i - 1], points[static_cast<std::size_t>(uniform(0.0, static_cast<double>(i)))]);
  const ObservedOrder shuffled = observe_order(points, with_scale_one());
  REQUIRE(sorted.observed);
  CHECK(shuffled.observed == sorted.observed);
  CHECK(shuffled.step_from == sorted.step_from);
  CHECK(shuffled.dropped.size() == sorted.dropped.size());
}

TEST_CASE("measure: scatter at roundoff behind an order is a floor, the same at large errors is not") {
  // The last seven errors of a scheme of order 4 against a closed form, steps by a factor sqrt 2.
  const std::vector<double> scatter{1.12e-11, 6.48e-12, 6.88e-13, 2.93e-13, 4.61e-14, 3.12e-13};
  std::vector<OrderPoint> points;
  for (int k = -10; k < 0; ++k)
    points.push_back({std::exp2(-0.5 * k), 1.12e-11 * std::exp2(-2.0 * k), true, ""});
  for (std::size_t k = 0; k < scatter.size(); ++k)
    points.push_back({std::exp2(-0.5 * static_cast<double>(k)), scatter[k], true, ""});
  const ObservedOrder result = observe_order(points, with_scale_one());
  INFO(result.verdict);
  REQUIRE(result.observed);
  CHECK(std::abs(*result.observed - 4.0) <= 0.01);
  CHECK(result.points == 11);
  for (OrderPoint& point : points) point.error *= 1e6;
  const ObservedOrder large = observe_order(points, {});
  INFO(large.verdict);
  CHECK(refused(large));
  CHECK(large.verdict.find("which is no floor") != std::string::npos);
}

TEST_CASE("measure: an order whose local slopes keep moving is not reported, one that comes to rest is") {
  const auto moving = [](double from, double by, int count) {
    std::vector<double> slopes;
    for (int k = 0; k < count; ++k) slopes.push_back(from + by * k);
    return from_errors(falling(1e-2, slopes));
  };
  OrderOptions options = with_scale_one();
  options.declared = 4.0;
  const ObservedOrder down = observe_order(moving(4.45, -0.05, 10), options);
  INFO(down.verdict);
  CHECK(refused(down));
  CHECK(down.finding == OrderFinding::approaching);
  CHECK(down.verdict.find("the local slopes move from") != std::string::npos);
  CHECK(down.verdict.ends_with("; approaching 4"));
  // Away from the declared order it approaches nothing.
  const ObservedOrder away = observe_order(moving(4.0, 0.05, 10), options);
  CHECK(refused(away));
  CHECK(away.finding == OrderFinding::none);
  // A tenth in all is little enough.
  const ObservedOrder little = observe_order(moving(4.04, -0.008, 11), options);
  REQUIRE(little.observed);
  CHECK(little.points == 12);
  CHECK(little.finding == OrderFinding::as_declared);
  // Slopes that come to rest lose their first points only.
  std::vector<double> slopes;
  for (int k = 0; k < 14; ++k) slopes.push_back(4.0 - 0.3 * std::pow(0.7, k));
  const ObservedOrder resting = observe_order(from_errors(falling(1e-1, slopes)), options);
  REQUIRE(resting.observed);
  CHECK(std::abs(*resting.observed - 4.0) <= 0.03);
  CHECK(resting.points >= 10);
  CHECK(resting.points <= 14);
  // Noise without a trend is no movement: all points stay.
  int full = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const auto noisy = sample({.order = 4.0, .noise = 0.03, .ratio = 2.0, .points = 12, .seed = seed});
    const ObservedOrder order = observe_order(noisy, options);
    REQUIRE(order.observed);
    full += order.points == 12;
  }
  INFO(full);
  CHECK(full >= 95);
}

TEST_CASE(
    "measure: a short rise above the order at the smallest steps contradicts it, a short fall does not") {
  OrderOptions options = with_scale_one();
  options.declared = 2.0;
  const auto ending = [&](double a, double b) {
    return observe_order(from_errors(falling(1e-2, {1.45, 1.42, 1.44, 1.43, a, b})), options);
  };
  CHECK(ending(1.93, 1.89).finding == OrderFinding::approaching);
  CHECK(refused(ending(1.93, 1.89)));
  CHECK(ending(0.93, 0.89).observed);
  CHECK(ending(1.93, 0.89).observed);
}

TEST_CASE("measure: an order is compared with the declared one on both sides") {
  const auto finding = [](double order, std::optional<double> declared, double noise = 0.0) {
    OrderOptions options = with_scale_one();
    options.declared = declared;
    return observe_order(sample({.order = order, .noise = noise}), options);
  };
  CHECK(finding(2.0, {}).finding == OrderFinding::observed);
  CHECK(finding(2.0, 2.0).finding == OrderFinding::as_declared);
  CHECK(finding(2.09, 2.0).finding == OrderFinding::as_declared);
  CHECK(finding(2.11, 2.0).finding == OrderFinding::differs);
  CHECK(finding(1.89, 2.0).finding == OrderFinding::differs);
  CHECK(finding(10.19, 10.0).finding == OrderFinding::as_declared);  // 2 %
  CHECK(finding(10.21, 10.0).finding == OrderFinding::differs);
  CHECK(finding(1.5, 2.0).verdict == "order 1.50 from 16 points, differs from the declared 2");
  CHECK(finding(1.5, 2.0).observed == finding(1.5, {}).observed);
}

TEST_CASE("measure: errors at roundoff at every step are exact, or hide a declared order") {
  Uniform uniform(5);
  std::vector<OrderPoint> points;
  for (int k = 0; k < 16; ++k) points.push_back({std::ldexp(1.0, -k), 1e-14 * uniform(0.1, 1.0), true, ""});
  OrderOptions options = with_scale_one();
  CHECK(observe_order(points, options).finding == OrderFinding::exact);
  CHECK(observe_order(points, options).verdict == "exact: the error is at roundoff at every step");
  options.declared = 8.0;
  CHECK(observe_order(points, options).finding == OrderFinding::roundoff);
  CHECK(refused(observe_order(points, options)));
  options.declared = {};
  // What falls to roundoff is not exact, nor what stays above it.
  auto falls = points;
  falls[0].error = 1e-8;
  CHECK(observe_order(falls, options).finding == OrderFinding::none);
  for (OrderPoint& point : points) point.error *= 1e6;
  CHECK(observe_order(points, options).finding == OrderFinding::none);
}

TEST_CASE("measure: slopes that come closer to the declared order until roundoff approach it") {
  const std::vector<double> roundoff{-0.8, -1.2, -3.3, 0.0, 2.1, -1.1, -2.5, 1.2};
  const auto finding = [&](double first, std::vector<double> slopes, double declared) {
    slopes.insert(slopes.end(), roundoff.begin(), roundoff.end());
    OrderOptions options = with_scale_one();
    options.declared = declared;
    const ObservedOrder order = observe_order(from_errors(falling(first, slopes)), options);
    CHECK_FALSE(order.observed);
    return order.finding;
  };
  CHECK(finding(4e-4, {10.0, 9.3, 8.6, 8.2}, 8.0) == OrderFinding::approaching);
  CHECK(finding(4e-6, {9.2, 8.24, 8.02}, 8.0) == OrderFinding::approaching);
  CHECK(finding(4e-4, {10.0, 9.3, 8.6, 8.2}, 6.0) == OrderFinding::none);  // not close
  CHECK(finding(4e-4, {10.0, 8.2, 9.3, 8.6}, 8.0) == OrderFinding::none);  // to and fro
  CHECK(finding(4e-4, {10.0, 9.3}, 8.0) == OrderFinding::none);            // too few
  CHECK(finding(0.05, {5.0, 4.6, 4.3, 4.05}, 4.0) == OrderFinding::none);  // far above roundoff
}
