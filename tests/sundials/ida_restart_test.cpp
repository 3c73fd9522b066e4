// At a break IDA has to start anew from consistent values: the rates, and the algebraic variables, are those
// behind the break. With the old ones every first step fails the error test where an algebraic variable
// jumps, however small the step, and where a rate jumps by 1e9 times its scale.

#include <cmath>

#include "tests/catch.hpp"
#include "tests/sundials/systems.hpp"

using namespace gnomon;
using namespace gnomon::test;

TEST_CASE("sundials: IDA starts anew where an algebraic variable jumps", "[sundials]") {
  // y' = z - y, 0 = z - g(t), g = 1/2 before t = 1 and 1/2 + jump after; y(0) = 1.
  for (double jump : {1e-3, 1.0, 1e3}) {
    TestDae system;
    system.initial = {1.0, 0.5};
    system.go_on = [jump](double t, double* y, double* rate) {
      y[1] = t < 1.0 ? 0.5 : 0.5 + jump;
      rate[0] = y[1] - y[0];
    };
    system.is_algebraic = {0, 1};
    system.break_times = {1.0};
    system.F = [jump](double t, const double* y, const double* rate, double* value) {
      value[0] = rate[0] + y[0] - y[1];
      value[1] = y[1] - (t < 1.0 ? 0.5 : 0.5 + jump);
    };
    system.dF = [](double, double cj, const double*, double* dense) {
      dense[0] = cj + 1.0, dense[2] = -1.0, dense[3] = 1.0;
    };
    const RunResult result = run_dae(system, tolerance(5.0, 1e-8));
    INFO("jump " << jump << ": " << result.message);
    CHECK(result.status == Status::ok);
    const double exact = 0.5 + 0.5 * std::exp(-5.0) + jump * (1.0 - std::exp(-4.0));
    CHECK(std::abs(result.state[0] - exact) <= 1e-5 * (1.0 + jump));
  }
}

TEST_CASE("sundials: IDA goes on with values that jump themselves", "[sundials]") {
  // A ball that falls with unit acceleration from rest at height 1/2 and is hit at t = 0 and t = 1: y' = v,
  // v' = -1, v grows by `hit` each time, 0 = p - 2 v. What is seen at 0 is the state before the hit.
  for (double hit : {0.0, 3.0}) {
    TestDae system;
    system.initial = {0.5, 0.0, 0.0};
    system.is_algebraic = {0, 0, 1};
    system.break_times = {1.0};
    system.F = [](double, const double* y, const double* rate, double* value) {
      value[0] = rate[0] - y[1];
      value[1] = rate[1] + 1.0;
      value[2] = y[2] - 2.0 * y[1];
    };
    system.dF = [](double, double cj, const double*, double* dense) {
      dense[0] = dense[4] = cj, dense[3] = -1.0, dense[5] = -2.0, dense[8] = 1.0;
    };
    system.go_on = [hit](double, double* y, double* rate) {
      y[1] += hit;
      y[2] = 2.0 * y[1];
      rate[0] = y[1], rate[1] = -1.0, rate[2] = -2.0;
    };
    RunSpec spec = tolerance(2.0, 1e-8);
    spec.samples = 2;
    const RunResult result = run_dae(system, spec);
    INFO(result.message);
    REQUIRE(result.status == Status::ok);
    CHECK(result.samples[0] == system.initial);
    const std::vector<double> left{0.5 + hit - 0.5, hit - 1.0, 2.0 * hit - 2.0};
    const std::vector<double> end{0.5 + 3.0 * hit - 2.0, 2.0 * hit - 2.0, 4.0 * hit - 4.0};
    for (int k = 0; k < 3; ++k) {
      CHECK(std::abs(result.samples[1][k] - left[k]) <= 1e-6);
      CHECK(std::abs(result.state[k] - end[k]) <= 1e-6);
    }
  }
}

TEST_CASE("sundials: IDA starts anew where a rate jumps far", "[sundials]") {
  // y'' = g - y from (1, 0), g = 0 before t = 1 and `size` after.
  const double size = 1e9;
  TestOde ode;
  ode.initial = {1.0, 0.0};
  ode.break_times = {1.0};
  ode.f = [size](double t, const double* y, double* rate) {
    rate[0] = y[1];
    rate[1] = (t < 1.0 ? 0.0 : size) - y[0];
  };
  ode.df = [](double, const double*, double* dense) { dense[1] = -1.0, dense[2] = 1.0; };
  const RunResult other = run_ode(ode_solvers[1], ode, tolerance(5.0, 1e-8));
  CHECK(other.status == Status::ok);
  const RunResult result = run_dae(as_dae(ode), tolerance(5.0, 1e-8));
  INFO(result.message);
  CHECK(result.status == Status::ok);
  CHECK(std::abs(result.state[0] / size - (1.0 - std::cos(4.0))) <= 1e-5);
}
