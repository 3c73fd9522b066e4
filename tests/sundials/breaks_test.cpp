// Data that jump: solvers stop at a declared break, start anew there and see each side's own limit.

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/sundials/systems.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

// y' = g - y^2, y(0) = 1, g = 0 before t = 1 and c^2 after: 1/(1+t), then c tanh(c (t-1) + artanh(1/(2c))).
TestOde riccati(double c, bool declared) {
  TestOde ode;
  ode.initial = {1.0};
  ode.f = [c](double t, const double* y, double* rate) { rate[0] = (t < 1.0 ? 0.0 : c * c) - y[0] * y[0]; };
  ode.df = [](double, const double* y, double* dense) { dense[0] = -2.0 * y[0]; };
  if (declared) ode.break_times = {1.0};
  return ode;
}

double exact(double c, double t) {
  return t <= 1.0 ? 1.0 / (1.0 + t) : c * std::tanh(c * (t - 1.0) + std::atanh(0.5 / c));
}

struct Outcome {
  double error;  // relative to c, in units of the tolerance; the worst of three end times
  long steps = 0, rejected = 0;
  bool ok = true;
};

template <class Run>
Outcome over_the_break(double c, double tol, const Run& run) {
  Outcome outcome{0.0};
  for (double t_end : {1.05, 1.3, 2.0}) {
    RunSpec spec = tolerance(t_end, tol);
    spec.max_steps = 20'000;
    const RunResult result = run(spec);
    outcome.ok = outcome.ok && result.status == Status::ok;
    outcome.error = std::max(outcome.error, std::abs(result.state[0] - exact(c, t_end)) / c / tol);
    outcome.steps += result.cost.steps;
    outcome.rejected += result.cost.rejected;
  }
  return outcome;
}

}  // namespace

TEST_CASE("sundials: a declared break is solved to tolerance", "[sundials]") {
  double worst_undeclared = 0.0;
  for (double c : {2.0, 30.0}) {
    for (double tol : {1e-4, 1e-7, 1e-10}) {
      const auto compare = [&](std::string_view name, const auto& run) {
        const Outcome declared = over_the_break(c, tol, [&](const RunSpec& spec) { return run(true, spec); });
        const Outcome undeclared =
            over_the_break(c, tol, [&](const RunSpec& spec) { return run(false, spec); });
        INFO(name << ", c = " << c << ", tolerance " << tol << ": error / tolerance " << declared.error
                  << ", undeclared " << undeclared.error << "; rejected " << declared.rejected << " and "
                  << undeclared.rejected);
        CHECK(declared.ok);
        CHECK(declared.error <= 50.0);
        CHECK(declared.steps > 3);  // all of them are counted, those before the break too
        if (undeclared.ok) CHECK(declared.rejected < undeclared.rejected);
        worst_undeclared = std::max(worst_undeclared, undeclared.error);
      };
      for (const OdeSolver& solver : ode_solvers)
        compare(solver.name, [&](bool declared, const RunSpec& spec) {
          const TestOde system = riccati(c, declared);
          return run_ode(solver, system, spec);
        });
      compare("ida-bdf", [&](bool declared, const RunSpec& spec) {
        const TestDae system = as_dae(riccati(c, declared));
        return run_dae(system, spec);
      });
    }
  }
  // The problem is one: without the declaration some solver is far off.
  CHECK(worst_undeclared >= 1e3);
}

TEST_CASE("sundials: each side of a break is seen by itself", "[sundials]") {
  const auto check_times = [](const std::vector<double>& times, const RunResult& result,
                              double first_behind) {
    REQUIRE(result.status == Status::ok);
    REQUIRE(times.size() > 10);
    // Before the break no time at or behind it, then none before it; both sides are looked at close to it,
    // those of an explicit system at the break itself.
    const auto behind = std::find_if(times.begin(), times.end(), [](double t) { return t >= 1.0; });
    CHECK(behind != times.begin());
    CHECK(std::all_of(behind, times.end(), [](double t) { return t >= 1.0; }));
    CHECK(*behind <= first_behind);
    CHECK(*std::max_element(times.begin(), behind) > 0.999999);
    CHECK(*std::max_element(times.begin(), behind) < 1.0);
  };
  for (bool record : {true, false}) {
    RunSpec spec = tolerance(2.0, 1e-6);
    spec.record = record;
    for (const OdeSolver& solver : ode_solvers) {
      INFO(solver.name);
      std::vector<double> times;
      TestOde system = riccati(2.0, true);
      system.f = [f = system.f, &times](double t, const double* y, double* rate) {
        times.push_back(t);
        f(t, y, rate);
      };
      check_times(times, run_ode(solver, system, spec), 1.0);
    }
    INFO("ida-bdf");
    std::vector<double> times;
    TestDae system = as_dae(riccati(2.0, true));
    system.F = [F = system.F, &times](double t, const double* y, const double* rate, double* value) {
      times.push_back(t);
      F(t, y, rate, value);
    };
    check_times(times, run_dae(system, spec), 1.001);
  }
}

TEST_CASE("sundials: several breaks, and samples at them", "[sundials]") {
  // y' = 1, 2, 4, 8 on (0, 1), (1, 1.5), (1.5, 3), (3, 4).
  TestOde staircase;
  staircase.initial = {0.0};
  staircase.break_times = {1.0, 1.5, 3.0};
  staircase.f = [](double t, const double*, double* rate) {
    rate[0] = t < 1.0 ? 1.0 : t < 1.5 ? 2.0 : t < 3.0 ? 4.0 : 8.0;
  };
  RunSpec spec = tolerance(4.0, 1e-8);
  spec.samples = 4;
  const auto check = [&](const RunResult& result) {
    REQUIRE(result.status == Status::ok);
    REQUIRE(result.sample_times == std::vector<double>{0.0, 1.0, 2.0, 3.0, 4.0});
    const double values[] = {0.0, 1.0, 4.0, 8.0, 16.0};
    for (std::size_t k = 0; k < 5; ++k) CHECK(std::abs(result.samples[k][0] - values[k]) <= 1e-6);
  };
  for (const OdeSolver& solver : ode_solvers) {
    INFO(solver.name);
    check(run_ode(solver, staircase, spec));
  }
  INFO("ida-bdf");
  check(run_dae(as_dae(staircase), spec));
}
