// Order in time, against certified solutions on the same mesh.
#include <cmath>

#include "src/reference_states.hpp"
#include "tests/planar_beam/beams.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

std::array<double, 4> errors(std::string_view scheme, const PlanarBeam<2>& model, double t_end, int steps,
                             const ReferenceStates& reference) {
  const RunResult result = run_beam(scheme, model, t_end, t_end / steps);
  REQUIRE(result.status == Status::ok);
  return model.distance(model.restore(result.state), model.restore(reference.states[0]));
}

/// All schemes have their declared order in all four classes of error between two steps; those of higher
/// order take a quarter as many.
void check_orders(const PlanarBeam<2>& model, double t_end, int steps) {
  const auto any = box(model);
  const ReferenceStates reference = any->reference({t_end});
  INFO(reference.message);
  REQUIRE(reference.kind == "certified");
  int checked = 0;
  for (const SchemeInfo& scheme : beam_schemes()) {
    const auto order = scheme.order_for(model.load_class());
    if (!order) continue;
    const int count = *order > 2.0 ? steps / 4 : steps;
    const auto coarse = errors(scheme.name, model, t_end, count, reference),
               fine = errors(scheme.name, model, t_end, 2 * count, reference);
    for (std::size_t k = 0; k < 4; ++k) {
      INFO(scheme.name << ", " << model.metrics[k].name << ": " << coarse[k] << " " << fine[k]);
      CHECK(fine[k] >= 100.0 * reference.bounds[0][k]);
      // The highest modes are barely resolved by an explicit step.
      const double tolerance = scheme.name == "beam-rk4" ? 0.15 : 0.1;
      CHECK(std::abs(std::log2(coarse[k] / fine[k]) - *order) <= tolerance);
    }
    ++checked;
  }
  CHECK(checked == 11);
}

}  // namespace

TEST_CASE("beam schemes: declared orders of a clamped beam under constant loads", "[planar_beam]") {
  check_orders(PlanarBeam<2>(soft_beam(4)), 1.0, 1280);
}

TEST_CASE("beam schemes: declared orders of a curved beam in free flight", "[planar_beam]") {
  Data data = soft_beam(4);
  data.loads.clear();
  data.gravity = 0.0;
  data.supports[0] = {};
  data.curvature = 1.5;
  data.velocity = {0.5, 0.2};
  data.angular_velocity = 2.0;
  check_orders(PlanarBeam<2>(data), 1.0, 640);
}

TEST_CASE("beam schemes: declared orders past a jump of the load", "[planar_beam]") {
  Data data = soft_beam(4);
  data.loads[0].profile = planar_beam::Profile::step;
  data.loads[0].duration = 0.5;
  check_orders(PlanarBeam<2>(data), 1.0, 1280);
}
