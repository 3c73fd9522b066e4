// Orders that go over into another one on the way to a floor.
#include <cmath>
#include <random>
#include <vector>

#include "src/measure/order.hpp"
#include "tests/catch.hpp"

using namespace gnomon;

namespace {

/// e = 6e7 h^order (1 + h / turn) with a floor at which it scatters, steps by a factor 2 from 0.0028 on.
std::vector<OrderPoint> turning(double turn, double floor, double order, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<OrderPoint> points;
  for (int k = 0; k < 12; ++k) {
    const double h = 0.0028 * std::exp2(-k);
    points.push_back(
        {h, std::abs(6e7 * std::pow(h, order) * (1.0 + h / turn) + floor * uniform(random)), true, ""});
  }
  return points;
}

OrderOptions angle_of_order_4() {
  OrderOptions options;
  options.scale = 3.14159;
  options.declared = 4.0;
  return options;
}

}  // namespace

TEST_CASE(
    "measure: an order on its way from 5 to 4 is not reported as one between, whatever its floor does") {
  const OrderOptions options = angle_of_order_4();
  int approaching = 0, between = 0;
  for (const double floor : {1e-12, 3e-12, 6e-12})
    for (unsigned seed = 1; seed <= 100; ++seed) {
      const ObservedOrder order = observe_order(turning(1.3e-4, floor, 4.0, seed), options);
      approaching += order.finding == OrderFinding::approaching;
      between += order.finding == OrderFinding::differs;
    }
  INFO(approaching << " approaching, " << between << " reported of 300");
  CHECK(approaching >= 200);
  CHECK(between <= 15);
  // What really is of order 4.5, or 4, with the same floors is found.
  int half = 0, whole = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    const ObservedOrder odd = observe_order(turning(1e9, 1e-11, 4.5, seed), options);
    half += odd.finding == OrderFinding::differs && std::abs(*odd.observed - 4.5) <= 0.02;
    const ObservedOrder even = observe_order(turning(1e9, 1e-11, 4.0, seed), options);
    whole += even.finding == OrderFinding::as_declared && std::abs(*even.observed - 4.0) <= 0.02;
  }
  INFO(half << " " << whole);
  CHECK(half >= 95);
  CHECK(whole >= 95);
}

TEST_CASE("measure: a scheme of order 4 on a fast top and on a turning body, as they were run") {
  const auto finding = [](double first, const std::vector<double>& errors) {
    std::vector<OrderPoint> points;
    double h = first;
    for (const double error : errors) {
      points.push_back({h, error, true, ""});
      h *= 0.5;
    }
    const ObservedOrder order = observe_order(points, angle_of_order_4());
    INFO(order.verdict);
    CHECK_FALSE(order.observed);
    return order.finding;
  };
  // The last error above roundoff is half as large as its neighbours have it.
  CHECK(finding(0.002853, {7.568e-2, 2.446e-3, 8.412e-5, 3.135e-6, 1.301e-7, 6.093e-9, 3.168e-10, 1.228e-11,
                           5.37e-12, 6.49e-12, 1.87e-12}) == OrderFinding::approaching);
  CHECK(finding(0.1, {1.0e-3, 3.8e-5, 1.24e-6, 4.0e-8, 1.48e-9, 7.1e-11, 4.2e-12, 2.8e-13, 6.5e-14, 9.5e-14,
                      5.1e-14}) == OrderFinding::approaching);
}

TEST_CASE("measure: scatter of a floor behind an order is no other order") {
  // An error of order 6 at roundoff from the seventh of the steps on, where it rises and scatters.
  const std::vector<double> errors{1.1098e-9,  1.6250e-10, 1.7083e-11, 1.9283e-12, 2.6566e-13, 3.4402e-14,
                                   3.9045e-15, 4.4271e-15, 3.2287e-15, 4.4863e-15, 4.9692e-15, 3.8836e-14,
                                   1.3576e-14, 1.0708e-14, 3.6462e-14, 3.2438e-14, 2.7911e-14, 2.5117e-14,
                                   4.6783e-14, 2.0994e-14, 1.1159e-13};
  const auto points = [&](double unit) {
    std::vector<OrderPoint> list;
    for (std::size_t k = 0; k < errors.size(); ++k) {
      const double counts = std::round(8.0 * std::pow(2.0, 0.5 * static_cast<double>(k)));
      list.push_back({5.0 / counts, unit * errors[k], true, ""});
    }
    return list;
  };
  OrderOptions options;
  options.scale = 3.14159;
  options.declared = 6.0;
  const ObservedOrder order = observe_order(points(1.0), options);
  REQUIRE(order.observed);
  CHECK(std::abs(*order.observed - 6.0) <= 0.1);
  CHECK(order.finding == OrderFinding::as_declared);
  CHECK(order.points == 7);
  // Nor where the bound of the reference takes the least of them out.
  options.bound = 1.7764e-15;
  const ObservedOrder bounded = observe_order(points(1.0), options);
  REQUIRE(bounded.observed);
  CHECK(std::abs(*bounded.observed - 6.0) <= 0.1);
  CHECK(bounded.points == 6);
  options.bound = 0.0;
  // The same far above roundoff contradicts it.
  CHECK_FALSE(observe_order(points(1e8), options).observed);
}
