// Newton's iteration on beams that are far stiffer in stretch and shear than in bending.
#include <cmath>

#include "integrators/beam/energy_momentum_4.hpp"
#include "integrators/beam/midpoint.hpp"
#include "tests/catch.hpp"
#include "tests/planar_beam/beams.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

using LinearBeam = PlanarBeam<1>;

/// A cantilever that a half-sine force pushes across at its end for 1 s.
LinearBeam pushed(const planar_beam::CrossSection& section, int elements, double force) {
  Data data;
  data.section = section;
  data.length = 1.0;
  data.elements = elements;
  data.supports[0] = {true, true};
  data.loads.push_back({planar_beam::Place::end, {0.0, force}, 0.0, planar_beam::Profile::half_sine, 1.0});
  return LinearBeam(data);
}
LinearBeam stiff(double stiffness, double force) {
  return pushed({.EA = stiffness, .GA = stiffness, .EI = 1.0, .rhoA = 1.0, .rhoI = 0.01}, 4, force);
}
/// 1 m long, 20 mm wide, 0.5 mm thick.
LinearBeam steel_ruler() {
  constexpr double E = 2.1e11, G = 8.1e10, density = 7850.0, area = 1e-5, inertia = 0.02 * 1.25e-10 / 12.0;
  return pushed({.EA = E * area,
                 .GA = 5.0 / 6.0 * G * area,
                 .EI = E * inertia,
                 .rhoA = density * area,
                 .rhoI = density * inertia},
                10, 0.02);
}

double energy(const LinearBeam& model, const LinearBeam::State& state) {
  return model.kinetic_energy(state.v) + model.strain_energy(state.strain);
}

struct Held {
  double drift;          ///< of the energy after the push, relative
  double per_step;       ///< iterations
  bool finished = true;  ///< all steps solved
};
template <class Scheme>
Held hold(const LinearBeam& model, double h, double t_end, const SchemeOptions& options) {
  auto state = Scheme::start(model, model.initial(), options);
  const int steps = static_cast<int>(std::lround(t_end / h)), pushed = static_cast<int>(std::lround(1.0 / h));
  double first = 0.0, most = 0.0;
  for (int n = 0; n < steps; ++n) {
    if (Scheme::step(model, state, n * h, h) != Status::ok) return {1.0, 0.0, false};
    const double now = energy(model, Scheme::view(model, state));
    if (n + 1 == pushed) first = now;
    if (n + 1 > pushed) most = std::max(most, std::abs(now - first));
  }
  const Cost cost = Scheme::cost(model, state, steps);
  return {most / first, static_cast<double>(cost.newton_iterations) / steps};
}

}  // namespace

TEST_CASE("beam schemes: stiff beams keep their energy, by kernels and by the general stepper",
          "[planar_beam]") {
  const SchemeOptions by_kernels, by_stepper{.linear_solver = LinearSolver::band};
  for (const SchemeOptions& options : {by_kernels, by_stepper}) {
    for (const double stiffness : {1e6, 1e8, 1e10}) {
      INFO(stiffness << (options.linear_solver == LinearSolver::band ? " by the general stepper" : ""));
      const LinearBeam model = stiff(stiffness, 3.0);
      for (const double h : {0.01, 0.02}) {
        const Held second = hold<beam::BeamEnergyMomentum>(model, h, 2.0, options);
        CHECK(second.finished);
        CHECK(second.drift <= 1e-7);
        CHECK(second.per_step <= 30.0);
      }
      const Held fourth = hold<beam::BeamEnergyMomentum4>(model, 0.01, 2.0, options);
      CHECK(fourth.finished);
      CHECK(fourth.drift <= 1e-7);
      // The documented scheme does not keep it, however well its equations are solved.
      const Held documented = hold<beam::BeamMidpoint>(model, 0.02, 2.0, options);
      CHECK(documented.finished);
      CHECK(documented.drift >= 1e-6);
    }
    const LinearBeam ruler = steel_ruler();
    const Held second = hold<beam::BeamEnergyMomentum>(ruler, 0.02, 3.0, options);
    CHECK(second.finished);
    CHECK(second.drift <= 1e-8);
    CHECK(hold<beam::BeamEnergyMomentum4>(ruler, 0.02, 3.0, options).drift <= 1e-8);
  }
}

TEST_CASE("beam schemes: a load below the roundoff of stretch bends a stiff beam", "[planar_beam]") {
  const auto tip = [](const LinearBeam& model, auto scheme) {
    using Scheme = decltype(scheme);
    auto state = Scheme::start(model, model.initial(), SchemeOptions{});
    for (int n = 0; n < 50; ++n) REQUIRE(Scheme::step(model, state, 0.01 * n, 0.01) == Status::ok);
    const auto end = Scheme::view(model, state);
    return end.u[end.u.size() - 2];
  };
  const auto check = [&](auto scheme) {
    const double small = tip(stiff(1e10, 1e-5), scheme), large = tip(stiff(1e10, 1e-2), scheme);
    CHECK(large >= 1e-3);
    CHECK(std::abs(1e3 * small / large - 1.0) <= 1e-2);
  };
  check(beam::BeamEnergyMomentum{});
  check(beam::BeamMidpoint{});
  check(beam::BeamEnergyMomentum4{});
}
