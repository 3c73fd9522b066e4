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
