#include "integrators/generic/extrapolation.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "tests/catch.hpp"
#include "tests/generic/problems.hpp"

namespace {

using gnomon::generic::integrate_extrapolation;
using gnomon::generic::Status;
using gnomon::generic::test::distance;
using gnomon::generic::test::Kepler;
using gnomon::generic::test::many;
using gnomon::generic::test::Oscillator;
using Long = long double;

const Long tightest = 4 * std::numeric_limits<Long>::epsilon();

}  // namespace

TEST_CASE("generic: extrapolation reaches the rounding level of long double on closed forms") {
  const Kepler<Long> kepler;
  const std::vector<Long> scale(4, 1);
  for (const Long t1 : {0.3L, 15.7L, -15.7L}) {
    auto y = kepler.initial();
    const auto out = integrate_extrapolation(kepler, y, Long(0), t1, scale, tightest, many);
    CHECK(out.ok);
    CHECK(out.message.empty());
    CHECK(out.t == t1);
    CHECK(distance(y, kepler.position(t1)) <= 2e-17L);
  }
  // A tolerance below rounding is not pursued, and that is said.
  auto x = kepler.initial();
  const auto limited = integrate_extrapolation(kepler, x, Long(0), 15.7L, scale, 1e-25L, many);
  CHECK(limited.ok);
  CHECK(limited.rounding_limited == limited.steps);
  CHECK(limited.evaluations < 10'000);
  CHECK(distance(x, kepler.position(15.7L)) <= 2e-17L);

  const Oscillator<Long> oscillator;
  auto y = oscillator.initial();
  CHECK(integrate_extrapolation(oscillator, y, Long(0), 20.0L, {1, 1}, tightest, many).ok);
  CHECK(distance(y, oscillator.exact(20)) <= 1e-17L);
}

TEST_CASE("generic: extrapolation's error follows the tolerance") {
  const Kepler<Long> kepler;
  const std::vector<Long> scale(4, 1);
  std::vector<Long> x, e;
  long evaluations = 0;
  for (int digits = 5; digits <= 16; ++digits) {
    const Long tol = std::pow(10.0L, -digits);
    auto y = kepler.initial();
    const auto out = integrate_extrapolation(kepler, y, Long(0), 15.7L, scale, tol, many);
    REQUIRE(out.ok);
    CHECK(out.rounding_limited == 0);
    CHECK(out.evaluations > evaluations);  // a tighter tolerance costs more
    evaluations = out.evaluations;
    const Long error = distance(y, kepler.position(15.7L));
    CHECK(error >= 0.1L * tol);
    CHECK(error <= 500 * tol);
    x.push_back(-digits);
    e.push_back(std::log10(error));
  }
  Long sx = 0, se = 0, sxx = 0, sxe = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sx += x[i];
    se += e[i];
    sxx += x[i] * x[i];
    sxe += x[i] * e[i];
  }
  const Long n = static_cast<Long>(x.size());
  const Long slope = (n * sxe - sx * se) / (n * sxx - sx * sx);
  INFO("slope " << slope);
  CHECK(std::abs(slope - 1) <= 0.1L);
}

TEST_CASE("generic: extrapolation measures every component by its own scale") {
  // The same oscillator with its components in other units: the steps must be the same to rounding.
  const auto rescaled = [](double, const double* y, double* dydt) {
    dydt[0] = std::ldexp(y[1], 60);
    dydt[1] = -std::ldexp(y[0], -60);
  };
  const Oscillator<double> plain;
  auto a = plain.initial();
  std::vector<double> b{1, 0};
  const auto out_a = integrate_extrapolation(plain, a, 0.0, 10.0, {1, 1}, 1e-10, many);
  const auto out_b = integrate_extrapolation(rescaled, b, 0.0, 10.0, {1, std::ldexp(1.0, -60)}, 1e-10, many);
  CHECK(out_a.evaluations == out_b.evaluations);
  CHECK(a[0] == b[0]);
  CHECK(a[1] == std::ldexp(b[1], 60));
  // Negative control: with the wrong scale the small component is not seen and the effort is another one.
  std::vector<double> c{1, 0};
  CHECK(integrate_extrapolation(rescaled, c, 0.0, 10.0, {1, 1}, 1e-10, many).evaluations !=
        out_a.evaluations);
}

TEST_CASE("generic: extrapolation reports a right-hand side that is not a number") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto always = [&](double, const double*, double* dydt) { dydt[0] = nan; };
  std::vector<double> y{1};
  auto out = integrate_extrapolation(always, y, 0.0, 1.0, {1}, 1e-10, many);
  CHECK_FALSE(out.ok);
  CHECK(out.status == Status::not_finite);
  CHECK_FALSE(out.message.empty());
  CHECK(out.t == 0);
  CHECK(y[0] == 1);

  const auto late = [&](double t, const double* x, double* dydt) { dydt[0] = t > 0.5 ? nan : -x[0]; };
  y = {1};
  out = integrate_extrapolation(late, y, 0.0, 1.0, {1}, 1e-10, many);
  CHECK_FALSE(out.ok);
  CHECK(std::abs(out.t - 0.5) <= 0.01);  // the end of a step may lie beyond, its nodes do not
  CHECK(std::abs(y[0] - std::exp(-out.t)) <= 1e-9);
  CHECK(out.evaluations < 100'000);

  // Not a number only near t = 1/3, which in a step from 0 to 1 is an even substep of every row that meets
  // it, and only in a component that nothing else depends on: the value at the end of the step would not show
  // it.
  const auto hidden = [&](double t, const double* x, double* dydt) {
    dydt[0] = -x[0];
    dydt[1] = std::abs(t - 1.0 / 3) < 1e-3 ? nan : 1.0;
  };
  std::vector<double> z{1, 0};
  out = integrate_extrapolation(hidden, z, 0.0, 1.0, {1, 1}, 1e-10, 100'000, 1.0);
  CHECK(out.rejected > 0);
  CHECK(std::isfinite(z[1]));
}

TEST_CASE("generic: extrapolation ends at its limits") {
  long calls = 0;
  const auto counted = [&](double, const double* x, double* dydt) {
    ++calls;
    dydt[0] = x[1];
    dydt[1] = -x[0];
  };
  std::vector<double> y{1, 0};
  auto out = integrate_extrapolation(counted, y, 0.0, 1e6, {1, 1}, 1e-12, 1000);
  CHECK(out.status == Status::evaluation_limit);
  CHECK(out.evaluations == calls);
  CHECK(calls <= 1000);
  CHECK(calls > 900);
  CHECK(out.t > 0);
  CHECK(std::abs(y[0] - std::cos(out.t)) <= 1e-10);  // the state belongs to the time that is reported

  calls = 0;
  y = {1, 0};
  out = integrate_extrapolation(counted, y, 0.0, 10.0, {1, 1}, 1e-12, many);
  CHECK(out.ok);
  CHECK(out.evaluations == calls);

  // y' = y^2 blows up at t = 1.
  const auto blow_up = [](double, const double* x, double* dydt) { dydt[0] = x[0] * x[0]; };
  y = {1};
  out = integrate_extrapolation(blow_up, y, 0.0, 2.0, {1}, 1e-12, many);
  CHECK_FALSE(out.ok);
  CHECK_FALSE(out.message.empty());
  CHECK(std::abs(out.t - 1) <= 1e-6);
}

TEST_CASE("generic: extrapolation takes any interval and refuses bad arguments") {
  const Oscillator<double> f;
  for (const double t1 : {0.1, 1.0 / 3, 1e-300, 1e-17, -0.7}) {
    auto y = f.initial();
    const auto out = integrate_extrapolation(f, y, 0.0, t1, {1, 1}, 1e-13, many);
    CHECK(out.ok);
    CHECK(out.t == t1);
    CHECK(std::abs(y[0] - std::cos(t1)) + std::abs(y[1] + std::sin(t1)) <= 1e-14);
  }
  auto y = f.initial();
  const auto none = integrate_extrapolation(f, y, 3.0, 3.0, {1, 1}, 1e-13, many);
  CHECK(none.ok);
  CHECK(none.evaluations == 0);
  CHECK(y == f.initial());

  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(integrate_extrapolation(f, y, 0.0, nan, {1, 1}, 1e-13, many).status == Status::invalid_argument);
  CHECK(integrate_extrapolation(f, y, 0.0, 1.0, {1}, 1e-13, many).status == Status::invalid_argument);
  CHECK(integrate_extrapolation(f, y, 0.0, 1.0, {1, 0}, 1e-13, many).status == Status::invalid_argument);
  CHECK(integrate_extrapolation(f, y, 0.0, 1.0, {1, 1}, 0.0, many).status == Status::invalid_argument);
  CHECK(integrate_extrapolation(f, y, 0.0, 1.0, {1, 1}, 1e-13, many, nan).status == Status::invalid_argument);
  y[0] = nan;
  CHECK(integrate_extrapolation(f, y, 0.0, 1.0, {1, 1}, 1e-13, many).status == Status::invalid_argument);
}
