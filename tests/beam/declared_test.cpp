// What each scheme declares to keep it keeps, and no more.
#include <cmath>

#include "integrators/beam/bathe.hpp"
#include "integrators/beam/energy_momentum_4.hpp"
#include "integrators/beam/generalized_alpha.hpp"
#include "integrators/beam/mixed_midpoint.hpp"
#include "integrators/beam/rk4.hpp"
#include "integrators/beam/stander_stein.hpp"
#include "integrators/beam/stepper_steps.hpp"
#include "integrators/beam/verlet.hpp"
#include "tests/planar_beam/beams.hpp"

// Copies of the energy-momentum scheme's point, the last two with a defect.
namespace gnomon::test {
inline constexpr beam::Turning unplanted{100}, strain_off{101}, sign_of_factor{102};
}
namespace gnomon::beam {

template <>
struct PointStep<test::unplanted> : PointStep<Turning::cayley> {
  using PointStep<Turning::cayley>::PointStep;
};

/// The axial strain at the end of the step has the weight (1 + 1e-6)/2.
template <>
struct PointStep<test::strain_off> : PointStep<Turning::cayley> {
  PointStep() = default;
  PointStep(const PointHistory& now, double e1, double e2, const CrossSection& section, double h, double w1,
            double w2, double slope3, double omega)
      : PointStep<Turning::cayley>(now, e1, e2, section, h, w1, w2, slope3, omega) {
    n1 += 0.5e-6 * section.EA * (next.g1 + e1);
  }
};

/// 1/sqrt(1 - z^2) in place of cos a = 1/sqrt(1 + z^2) in the forces.
template <>
struct PointStep<test::sign_of_factor> : PointStep<Turning::cayley> {
  PointStep() = default;
  PointStep(const PointHistory& now, double e1, double e2, const CrossSection& section, double h, double w1,
            double w2, double slope3, double omega)
      : PointStep<Turning::cayley>(now, e1, e2, section, h, w1, w2, slope3, omega) {
    const double z = 0.5 * h * omega;
    factor = 1.0 / std::sqrt(1.0 - z * z);
  }
};

}  // namespace gnomon::beam

namespace gnomon::test {

template <beam::Turning turning>
struct PlantedBeam : beam::MidpointStep<turning> {
  static constexpr SchemeInfo info = beam::BeamEnergyMomentum::info;
};

}  // namespace gnomon::test

using namespace gnomon;
using namespace gnomon::test;

namespace {

/// Whether energy and momenta of a free beam are kept as declared, to rounding or, where they are not, by
/// far.
bool kept_as_declared(const SchemeInfo& scheme, const Drifts& d) {
  return d.linear <= 1e-12 && (scheme.conserves_energy ? d.energy <= 1e-11 : d.energy >= 1e-7) &&
         (scheme.conserves_momentum ? d.angular <= 1e-11 : d.angular >= 1e-8);
}

/// Relative distance of u and v from the start after a step and the same step back, of a beam in motion.
template <class S>
void check_reversible() {
  const PlanarBeam<1> model(spinning_beam(4, true));
  const double h = 0.005;
  auto state = S::start(model, model.initial());
  for (int n = 0; n < 200; ++n) REQUIRE(S::step(model, state, n * h, h) == Status::ok);
  const planar_beam::State before = S::view(model, state);
  REQUIRE(S::step(model, state, 200 * h, h) == Status::ok);
  const double moved = (S::view(model, state).v - before.v).norm();
  REQUIRE(S::step(model, state, 201 * h, -h) == Status::ok);
  const double left = (S::view(model, state).v - before.v).norm();
  INFO(S::info.name << ": " << moved << " " << left);
  CHECK(moved >= 1e-4);
  CHECK((left <= 1e-9 * moved) == S::info.reversible);
  CHECK((left >= 1e-6 * moved) == !S::info.reversible);
}

}  // namespace

TEST_CASE("beam schemes: energy and momenta of a free beam are kept as declared", "[planar_beam]") {
  // The flying spaghetti, which bends far; steps that explicit schemes can take.
  const PlanarBeam<1> model(flying_beam(10, 100.0));
  int exact = 0;
  for (const SchemeInfo& scheme : beam_schemes()) {
    const Drifts d = drifts(scheme.name, model, 7.5, 0.005);
    INFO(scheme.name << ": " << d.energy << " " << d.linear << " " << d.angular);
    CHECK(kept_as_declared(scheme, d));
    exact += scheme.conserves_energy && scheme.conserves_momentum ? 1 : 0;
  }
  CHECK(exact == 3);
}

TEST_CASE("beam schemes: planted defects of the energy-momentum scheme are seen in what it keeps",
          "[planar_beam]") {
  const PlanarBeam<1> model(flying_beam(10, 100.0));
  RunSpec spec;
  spec.t_end = 7.5;
  spec.step = 0.005;
  const auto check = [&](const char* name, const Drifts& d, bool right) {
    INFO(name << ": " << d.energy << " " << d.linear << " " << d.angular);
    CHECK(kept_as_declared(beam::BeamEnergyMomentum::info, d) == right);
    return d;
  };
  const Drifts copy =
      check("copy", drifts_of(model, run<PlanarBeam<1>, PlantedBeam<unplanted>>(model, spec)), true);
  const Drifts off =
      check("strain off", drifts_of(model, run<PlanarBeam<1>, PlantedBeam<strain_off>>(model, spec)), false);
  const Drifts sign =
      check("sign", drifts_of(model, run<PlanarBeam<1>, PlantedBeam<sign_of_factor>>(model, spec)), false);
  // Defects of this size leave no other trace.
  CHECK(copy.energy < off.energy);
  CHECK(off.energy <= 1e-5);
  CHECK(sign.energy <= 1e-2);
}

TEST_CASE("beam schemes: a step back undoes a step as declared", "[planar_beam]") {
  check_reversible<beam::BeamMidpoint>();
  check_reversible<beam::BeamEnergyMomentum>();
  check_reversible<beam::BeamStanderStein>();
  check_reversible<beam::BeamMixedMidpoint>();
  check_reversible<beam::BeamEnergyMomentum4>();
  check_reversible<beam::BeamTrapezoidal>();
  check_reversible<beam::BeamGeneralizedAlpha>();
  check_reversible<beam::BeamHht>();
  check_reversible<beam::BeamBathe>();
  check_reversible<beam::BeamVerlet>();
  check_reversible<beam::BeamVerletConsistent>();
  check_reversible<beam::BeamRk4>();
}

TEST_CASE("beam schemes: large steps of the free flight", "[planar_beam]") {
  const Scene scene = load_scene(beam_catalogue(), "free-flight");
  const auto& model = typed<PlanarBeam<1>>(scene);
  // The trapezoidal rule loses the energy, then Newton's iteration has no solution to find.
  CHECK(drifts("beam-trapezoidal", model, 100.0, 0.05).energy <= 1e-2);
  CHECK(drifts("beam-trapezoidal", model, 100.0, 0.25).energy >= 0.1);
  const RunResult ended = run_beam("beam-trapezoidal", model, 100.0, 0.5);
  CHECK(ended.status == Status::newton_failed);
  CHECK(ended.message.find("Newton's iteration did not converge") == 0);
  for (double h : {0.25, 0.5}) {
    for (const char* scheme : {"beam-energy-momentum", "beam-mixed-midpoint", "beam-energy-momentum-4"}) {
      const Drifts d = drifts(scheme, model, 100.0, h);
      INFO(scheme << ", h " << h << ": " << d.energy << " " << d.angular);
      CHECK(d.energy <= 1e-10);
      CHECK(d.angular <= 1e-10);
    }
    const Drifts d = drifts("beam-stander-stein", model, 100.0, h);
    CHECK(d.energy <= 1e-10);
    CHECK(d.angular >= 1e-5);
  }
}
