#include "integrators/generic/gauss.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/catch.hpp"
#include "tests/generic/problems.hpp"

namespace {

using gnomon::generic::gauss_tableau;
using gnomon::generic::GaussTableau;
using gnomon::generic::integrate_gauss;
using gnomon::generic::Status;
using gnomon::generic::test::distance;
using gnomon::generic::test::Kepler;
using gnomon::generic::test::many;
using gnomon::generic::test::Oscillator;
using Long = long double;

}  // namespace

TEST_CASE("generic: the Gauss coefficients satisfy their order conditions, and no more") {
  for (const int stages : {1, 2, 3, 5, 8, 12}) {
    const GaussTableau<Long> g = gauss_tableau<Long>(stages);
    const auto s = static_cast<std::size_t>(stages);
    REQUIRE(g.stages == stages);
    // Quadrature exact for degrees below 2 s; beyond, the error of the Gauss formula,
    // int_0^1 x^(2s) - sum b c^(2s) = (s!)^4 / ((2s)!^2 (2s + 1)).
    for (int k = 1; k <= 2 * stages + 1; ++k) {
      Long sum = 0;
      for (std::size_t i = 0; i < s; ++i) sum += g.b[i] * std::pow(g.c[i], Long(k - 1));
      Long expected = 1 / Long(k);
      if (k == 2 * stages + 1) {
        const Long ratio =
            std::tgamma(Long(stages + 1)) * std::tgamma(Long(stages + 1)) / std::tgamma(Long(k));
        expected -= ratio * ratio / Long(k);
      }
      CHECK(std::abs(sum - expected) <= 5e-19L);
    }
    for (std::size_t i = 0; i < s; ++i)
      for (int k = 1; k <= stages; ++k) {
        Long inside = 0, beyond = 0, size = 0;
        for (std::size_t j = 0; j < s; ++j) {
          const Long power = std::pow(g.c[j], Long(k - 1));
          inside += g.a[i * s + j] * power;
          beyond += g.extrapolate[i * s + j] * power;
          size += std::abs(g.extrapolate[i * s + j] * power);
        }
        CHECK(std::abs(inside - std::pow(g.c[i], Long(k)) / Long(k)) <= 5e-19L);
        CHECK(std::abs(beyond - std::pow(1 + g.c[i], Long(k - 1))) <= 2e-18L * size);
      }
  }
  const auto two = gauss_tableau<double>(2);
  CHECK(std::abs(two.c[0] - (0.5 - std::sqrt(3.0) / 6)) <= 2e-16);
  CHECK(std::abs(two.a[1] - (0.25 - std::sqrt(3.0) / 6)) <= 2e-16);
  CHECK(gauss_tableau<double>(0).stages == 0);
  CHECK(gauss_tableau<double>(33).stages == 0);
}

TEST_CASE("generic: Gauss collocation has order 2 s, not less and not more") {
  const Kepler<double> kepler;
  const std::vector<double> scale(4, 1);
  const double t1 = 8;
  for (const int stages : {2, 3, 4}) {
    const auto tableau = gauss_tableau<double>(stages);
    std::vector<double> slopes;
    double previous = 0, previous_steps = 1;
    for (int level = 0; level < 14; ++level) {
      const long steps = std::lround(8 * std::pow(2.0, 0.5 * level));
      auto y = kepler.initial();
      REQUIRE(integrate_gauss(kepler, y, 0.0, t1, steps, scale, many, tableau).ok);
      const double error = static_cast<double>(distance(y, kepler.position(t1)));
      const double ratio = std::log(static_cast<double>(steps) / previous_steps);
      if (level > 0 && error > 2e-13 && previous < 1e-5) slopes.push_back(std::log(previous / error) / ratio);
      previous = error;
      previous_steps = static_cast<double>(steps);
    }
    REQUIRE(slopes.size() >= 4);
    std::sort(slopes.begin(), slopes.end());
    INFO("stages " << stages << ", slopes from " << slopes.front() << " to " << slopes.back());
    CHECK(std::abs(slopes[slopes.size() / 2] - 2 * stages) <= 0.1);
    CHECK(slopes.front() >= 2 * stages - 0.3);
    CHECK(slopes.back() <= 2 * stages + 0.3);
  }
}

TEST_CASE("generic: Gauss collocation reaches the rounding level of long double on closed forms") {
  const Kepler<Long> kepler;
  const std::vector<Long> scale(4, 1);
  for (const Long t1 : {15.7L, -15.7L}) {
    auto y = kepler.initial();
    const auto out = integrate_gauss(kepler, y, Long(0), t1, 256, scale, many);
    CHECK(out.ok);
    CHECK(out.t == t1);
    CHECK(out.steps == 256);
    CHECK(distance(y, kepler.position(t1)) <= 1e-17L);
    // Negative control: too few steps are seen.
    y = kepler.initial();
    CHECK(integrate_gauss(kepler, y, Long(0), t1, 12, scale, many).ok);
    CHECK(distance(y, kepler.position(t1)) >= 1e-11L);
  }
  const Oscillator<Long> oscillator;
  auto y = oscillator.initial();
  CHECK(integrate_gauss(oscillator, y, Long(0), 20.0L, 100, {1, 1}, many).ok);
  CHECK(distance(y, oscillator.exact(20)) <= 1e-18L);
}

TEST_CASE("generic: Gauss collocation keeps rounding small over many steps") {
  // 100000 uncompensated additions to numbers of size 1 would leave some 1e-14; times that were not exact,
  // 1e-15.
  const Oscillator<double> oscillator;
  auto y = oscillator.initial();
  REQUIRE(integrate_gauss(oscillator, y, 0.0, 10.0, 100'000, {1, 1}, many, gauss_tableau<double>(4)).ok);
  CHECK(distance(y, oscillator.exact(10)) <= 1.5e-16L);
}

TEST_CASE("generic: Gauss collocation reports stage equations that do not converge") {
  const auto stiff = [](double, const double* y, double* dydt) { dydt[0] = -1000 * y[0]; };
  std::vector<double> y{1};
  auto out = integrate_gauss(stiff, y, 0.0, 1.0, 10, {1}, many);
  CHECK_FALSE(out.ok);
  CHECK(out.status == Status::no_convergence);
  CHECK_FALSE(out.message.empty());
  CHECK(out.t == 0);
  CHECK(y[0] == 1);
  y = {1};
  out = integrate_gauss(stiff, y, 0.0, 1.0, 2000, {1}, many);
  CHECK(out.ok);
  CHECK(std::abs(y[0]) <= 1e-15);
}

TEST_CASE("generic: Gauss collocation reports a right-hand side that is not a number, and its limits") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto late = [&](double t, const double* x, double* dydt) { dydt[0] = t > 0.5 ? nan : -x[0]; };
  std::vector<double> y{1};
  auto out = integrate_gauss(late, y, 0.0, 1.0, 16, {1}, many);
  CHECK_FALSE(out.ok);
  CHECK(out.t == 0.5);
  CHECK(out.steps == 8);
  CHECK(std::abs(y[0] - std::exp(-0.5)) <= 1e-15);

  const auto always = [&](double, const double*, double* dydt) { dydt[0] = nan; };
  y = {1};
  out = integrate_gauss(always, y, 0.0, 1.0, 16, {1}, many);
  CHECK(out.status == Status::not_finite);
  CHECK(out.evaluations == 1);

  long calls = 0;
  const auto counted = [&](double, const double* x, double* dydt) {
    ++calls;
    dydt[0] = x[1];
    dydt[1] = -x[0];
  };
  y = {1, 0};
  out = integrate_gauss(counted, y, 0.0, 1e6, 1'000'000'000, {1, 1}, 1000);
  CHECK(out.status == Status::evaluation_limit);
  CHECK(out.evaluations == calls);
  CHECK(calls <= 1000);
  CHECK(calls > 950);
}

TEST_CASE("generic: Gauss collocation notices a load that sets in after an equilibrium") {
  // The previous step's slopes, and with them the starting values, are all zero.
  const auto load = [](double t, const double*, double* dydt) { dydt[0] = t > 1 ? 2 * (t - 1) : 0; };
  std::vector<double> y{0};
  const auto out = integrate_gauss(load, y, 0.0, 2.0, 2, {1}, many);
  CHECK(out.ok);
  CHECK(std::abs(y[0] - 1) <= 1e-15);

  // The midpoint rule for y' = 1 - y with h = 1 from 0 gives 1 / (1 + 1/2).
  const auto relax = [](double t, const double* x, double* dydt) { dydt[0] = (t > 1 ? 1 : 0) - x[0]; };
  y = {0};
  CHECK(integrate_gauss(relax, y, 0.0, 2.0, 2, {1}, many, gauss_tableau<double>(1)).ok);
  CHECK(std::abs(y[0] - 2.0 / 3) <= 1e-15);
}

TEST_CASE("generic: Gauss collocation refuses bad arguments") {
  const Oscillator<double> f;
  auto y = f.initial();
  CHECK(integrate_gauss(f, y, 0.0, 1.0, 0, {1, 1}, many).status == Status::invalid_argument);
  CHECK(integrate_gauss(f, y, 0.0, 1.0, 4, {1}, many).status == Status::invalid_argument);
  CHECK(integrate_gauss(f, y, 0.0, 1.0, 4, {1, 1}, many, GaussTableau<double>{}).status ==
        Status::invalid_argument);
  const auto none = integrate_gauss(f, y, 2.0, 2.0, 4, {1, 1}, many);
  CHECK(none.ok);
  CHECK(none.evaluations == 0);
  CHECK(y == f.initial());
}
