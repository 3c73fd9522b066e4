#include "src/measure/drift.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/measure/drift_scaling.hpp"
#include "tests/catch.hpp"

using gnomon::allow_newton_residue;
using gnomon::Drift;
using gnomon::DriftVerdict;
using gnomon::jittered_times;
using gnomon::measure_drift;
using gnomon::rounding_level;
using gnomon::why_undecided;

namespace {

constexpr double span = 1000.0;
const double not_a_number = std::numeric_limits<double>::quiet_NaN();

template <class Function>
Drift drift_of(Function error, int samples = 2000, double rounding = rounding_level(0.0)) {
  const std::vector<double> times = jittered_times(0.0, span, samples, 7);
  std::vector<double> errors;
  for (const double t : times) errors.push_back(error(t));
  return measure_drift(times, errors, 0.0, rounding);
}

template <class Function>
std::string verdict_of(Function error, int samples = 2000) {
  return std::string(to_string(drift_of(error, samples).verdict));
}

// x <- memory x + step * normal, ten times between two samples, and a line that ends at `trend`. A random
// walk with memory 1.
Drift drift_of_walk(double step, double trend, unsigned seed, double memory = 1.0,
                    double rounding = rounding_level(0.0)) {
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const std::vector<double> times = jittered_times(0.0, span, 1000, seed);
  std::vector<double> errors;
  double walk = 0.0;
  for (const double t : times) {
    for (int k = 0; k < 10; ++k) {
      double normal = -6.0;
      for (int i = 0; i < 12; ++i) normal += uniform();
      walk = memory * walk + step * normal;
    }
    errors.push_back(walk + trend * t / span);
  }
  return measure_drift(times, errors, 0.0, rounding);
}

struct Pendulum {
  double q = 2.0;
  double p = 0.0;
  double energy() const { return 0.5 * p * p - std::cos(q); }
};

void verlet_step(Pendulum& x, double h) {
  x.p -= 0.5 * h * std::sin(x.q);
  x.q += h * x.p;
  x.p -= 0.5 * h * std::sin(x.q);
}

void rk4_step(Pendulum& x, double h) {
  const auto shifted = [&](double dq, double dp) { return Pendulum{x.q + dq, x.p + dp}; };
  const Pendulum a = x;
  const Pendulum b = shifted(0.5 * h * a.p, -0.5 * h * std::sin(a.q));
  const Pendulum c = shifted(0.5 * h * b.p, -0.5 * h * std::sin(b.q));
  const Pendulum d = shifted(h * c.p, -h * std::sin(c.q));
  x.q += h / 6.0 * (a.p + 2.0 * b.p + 2.0 * c.p + d.p);
  x.p -= h / 6.0 * (std::sin(a.q) + 2.0 * std::sin(b.q) + 2.0 * std::sin(c.q) + std::sin(d.q));
}

// Energy error of the pendulum, at the steps that follow the jittered times.
template <class Step>
Drift pendulum_drift(Step step, double h, double t_end) {
  Pendulum x;
  const double initial = x.energy();
  std::vector<double> times, errors;
  long n = 0;
  for (const double wanted : jittered_times(0.0, t_end, 2000, 11)) {
    for (; static_cast<double>(n) * h < wanted; ++n) step(x, h);
    times.push_back(static_cast<double>(n) * h);
    errors.push_back(x.energy() - initial);
  }
  return measure_drift(times, errors, 0.0);
}

}  // namespace

TEST_CASE("measure: a bounded oscillation has its amplitude, no slope and no growth") {
  const Drift drift = drift_of([](double t) { return 1e-3 * std::sin(t); });
  CHECK(drift.verdict == DriftVerdict::bounded);
  CHECK(std::abs(drift.max_abs - 1e-3) <= 1e-8);
  CHECK(std::abs(drift.oscillation - 1e-3) <= 2e-6);
  CHECK(std::abs(drift.slope) <= 3.0 * drift.slope_error);
  CHECK(drift.slope_error <= 1e-7);
  CHECK(std::abs(drift.growth) <= 0.01);
}

TEST_CASE("measure: offsets and slopes small against the oscillation are bounded") {
  CHECK(verdict_of([](double t) { return 1e-3 * (1.0 - std::cos(t)); }) == "bounded");
  CHECK(verdict_of([](double t) { return 1e-3 * (1.0 - std::cos(t) + 0.5 * t / span); }) == "bounded");
  CHECK(verdict_of([](double t) { return 1e-3 * std::sin(0.05 * t); }) == "bounded");
  CHECK(verdict_of([](double) { return 0.01; }) == "bounded");
  CHECK(verdict_of([](double t) { return t < 600.0 ? 0.0625 : std::nextafter(0.0625, 2.0); }) == "bounded");
  // A trend of rounding size.
  CHECK(verdict_of([](double t) { return 0.0625 + 1e-14 * t / span; }) == "bounded");
}

TEST_CASE("measure: forty samples are enough for most oscillations") {
  int bounded = 0;
  for (int k = 0; k < 200; ++k) {
    const double frequency = 0.05 * std::pow(10.0, k / 100.0);
    bounded += drift_of([&](double t) { return 1e-3 * std::sin(frequency * t + k); }, 40).verdict ==
               DriftVerdict::bounded;
  }
  INFO("bounded " << bounded);
  CHECK(bounded >= 190);
}

TEST_CASE("measure: a straight line is secular, with its slope") {
  const Drift drift = drift_of([](double t) { return -1e-6 * t; });
  CHECK(drift.verdict == DriftVerdict::secular);
  CHECK(std::abs(drift.slope + 1e-6) <= 1e-15);
  CHECK(std::abs(drift.growth - 1.0) <= 0.01);
  CHECK(drift.max_abs == 1e-6 * span);
  CHECK(drift.oscillation <= 1e-15);
  CHECK(verdict_of([](double t) { return 1e-12 * t / span; }) == "secular");
}

TEST_CASE("measure: a line buried under an oscillation is secular once it exceeds it") {
  const auto buried = [](double amplitude, double change) {
    return [=](double t) { return amplitude * std::sin(3.0 * t) + change * t / span; };
  };
  const Drift drift = drift_of(buried(1e-3, 3e-3));
  CHECK(drift.verdict == DriftVerdict::secular);
  CHECK(std::abs(drift.slope - 3e-6) <= 3.0 * drift.slope_error);
  CHECK(drift.slope_error <= 1e-7);
  CHECK(std::abs(drift.oscillation - 1e-3) <= 1e-5);
  CHECK(verdict_of(buried(1e-3, 1.2e-3)) == "secular");
  CHECK(verdict_of(buried(1e-3, 0.1e-3)) == "bounded");
  CHECK(verdict_of(buried(1e-11, 5e-11)) == "secular");
  CHECK(verdict_of([](double t) { return 1e-3 * (1.0 - std::cos(t) - 1.5 * t / span); }) == "secular");
}

TEST_CASE("measure: faster than linear growth is secular") {
  CHECK(verdict_of([](double t) { return 1e-6 * std::exp(10.0 * t / span); }) == "secular");
  CHECK(verdict_of([](double t) { return 1e-12 * std::exp(30.0 * t / span); }) == "secular");
  CHECK(verdict_of([](double t) { return 1e-16 * std::exp(14.0 * t / span); }) == "secular");
  CHECK(verdict_of([](double t) { return 1e200 * std::pow(t / span, 40.0); }) == "secular");
  CHECK(std::abs(drift_of([](double t) { return 1e-3 * t * t; }).growth - 2.0) <= 0.02);
}

TEST_CASE("measure: a transient that dies away is bounded, one that goes on is not") {
  CHECK(verdict_of([](double t) { return 0.01 * std::exp(-10.0 * t / span); }) == "bounded");
  CHECK(verdict_of([](double t) { return 0.01 * std::exp(-3.0 * t / span); }) == "bounded");
  CHECK(verdict_of([](double t) { return 0.01 * std::exp(-10.0 * t / span) + 1e-3 * std::sin(t); }) ==
        "bounded");
  CHECK(verdict_of([](double t) { return 0.01 * (1.0 - t / span); }) == "secular");
  CHECK(verdict_of([](double t) { return 0.01 * std::min(t / span, 0.5); }) == "secular");  // rests far away
}

TEST_CASE("measure: a random walk of rounding errors is roundoff, with a real trend it is secular") {
  int roundoff = 0, secular = 0, too_large = 0;
  double growth = 0.0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    // As many roundings of u as make this walk of ten thousand steps.
    const double level = rounding_level(1e4 * std::pow(1e-14 / std::numeric_limits<double>::epsilon(), 2));
    const Drift walk = drift_of_walk(1e-14, 0.0, seed, 1.0, level);
    roundoff += walk.verdict == DriftVerdict::roundoff;
    growth += walk.growth / 200.0;
    // Ten times the walk.
    secular += drift_of_walk(1e-14, 1e-11, seed, 1.0, level).verdict == DriftVerdict::secular;
    // Of fewer evaluations it is no rounding.
    too_large += drift_of_walk(1e-14, 0.0, seed).verdict != DriftVerdict::roundoff;
  }
  INFO("roundoff " << roundoff << " growth " << growth);
  CHECK(roundoff >= 190);
  CHECK(std::abs(growth - 0.5) <= 0.1);
  CHECK(secular == 200);
  CHECK(too_large == 200);
  // Far below the level of rounding nothing else is possible.
  for (unsigned seed = 1; seed <= 20; ++seed)
    CHECK(drift_of_walk(1e-16, 0.0, seed).verdict == DriftVerdict::roundoff);
}

TEST_CASE("measure: the standard error of the slope is honest for correlated errors", "[long]") {
  const auto spread = [](double step, double memory) {  // of slope / error, 1 if the error is right
    double square = 0.0;
    for (unsigned seed = 1; seed <= 400; ++seed) {
      const Drift drift = drift_of_walk(step, 0.0, seed, memory);
      square += std::pow(drift.slope / drift.slope_error, 2) / 400.0;
    }
    return std::sqrt(square);
  };
  CHECK(std::abs(spread(1e-6, 0.0) - 1.0) <= 0.15);
  // A memory of one block: 1.8 if correlation is ignored.
  CHECK(std::abs(spread(1e-6, std::exp(-1.0 / 160.0)) - 1.0) <= 0.15);
  // A random walk: ten if correlation is ignored. Some walks are not recognised, except where all are
  // expected.
  CHECK(std::abs(spread(1e-6, 1.0) - 1.2) <= 0.3);
  CHECK(std::abs(spread(1e-14, 1.0) - 1.0) <= 0.15);
}

TEST_CASE("measure: no error at all is roundoff") {
  const Drift drift = drift_of([](double) { return 0.0; });
  CHECK(drift.verdict == DriftVerdict::roundoff);
  CHECK(drift.max_abs == 0.0);
  CHECK(drift.slope == 0.0);
  CHECK(drift.slope_error == 0.0);
  CHECK(drift.oscillation == 0.0);
  CHECK(std::abs(drift.growth) <= 1e-12);
  CHECK(verdict_of([](double t) { return 9e-14 * t / span; }) == "roundoff");
  CHECK(verdict_of([](double t) { return 1.1e-13 * t / span; }) == "secular");
}

TEST_CASE("measure: missing or non-finite errors mean a failed run") {
  CHECK(measure_drift({}, {}, 0.0).verdict == DriftVerdict::failed);
  const Drift drift = drift_of([](double t) { return t > 900.0 ? not_a_number : 1e-3 * std::sin(t); });
  CHECK(drift.verdict == DriftVerdict::failed);
  CHECK(std::isnan(drift.max_abs));
  CHECK(verdict_of([](double t) { return t > 999.0 ? INFINITY : 0.0; }) == "failed");
  const std::vector<double> one{1.0};
  CHECK_THROWS_AS(measure_drift(one, {}, 0.0), std::invalid_argument);
}

TEST_CASE("measure: too few samples or too slow an oscillation leave the question open") {
  CHECK(verdict_of([](double t) { return 1e-6 * t; }, 31) == "undecided");
  CHECK(verdict_of([](double t) { return 1e-6 * t; }, 32) == "secular");
  CHECK(verdict_of([](double) { return 1e-15; }, 1) == "roundoff");
  const Drift few = drift_of([](double t) { return 1e-6 * t; }, 5);
  CHECK(few.max_abs == 1e-6 * span);
  CHECK(std::isnan(few.slope));
  CHECK(std::isnan(few.growth));
  // One period in the whole run, and half of a saturation.
  CHECK(verdict_of([](double t) { return 1e-3 * (1.0 - std::cos(6.283185307 * t / span)); }) == "undecided");
  CHECK(verdict_of([](double t) { return 1e-3 * (1.0 - std::exp(-10.0 * t / span)); }) == "undecided");
}

TEST_CASE("measure: the order of the samples and the start of the clock do not matter") {
  const auto error = [](double t) { return 1e-3 * std::sin(t) + 1e-5 * t; };
  const std::vector<double> times = jittered_times(0.0, span, 500, 3);
  std::vector<double> errors, later, backward_times, backward_errors;
  for (const double t : times) {
    errors.push_back(error(t));
    later.push_back(t + 4096.0);
  }
  backward_times.assign(times.rbegin(), times.rend());
  backward_errors.assign(errors.rbegin(), errors.rend());
  const Drift drift = measure_drift(times, errors, 0.0);
  const Drift backward = measure_drift(backward_times, backward_errors, 0.0);
  const Drift shifted = measure_drift(later, errors, 4096.0);
  CHECK(backward.slope == drift.slope);
  CHECK(backward.growth == drift.growth);
  CHECK(std::abs(shifted.slope - drift.slope) <= 1e-12);
  CHECK(std::abs(shifted.growth - drift.growth) <= 1e-9);
}

TEST_CASE("measure: on the pendulum Verlet is bounded and RK4 secular") {
  const Drift verlet = pendulum_drift(verlet_step, 0.1, 2e4);
  CHECK(verlet.verdict == DriftVerdict::bounded);
  CHECK(verlet.max_abs >= 1e-3);
  CHECK(verlet.max_abs <= 1e-2);
  CHECK(std::abs(verlet.slope) * 2e4 <= 0.1 * verlet.oscillation);
  // Second order: half the step, a quarter of the oscillation.
  const Drift finer = pendulum_drift(verlet_step, 0.05, 2e4);
  CHECK(std::abs(verlet.oscillation / finer.oscillation - 4.0) <= 0.1);

  const Drift rk4 = pendulum_drift(rk4_step, 0.1, 2e4);
  CHECK(rk4.verdict == DriftVerdict::secular);
  CHECK(rk4.slope < 0.0);
  CHECK(std::abs(rk4.growth - 1.0) <= 0.05);
  // RK4 dissipates with h^5: half the step, 1/32 of the slope.
  const Drift finer_rk4 = pendulum_drift(rk4_step, 0.05, 2e4);
  CHECK(std::abs(rk4.slope / finer_rk4.slope - 32.0) <= 1.0);
}

TEST_CASE("measure: jittered times are stratified, reproducible and end at the end") {
  const auto times = jittered_times(2.0, 12.0, 100, 42);
  REQUIRE(times.size() == 100);
  double offsets = 0.0;
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double low = 2.0 + 0.1 * static_cast<double>(i);
    CHECK(times[i] >= low - 1e-12);
    CHECK(times[i] <= low + 0.1 + 1e-12);
    CHECK(times[i] < times[i + 1]);
    offsets += (times[i] - low) / 0.1 / 99.0;
  }
  CHECK(std::abs(offsets - 0.5) <= 0.15);
  CHECK(times.back() == 12.0);
  CHECK(times == jittered_times(2.0, 12.0, 100, 42));
  CHECK(times != jittered_times(2.0, 12.0, 100, 43));
  CHECK(jittered_times(0.0, 1.0, 1, 1) == std::vector<double>{1.0});
  CHECK(jittered_times(0.0, 1.0, 0, 1).empty());
  CHECK_THROWS_AS(jittered_times(1.0, 1.0, 5, 1), std::invalid_argument);
  CHECK_THROWS_AS(jittered_times(0.0, not_a_number, 5, 1), std::invalid_argument);
}

TEST_CASE("measure: energy lost and not regained is dissipated once the loss levels off") {
  CHECK(verdict_of([](double t) { return -0.9 * (1.0 - std::exp(-20.0 * t / span)); }) == "dissipated");
  CHECK(verdict_of([](double t) { return -0.9 * (1.0 - std::exp(-3.0 * t / span)); }) == "dissipated");
  CHECK(verdict_of([](double t) { return -0.2 * std::sqrt(t / span); }) == "secular");
  CHECK(verdict_of([](double t) { return -1e-6 * t; }) == "secular");
  // A ripple of a twentieth of the loss does not hide it, one of a fifth is no loss any more.
  const auto ripple = [](double size) {
    return [=](double t) {
      return -0.9 * (1.0 - std::exp(-20.0 * t / span)) * (1.0 + 0.5 * size * std::sin(t));
    };
  };
  CHECK(verdict_of(ripple(0.05)) == "dissipated");
  CHECK(verdict_of(ripple(0.2)) != "dissipated");
  CHECK(verdict_of(ripple(0.2)) != "secular");
  // A gain is not a loss, nor is what was off from the start, nor a random walk.
  CHECK(verdict_of([](double t) { return 0.9 * (1.0 - std::exp(-20.0 * t / span)); }) != "dissipated");
  CHECK(verdict_of([](double) { return -0.09; }) == "bounded");
  int lost = 0;
  for (unsigned seed = 1; seed <= 200; ++seed)
    lost += drift_of_walk(1e-6, 0.0, seed).verdict == DriftVerdict::dissipated;
  CHECK(lost <= 2);
}

TEST_CASE("measure: growth of a random walk alone is not secular") {
  int secular = 0, bounded = 0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    const DriftVerdict verdict = drift_of_walk(1e-6, 0.0, seed).verdict;
    secular += verdict == DriftVerdict::secular;
    bounded += verdict == DriftVerdict::bounded;
  }
  INFO("secular " << secular << " bounded " << bounded);
  CHECK(secular <= 20);
  CHECK(bounded <= 60);
  // A jump in the middle has alpha > 1 and no slope beyond its own error.
  const auto jump = [](double t) { return 2e-13 * (t > 0.6 * span ? 1.0 : 0.1) * std::sin(t); };
  CHECK(drift_of(jump).growth > 0.2);
  CHECK(drift_of(jump).verdict == DriftVerdict::undecided);
  CHECK(drift_of(jump, 2000, rounding_level(1e5)).verdict == DriftVerdict::roundoff);
}

TEST_CASE("measure: an error that returns to its line is bounded though its maximum creeps up") {
  // Correlated over a tenth of a block, with the extremes of 2000 samples.
  int bounded = 0, secular = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    const Drift drift = drift_of_walk(1e-6, 0.0, seed, std::exp(-1.0 / 16.0));
    bounded += drift.verdict == DriftVerdict::bounded;
    secular += drift.verdict == DriftVerdict::secular;
  }
  INFO("bounded " << bounded << " secular " << secular);
  CHECK(bounded >= 90);
  CHECK(secular <= 2);
}

TEST_CASE("measure: undecided drifts say why, others do not") {
  CHECK(why_undecided(drift_of([](double t) { return 1e-6 * t; }, 31)) == "fewer than 32 samples");
  const Drift slow = drift_of([](double t) { return 1e-3 * (1.0 - std::cos(6.283185307 * t / span)); });
  CHECK(why_undecided(slow).find("a longer run would tell") != std::string::npos);
  CHECK(why_undecided(drift_of([](double t) { return 1e-6 * t; })).empty());
  CHECK(why_undecided(drift_of([](double t) { return 1e-2 * std::sin(t); })).empty());
}

TEST_CASE("measure: what Newton's tolerance leaves is told from a drift, up to that tolerance") {
  const auto allowed = [](double size, double tol) {
    Drift drift = drift_of([=](double t) { return size * t / span; });
    allow_newton_residue(drift, tol);
    return drift.verdict;
  };
  CHECK(allowed(9e-11, 1e-10) == DriftVerdict::newton);
  CHECK(allowed(1.1e-10, 1e-10) == DriftVerdict::secular);
  CHECK(allowed(5e-14, 1e-10) == DriftVerdict::roundoff);
  Drift bounded = drift_of([](double t) { return 1e-11 * std::sin(t); });
  allow_newton_residue(bounded, 1e-10);
  CHECK(bounded.verdict == DriftVerdict::bounded);
}

TEST_CASE("measure: rounding grows like a random walk of the evaluations") {
  CHECK(rounding_level(0.0) == 1e-13);
  CHECK(rounding_level(1e4) == 1e-13);
  CHECK(std::abs(rounding_level(1e6) - 4.0 * 0x1p-52 * 1e3) <= 1e-27);
  CHECK(std::abs(rounding_level(4e8) / rounding_level(1e8) - 2.0) <= 1e-12);
  // A truncation error of 4e4 evaluations is none, whether it oscillates or not, nor one that a tolerance
  // made.
  const auto verdict = [](double size, double evaluations) {
    return drift_of([=](double t) { return size * std::sin(t); }, 2000, rounding_level(evaluations)).verdict;
  };
  CHECK(verdict(1.25e-12, 4e4) == DriftVerdict::bounded);
  CHECK(verdict(2.29e-11, 4e4) == DriftVerdict::bounded);
  CHECK(verdict(2.9e-10, 5e5) == DriftVerdict::bounded);
  CHECK(verdict(1.7e-13, 4e4) == DriftVerdict::roundoff);
  CHECK(verdict(1.9e-13, 4e4) == DriftVerdict::bounded);
}

TEST_CASE("measure: an energy that went as far as it can is saturated, one far away is not bounded") {
  const auto rises = [](double size, double rate) {
    return [=](double t) { return size * std::tanh(rate * t / span) * (1.0 + 0.05 * std::sin(t)); };
  };
  CHECK(verdict_of(rises(0.09, 10.0)) == "saturated");
  CHECK(verdict_of(rises(0.9, 10.0)) == "saturated");
  CHECK(verdict_of(rises(0.005, 10.0)) != "saturated");  // small against its scale
  CHECK(verdict_of(rises(0.09, 1e6)) == "bounded");      // there from the first sample on
  CHECK(verdict_of(rises(0.9, 1e6)) == "far off");
  CHECK(verdict_of([](double t) { return 0.3 * std::sin(t); }) == "far off");
  CHECK(verdict_of([](double t) { return 0.09 * std::sin(t); }) == "bounded");
  CHECK(verdict_of([](double) { return 30.0; }) == "far off");
  CHECK(verdict_of([](double) { return -0.9; }) == "far off");
  CHECK(verdict_of([](double t) { return 1e-4 * t; }) == "secular");
  // A slow oscillation comes back.
  CHECK(verdict_of([](double t) { return 0.05 * (1.0 - std::cos(12.0 * t / span)); }) != "saturated");
  CHECK(verdict_of([](double) { return 0.5; }, 5) == "far off");
}

TEST_CASE("measure: a second step tells biased rounding from truncation") {
  const auto runs = [](double coarse, double fine, double evaluations, bool iterates = false) {
    const auto line = [](double size) { return drift_of([=](double t) { return size * t / span; }); };
    std::vector<gnomon::DriftAtStep> list{{0.1, line(coarse), evaluations, iterates},
                                          {0.05, line(fine), 2.0 * evaluations, iterates}};
    gnomon::tell_rounding(list);
    return list[0].drift.verdict;
  };
  CHECK(runs(1e-11, 2e-11, 1e6) == DriftVerdict::roundoff);
  CHECK(runs(1e-11, 1e-11, 1e6) == DriftVerdict::roundoff);
  CHECK(runs(1e-11, 2.5e-12, 1e6) == DriftVerdict::secular);  // order 2
  CHECK(runs(1e-11, 5e-12, 1e6) == DriftVerdict::secular);    // order 1
  CHECK(runs(1e-11, 2e-11, 1e4) == DriftVerdict::secular);    // more than one rounding an evaluation
  CHECK(runs(1e-11, 2e-11, 1e6, true) == DriftVerdict::newton);
  CHECK(runs(1e-11, 2.5e-12, 1e6, true) == DriftVerdict::secular);
}
