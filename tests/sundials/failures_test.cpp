// How solvers end that cannot go on: exceptions, values that are not finite,
// limits; always in silence.

#include <atomic>
#include <cmath>
#include <limits>

#include "tests/catch.hpp"
#include "tests/sundials/systems.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/silence.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

struct OwnError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A linear oscillator, (cos t, -sin t).
TestOde oscillator() {
  TestOde ode;
  ode.initial = {1.0, 0.0};
  ode.f = [](double, const double* y, double* rate) { rate[0] = y[1], rate[1] = -y[0]; };
  ode.df = [](double, const double*, double* dense) { dense[1] = -1.0, dense[2] = 1.0; };
  return ode;
}

// y' = y^2 from 1: infinite at t = 1.
TestOde explosion() {
  TestOde ode;
  ode.initial = {1.0};
  ode.f = [](double, const double* y, double* rate) { rate[0] = y[0] * y[0]; };
  ode.df = [](double, const double* y, double* dense) { dense[0] = 2.0 * y[0]; };
  return ode;
}

// A defect that shows itself in the n-th evaluation.
TestOde defective(long after, std::function<void(double* rate)> defect) {
  TestOde ode = oscillator();
  ode.f = [f = ode.f, calls = std::make_shared<long>(0), after, defect](double t, const double* y,
                                                                        double* rate) {
    f(t, y, rate);
    if (++*calls > after) defect(rate);
  };
  return ode;
}

void raise(double*) { throw OwnError("the equations of the test refuse"); }

/// Runs the system by every solver, ODE and DAE form, step by step and to the
/// end at once.
template <class MakeOde, class Check>
void with_every_solver(const MakeOde& make, const RunSpec& spec, const Check& check) {
  for (bool record : {true, false}) {
    RunSpec mine = spec;
    mine.record = record;
    for (const OdeSolver& solver : ode_solvers) {
      const TestOde system = make();
      INFO(solver.name << (record ? ", recorded" : ""));
      check([&] { return run_ode(solver, system, mine); });
    }
    const TestDae system = as_dae(make());
    INFO("ida-bdf" << (record ? ", recorded" : ""));
    check([&] { return run_dae(system, mine); });
  }
}

}  // namespace

TEST_CASE("sundials: exceptions pass through the solvers", "[sundials]") {
  const StderrCapture capture;
  // as_dae evaluates the rates once for its start.
  for (long after : {1, 2, 7, 60}) {
    with_every_solver([&] { return defective(after, raise); }, tolerance(10.0, 1e-9),
                      [&](const auto& run) {
                        INFO("after " << after << " calls");
                        try {
                          const RunResult result = run();
                          FAIL("ended with " << to_string(result.status));
                        } catch (const OwnError& error) {
                          CHECK(std::string(error.what()) == "the equations of the test refuse");
                        }
                      });
  }
  // The Jacobian's, too.
  for (const OdeSolver& solver : ode_solvers) {
    TestOde system = oscillator();
    system.df = [](double, const double*, double*) { throw OwnError("no Jacobian"); };
    INFO(solver.name);
    if (solver.implicit)
      CHECK_THROWS_AS(run_ode(solver, system, tolerance(10.0, 1e-6)), OwnError);
    else
      CHECK(run_ode(solver, system, tolerance(10.0, 1e-6)).status == Status::ok);
  }
  TestDae dae = as_dae(oscillator());
  dae.dF = [](double, double, const double*, double*) { throw OwnError("no Jacobian"); };
  CHECK_THROWS_AS(run_dae(dae, tolerance(10.0, 1e-6)), OwnError);
  // Something that is no std::exception.
  CHECK_THROWS_AS(run_ode(ode_solvers[0], defective(5, [](double*) { throw 17; }), tolerance(10.0, 1e-6)),
                  int);
  CHECK(capture.text() == "");
}

TEST_CASE("sundials: a solver goes on after an exception as if it had not been", "[sundials]") {
  // Each run has its own context: nothing of a failure is left behind.
  const TestOde system = oscillator();
  for (const OdeSolver& solver : ode_solvers) {
    const RunResult before = run_ode(solver, system, tolerance(1.0, 1e-8));
    CHECK_THROWS_AS(run_ode(solver, defective(9, raise), tolerance(1.0, 1e-8)), OwnError);
    CHECK(run_ode(solver, system, tolerance(1.0, 1e-8)).state == before.state);
  }
}

TEST_CASE("sundials: rates that are not finite end a run with a reason", "[sundials]") {
  const StderrCapture capture;
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (long after : {1, 40}) {
      with_every_solver([&] { return defective(after, [bad](double* rate) { rate[1] = bad; }); },
                        tolerance(10.0, 1e-9),
                        [&](const auto& run) {
                          const RunResult result = run();
                          INFO(to_string(result.status) << ": " << result.message);
                          CHECK(result.status == Status::solver_failed);
                          CHECK(!result.message.empty());
                          CHECK(result.message.find('\n') == std::string::npos);
                          CHECK(result.t < 1.0);
                          CHECK(all_finite(result.state));
                        });
    }
  }
  CHECK(capture.text() == "");
}

TEST_CASE("sundials: a value that is not finite once is avoided by a smaller step", "[sundials]") {
  // The rates exist for y >= 0 only, and the solution stays there; a step too far meets the root of a
  // negative number.
  const StderrCapture capture;
  int finished = 0;
  const auto refusals = std::make_shared<int>(0);
  const auto make = [refusals] {
    TestOde ode;
    ode.initial = {1.0};
    ode.f = [refusals](double t, const double* y, double* rate) {
      if (y[0] < 0.0) ++*refusals;
      rate[0] = -20.0 * (std::sqrt(y[0]) - (t < 10.0 ? 1.0 : 0.5));
    };
    ode.df = [](double, const double* y, double* dense) { dense[0] = -10.0 / std::sqrt(y[0]); };
    return ode;
  };
  with_every_solver(make, tolerance(20.0, 1e-4), [&](const auto& run) {
    const RunResult result = run();
    INFO(result.message);
    // ARKODE's explicit stepper takes no second try; then it has to say so.
    if (result.message.find("ARKODE") == 0) {
      CHECK(result.status == Status::solver_failed);
      CHECK(result.message.find("right-hand side failed") != std::string::npos);
    } else {
      REQUIRE(result.status == Status::ok);
      CHECK(std::abs(result.state[0] - 0.25) <= 1e-3);
      ++finished;
    }
  });
  CHECK(finished >= 8);  // CVODE, IDA and the implicit tables, recorded or not
  CHECK(*refusals >= 1);
  CHECK(capture.text() == "");
}

TEST_CASE("sundials: a solution that ends before t_end", "[sundials]") {
  const StderrCapture capture;
  RunSpec spec = tolerance(2.0, 1e-6);
  spec.max_steps = 20'000;
  with_every_solver(explosion, spec, [](const auto& run) {
    const RunResult result = run();
    INFO(to_string(result.status) << " at " << result.t << ": " << result.message);
    CHECK(result.status != Status::ok);
    CHECK(!result.message.empty());
    CHECK(result.t <= 1.01);
    CHECK(result.t >= 0.99);
    CHECK(all_finite(result.state));
  });
  CHECK(capture.text() == "");
}

TEST_CASE("sundials: limits end a run", "[sundials]") {
  const StderrCapture capture;
  RunSpec spec = tolerance(1000.0, 1e-9);
  spec.max_steps = 20;
  with_every_solver(oscillator, spec, [](const auto& run) {
    const RunResult result = run();
    INFO(result.message);
    CHECK(result.status == Status::step_limit);
    CHECK(!result.message.empty());
    CHECK(result.cost.steps == 20);
    CHECK(result.t > 0.0);
    CHECK(result.t < 1000.0);
    // The state is that of the time reached.
    CHECK(std::abs(result.state[0] - std::cos(result.t)) <= 1e-5);
  });
  // Enough is enough: the limit that a run does not exceed does not end it.
  for (const OdeSolver& solver : ode_solvers) {
    const TestOde system = oscillator();
    spec = tolerance(10.0, 1e-6);
    const long steps = run_ode(solver, system, spec).cost.steps;
    INFO(solver.name);
    spec.max_steps = steps;
    CHECK(run_ode(solver, system, spec).status == Status::ok);
    spec.max_steps = steps - 1;
    CHECK(run_ode(solver, system, spec).status == Status::step_limit);
  }
  spec = tolerance(1e9, 1e-6);
  spec.time_limit = 0.05;
  const std::atomic<bool> stop{true};
  for (const OdeSolver& solver : ode_solvers) {
    const TestOde system = oscillator();
    RunResult result = run_ode(solver, system, spec);
    CHECK(result.status == Status::time_limit);
    CHECK(!result.message.empty());
    CHECK(result.cost.steps > 20);
    RunSpec interrupted = spec;
    interrupted.stop = &stop;
    result = run_ode(solver, system, interrupted);
    CHECK(result.status == Status::interrupted);
    CHECK(result.cost.steps == 1);
  }
  CHECK(capture.text() == "");
}

TEST_CASE("sundials: what is written to standard error would be seen", "[sundials]") {
  const StderrCapture capture;
  std::fputs("seen\n", stderr);
  CHECK(capture.text() == "seen\n");
}
