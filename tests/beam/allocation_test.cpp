// What the inner loop of the beam schemes allocates.
#include <vector>

#include "integrators/beam/bathe.hpp"
#include "integrators/beam/energy_momentum_4.hpp"
#include "integrators/beam/generalized_alpha.hpp"
#include "integrators/beam/mixed_midpoint.hpp"
#include "integrators/beam/rk4.hpp"
#include "integrators/beam/stander_stein.hpp"
#include "integrators/beam/verlet.hpp"
#include "tests/planar_beam/beams.hpp"
#include "tests/support/allocations.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

template <class S, int p>
void check_steps(const PlanarBeam<p>& model, double h, long count) {
  auto state = S::start(model, model.initial());
  long n = 0;
  Status status = Status::unsupported;
  const long allocated =
      allocations_of([&] { status = detail::march<PlanarBeam<p>, S>(model, state, n, count, h); });
  CHECK(status == Status::ok);
  CHECK(n == count);
  CHECK(allocated == 0);
}

}  // namespace

TEST_CASE("beam schemes: steps allocate nothing", "[planar_beam][allocation]") {
  check_steps<beam::BeamMidpoint>(PlanarBeam<1>(flying_beam(10, 500.0)), 0.05, 100);
  check_steps<beam::BeamEnergyMomentum>(PlanarBeam<1>(soft_arm(4, 0.5)), 0.01, 100);
  const PlanarBeam<1> arm(soft_arm(4, 0.5));
  check_steps<beam::BeamStanderStein>(arm, 0.01, 100);
  check_steps<beam::BeamMixedMidpoint>(arm, 0.01, 100);
  check_steps<beam::BeamEnergyMomentum4>(arm, 0.01, 100);
  check_steps<beam::BeamTrapezoidal>(arm, 0.01, 100);
  check_steps<beam::BeamGeneralizedAlpha>(arm, 0.01, 100);
  check_steps<beam::BeamHht>(arm, 0.01, 100);
  check_steps<beam::BeamBathe>(arm, 0.01, 100);
  check_steps<beam::BeamVerlet>(arm, 0.01, 100);
  check_steps<beam::BeamVerletConsistent>(arm, 0.01, 100);
  check_steps<beam::BeamRk4>(arm, 0.01, 100);
  Data hinged = soft_beam(4);
  hinged.hinges = {{0.25, 0.4}, {0.5}};
  const PlanarBeam<1> linear(hinged);
  check_steps<beam::BeamEnergyMomentum>(PlanarBeam<2>(hinged), 0.01, 100);
  check_steps<beam::BeamMidpoint>(linear, 0.01, 100);
  check_steps<beam::BeamTrapezoidal>(linear, 0.01, 100);
  check_steps<beam::BeamVerlet>(linear, 0.01, 100);
  check_steps<beam::BeamVerletConsistent>(linear, 0.01, 100);
  // Large steps, too, which need line search and continuation.
  check_steps<beam::BeamEnergyMomentum>(PlanarBeam<3>(flying_beam(10, 100.0)), 0.5, 20);
}

TEST_CASE("planar beam: rates and invariants allocate nothing", "[planar_beam][allocation]") {
  Data hinged = soft_arm(4, 0.5);
  hinged.hinges = {{0.5, 1.0}};
  for (const Data& data : {soft_arm(4, 0.5), hinged}) {
    const PlanarBeam<1> model(data);
    const auto ode = model.ode();
    std::vector<double> y(static_cast<std::size_t>(ode.size())), rate(y.size());
    const auto state = model.initial();
    ode.pack(0.0, state, y.data());
    ode.rhs(0.0, y.data(), rate.data());
    double found[4];
    CHECK(allocations_of([&] {
            ode.rhs(0.0, y.data(), rate.data());
            model.invariants(0.0, state, found);
          }) == 0);
  }
}
