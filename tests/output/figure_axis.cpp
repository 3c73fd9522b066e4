#include "src/output/figure_axis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/catch.hpp"

using namespace gnomon::output;

namespace {

std::vector<std::string> labels(const Axis& axis) {
  std::vector<std::string> result;
  for (const Tick& tick : axis.ticks) {
    if (!tick.label.empty()) result.push_back(tick.label);
  }
  return result;
}

std::size_t minor_ticks(const Axis& axis) { return axis.ticks.size() - labels(axis).size(); }

using Labels = std::vector<std::string>;

}  // namespace

TEST_CASE("output: log axes label powers of ten with minor ticks between") {
  const Axis decades = make_axis(true, Range{2e-3, 0.5e1}, {}, 8);
  CHECK(labels(decades) == Labels{"10^{−2}", "10^{−1}", "10^{0}"});
  CHECK(minor_ticks(decades) == 8 + 8 + 8 + 5);  // 2 to 9 in three decades, 2 to 6 in the last
  const Axis many = make_axis(true, Range{1e-14, 1e-1}, {}, 8);
  CHECK(labels(many) ==
        Labels{"10^{−14}", "10^{−12}", "10^{−10}", "10^{−8}", "10^{−6}", "10^{−4}", "10^{−2}"});
  CHECK(minor_ticks(many) == 7);  // the odd powers
  CHECK(minor_ticks(make_axis(true, Range{1e-100, 1e100}, {}, 8)) == 0);
}

TEST_CASE("output: short log axes label 1, 2 and 5") {
  CHECK(labels(make_axis(true, Range{0.01, 0.05}, {}, 8)) == Labels{"0.01", "0.02", "0.05"});
  CHECK(labels(make_axis(true, Range{1e-7, 4e-7}, {}, 8)) == Labels{"10^{−7}", "2×10^{−7}", "5×10^{−7}"});
  CHECK(labels(make_axis(true, Range{5.0, 5.0}, {}, 8)) == Labels{"2", "5", "10"});
}

TEST_CASE("output: linear axes have round steps") {
  CHECK(labels(make_axis(false, Range{0.0, 1.0}, {}, 6)) == Labels{"0", "0.2", "0.4", "0.6", "0.8", "1.0"});
  CHECK(labels(make_axis(false, Range{-2.5, 0.0}, {}, 6)) ==
        Labels{"−2.5", "−2.0", "−1.5", "−1.0", "−0.5", "0"});
  CHECK(labels(make_axis(false, Range{0.0, 3e7}, {}, 4)) == Labels{"0", "1×10^{7}", "2×10^{7}", "3×10^{7}"});
  CHECK(labels(make_axis(false, Range{7.0, 7.0}, {}, 8)).size() >= 2);
  CHECK(minor_ticks(make_axis(false, Range{0.0, 1.0}, {}, 6)) == 5 * 3);
}

TEST_CASE("output: a fixed range is kept if it is one") {
  const Axis fixed = make_axis(true, Range{1.0, 2.0}, Range{1e-3, 1e3}, 8);
  CHECK(fixed.range.low == 1e-3);
  CHECK(fixed.range.high == 1e3);
  const Axis reversed = make_axis(true, Range{1.0, 2.0}, Range{1e3, 1e-3}, 8);
  CHECK(reversed.range.low < 1.0);
  CHECK(reversed.range.low > 0.1);
  const Axis negative = make_axis(true, Range{1.0, 2.0}, Range{-1.0, 10.0}, 8);
  CHECK(negative.range.low > 0.0);
}

TEST_CASE("output: any data get ticks within the axis, in order, with two labels or more") {
  std::mt19937 generator(4);
  std::uniform_real_distribution<double> exponent(-300.0, 300.0);
  std::uniform_real_distribution<double> decades(0.0, 20.0);
  std::uniform_real_distribution<double> sign(-1.0, 1.0);
  for (int i = 0; i < 4000; ++i) {
    const bool log = i % 2 == 0;
    const double a = std::pow(10.0, exponent(generator)) * (log ? 1.0 : sign(generator));
    const double b = log ? std::min(1e300, a * std::pow(10.0, decades(generator)))
                         : a + std::abs(a) * std::pow(10.0, -decades(generator));
    const int most = 6 + i % 8;
    const Axis axis = make_axis(log, Range{a, b}, {}, most);
    CAPTURE(log, a, b, most);
    REQUIRE(axis.range.low <= a);
    REQUIRE(axis.range.high >= b);
    REQUIRE(axis.position(a) >= 0.0);
    REQUIRE(axis.position(b) <= 1.0);
    REQUIRE(labels(axis).size() >= 2);
    REQUIRE(labels(axis).size() <= static_cast<std::size_t>(most));
    REQUIRE(axis.ticks.size() <= 200);
    for (std::size_t k = 0; k < axis.ticks.size(); ++k) {
      REQUIRE(axis.position(axis.ticks[k].value) >= -1e-9);
      REQUIRE(axis.position(axis.ticks[k].value) <= 1.0 + 1e-9);
      if (k > 0) REQUIRE(axis.ticks[k].value > axis.ticks[k - 1].value);
    }
  }
}

TEST_CASE("output: ranges pass over what cannot be drawn") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto range = range_of({nan, 3.0, -1.0, 0.0, infinity, 2.0, 1e308}, true);
  REQUIRE(range);
  CHECK(range->low == 2.0);
  CHECK(range->high == 3.0);
  CHECK(range_of({nan, 3.0, -1.0}, false)->low == -1.0);
  CHECK_FALSE(range_of({nan, 0.0, -1.0}, true));
  CHECK_FALSE(range_of({}, false));
}

TEST_CASE("output: positions and decades along an axis") {
  const Axis log = make_axis(true, {}, Range{1e-2, 1e2}, 8);
  CHECK(std::abs(log.position(1.0) - 0.5) < 1e-14);
  CHECK(std::abs(log.decade() - 0.25) < 1e-14);
  const Axis linear = make_axis(false, {}, Range{-1.0, 3.0}, 8);
  CHECK(std::abs(linear.position(0.0) - 0.25) < 1e-15);
  CHECK(linear.decade() == 0.0);
  CHECK(widest_label(make_axis(true, Range{1e-12, 1.0}, {}, 12)) == 5);  // 10−12
}
