// The limit of steps is kept to the step, also where the driver calls the solver more than once on the way.

#include "tests/catch.hpp"
#include "tests/sundials/systems.hpp"

using namespace gnomon;
using namespace gnomon::test;

TEST_CASE("sundials: the limit of steps is exact", "[sundials]") {
  // A linear oscillator that needs far more steps.
  TestOde oscillator;
  oscillator.initial = {1.0, 0.0};
  oscillator.f = [](double, const double* y, double* rate) { rate[0] = y[1], rate[1] = -y[0]; };
  oscillator.df = [](double, const double*, double* dense) { dense[1] = -1.0, dense[2] = 1.0; };
  RunSpec spec = tolerance(1e4, 1e-10);
  for (long limit : {1L, 19'999L, 20'001L, 25'000L}) {
    spec.max_steps = limit;
    for (bool record : {true, false}) {
      spec.record = record;
      const auto check = [&](std::string_view name, const RunResult& result) {
        INFO(name << (record ? ", recorded" : "") << ", limit " << limit);
        CHECK(result.status == Status::step_limit);
        CHECK(!result.message.empty());
        CHECK(result.cost.steps == limit);
      };
      for (const OdeSolver& solver : {ode_solvers[0], ode_solvers[2]})
        check(solver.name, run_ode(solver, oscillator, spec));
      check("ida-bdf", run_dae(as_dae(oscillator), spec));
    }
  }
}
