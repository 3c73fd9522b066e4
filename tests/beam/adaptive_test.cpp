// The energy-momentum scheme with steps of its own choice.
#include <cmath>

#include "tests/planar_beam/beams.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

constexpr const char* adaptive = "beam-energy-momentum-adaptive";

template <int p>
RunResult run_adaptively(const PlanarBeam<p>& model, double t_end, double tol, int samples = 0) {
  RunSpec spec;
  spec.t_end = t_end;
  spec.tol = tol;
  spec.samples = samples;
  return run_beam(adaptive, model, spec);
}

}  // namespace

TEST_CASE("adaptive beam: the error follows the tolerance", "[planar_beam]") {
  for (const Data& data : {soft_beam(4), soft_arm(4, 0.5)}) {
    const PlanarBeam<2> model(data);
    const auto exact = model.restore(run_beam("beam-energy-momentum-4", model, 1.0, 1.0 / 1000).state);
    double errors[3];
    long steps[3];
    for (int k = 0; k < 3; ++k) {
      const RunResult result = run_adaptively(model, 1.0, std::pow(10.0, -4.0 - 1.5 * k));
      REQUIRE(result.status == Status::ok);
      CHECK(result.t == 1.0);
      errors[k] = model.distance(model.restore(result.state), exact)[0];
      steps[k] = result.cost.steps;
    }
    for (int k = 0; k < 2; ++k) {
      INFO(errors[k] << " " << errors[k + 1] << ", steps " << steps[k] << " " << steps[k + 1]);
      // The error in each step is of order 3, that at the end of order 2: 10^-1.5 gives 10^(1/2) and 10^-1.
      CHECK(std::abs(std::log10(errors[k] / errors[k + 1]) - 1.0) <= 0.3);
      CHECK(std::abs(std::log10(double(steps[k + 1]) / double(steps[k])) - 0.5) <= 0.15);
    }
  }
}

TEST_CASE("adaptive beam: energy and momenta are exact whatever the steps", "[planar_beam]") {
  const PlanarBeam<1> model(flying_beam(10, 100.0));
  const RunResult result = run_adaptively(model, 10.0, 1e-4);
  const Drifts d = drifts_of(model, result);
  INFO(d.energy << " " << d.linear << " " << d.angular << ", steps " << result.cost.steps << ", rejected "
                << result.cost.rejected);
  CHECK(d.energy <= 1e-11);
  CHECK(d.linear <= 1e-11);
  CHECK(d.angular <= 1e-11);
  CHECK(result.cost.rejected > 0);
  CHECK(result.cost.rejected < result.cost.steps);
  // A rejected step leaves nothing behind: the impulse of the load is exact.
  CHECK(std::abs(model.momenta(model.restore(result.state))[0] - 20.0) <= 1e-10);
}

TEST_CASE("adaptive beam: sample times and breaks are met exactly", "[planar_beam]") {
  const PlanarBeam<2> model(soft_arm(4, 0.5));
  const RunResult result = run_adaptively(model, 1.0, 1e-5, 7);
  REQUIRE(result.status == Status::ok);
  CHECK(result.flags.empty());
  REQUIRE(result.sample_times.size() == 8);
  for (int k = 0; k < 8; ++k) {
    CHECK(result.sample_times[k] == (k == 7 ? 1.0 : 1.0 * k / 7));
    const auto state = model.restore(result.samples[k]);
    CHECK(std::abs(state.u[2] - model.prescribed(2)->value(result.sample_times[k])) <= 1e-14);
  }
}

TEST_CASE("adaptive beam: limits end a run with a reason", "[planar_beam]") {
  const PlanarBeam<1> model(flying_beam(10, 100.0));
  RunSpec spec;
  spec.t_end = 10.0;
  spec.tol = 1e-8;
  spec.max_steps = 10;
  const RunResult result = run_beam(adaptive, model, spec);
  CHECK(result.status == Status::step_limit);
  CHECK(result.cost.steps == 10);
  CHECK_FALSE(result.message.empty());
}
