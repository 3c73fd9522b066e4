// Published digits of other people's programs.
#include <cmath>

#include "tests/planar_beam/beams.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

/// Tip displacement (x, z) and rotation after two steps of 0.1 s.
Eigen::Vector3d after_two_steps(const char* scheme, const PlanarBeam<1>& model) {
  const RunResult result = run_beam(scheme, model, 0.2, 0.1);
  REQUIRE(result.status == Status::ok);
  CHECK(result.cost.steps == 2);
  return model.restore(result.state).u.tail<3>();
}

bool has_published_digits(const Eigen::Vector3d& tip) {
  return std::abs(tip[0] + 0.093072) <= 5e-7 && std::abs(tip[1] - 0.29187) <= 5e-6 &&
         std::abs(std::abs(tip[2]) - 0.74402) <= 5e-6;
}

}  // namespace

TEST_CASE("beam schemes: Stander's and Stein's two steps of a cantilever", "[planar_beam]") {
  const Scene scene = load_scene(beam_catalogue(), "cantilever-two-big-steps");
  const auto& model = typed<PlanarBeam<1>>(scene);
  const Eigen::Vector3d tip = after_two_steps("beam-stander-stein", model);
  INFO(tip.transpose());
  CHECK(has_published_digits(tip));
  for (const char* other :
       {"beam-midpoint", "beam-energy-momentum", "beam-mixed-midpoint", "beam-trapezoidal"})
    CHECK_FALSE(has_published_digits(after_two_steps(other, model)));
  // The digits tell a shear factor of 5/6 from 6/7, and the weight from none.
  Data shear = model.data(), weightless = model.data();
  shear.section.GA *= 35.0 / 36.0;
  weightless.gravity = 0.0;
  CHECK_FALSE(has_published_digits(after_two_steps("beam-stander-stein", PlanarBeam<1>(shear))));
  CHECK_FALSE(has_published_digits(after_two_steps("beam-stander-stein", PlanarBeam<1>(weightless))));
}
