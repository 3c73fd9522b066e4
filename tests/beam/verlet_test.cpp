// Explicit schemes: where they are stable, and what they converge to.
#include <cmath>

#include "integrators/beam/rk4.hpp"
#include "tests/planar_beam/beams.hpp"

using namespace gnomon;
using namespace gnomon::test;
using beam::Mass;

namespace {

template <int p>
void check_stability(const PlanarBeam<p>& model, const char* scheme, Mass mass, double reach = 2.0) {
  const beam::NodalBeamOf<PlanarBeam<p>> nodal(model);
  const double stable = 0.5 * reach * beam::stable_step(nodal, model.initial().u.data(), mass);
  const RunResult below = run_beam(scheme, model, 400.0 * stable, 0.95 * stable),
                  above = run_beam(scheme, model, 4000.0 * stable, 1.25 * stable);
  INFO(scheme << ", order " << p << ": " << stable << ", " << above.message);
  CHECK(below.status == Status::ok);
  CHECK(below.flags.empty());
  const auto state = model.restore(below.state);
  CHECK(model.kinetic_energy(state.v) + model.strain_energy(state.strain) <= 2.0 * model.scales().energy);
  CHECK(above.status == Status::diverged);
  CHECK(above.message.find("/omega_max") != std::string::npos);
  CHECK(above.flags.size() == 1);
}

template <int p>
void check_both(int elements) {
  Data data = spinning_beam(elements, false);
  check_stability(PlanarBeam<p>(data), "beam-verlet", Mass::lumped);
  check_stability(PlanarBeam<p>(data), "beam-verlet-consistent", Mass::consistent);
  check_stability(PlanarBeam<p>(data), "beam-rk4", Mass::consistent, 2.0 * std::sqrt(2.0));
}

}  // namespace

TEST_CASE("beam schemes: explicit steps below and above the stable one", "[planar_beam]") {
  check_both<1>(10);
  check_both<2>(6);
  check_both<3>(4);
  check_both<4>(3);
}

TEST_CASE("beam schemes: the stable step is that of the stiffest wave", "[planar_beam]") {
  // A two-node rod of length l, wave speed c: 2 c/l with lumped mass, sqrt(3) times that with consistent
  // mass.
  Data data = flying_beam(10, 500.0);
  const PlanarBeam<1> model(data);
  const beam::NodalBeamOf<PlanarBeam<1>> nodal(model);
  const planar_beam::State start = model.initial();
  const double* u = start.u.data();
  CHECK(std::abs(beam::stable_step(nodal, u, Mass::lumped) - 0.01) <= 1e-3);
  CHECK(std::abs(beam::stable_step(nodal, u, Mass::consistent) - 0.01 / std::sqrt(3.0)) <= 1e-3);
}

TEST_CASE("beam schemes: a step that a load makes unstable does not end well", "[planar_beam]") {
  // Stable at the start, not where the load has stretched the beam.
  const Scene scene =
      load_scene(beam_catalogue(), "soft-beam",
                 {{}, {"loads=[{at=\"end\",force=[40,0],moment=0.0,profile={kind=\"ramp\",over=1.0}}]"}});
  const auto ended = [&](const char* scheme, double h) {
    RunSpec spec;
    spec.t_end = 20.0;
    spec.step = h;
    return run_scheme(beam_catalogue(), scheme, *scene.model, spec);
  };
  const RunResult large = ended("beam-verlet-consistent", 0.02),
                  small = ended("beam-verlet-consistent", 0.005);
  INFO(large.message);
  CHECK(large.status == Status::diverged);
  CHECK(large.message.find("the motion grew beyond any scale") == 0);
  REQUIRE(large.flags.size() == 1);
  CHECK(large.flags[0].find("small motions are stable about t = ") != std::string::npos);
  CHECK(small.status == Status::ok);
  CHECK(small.flags.empty());
}

TEST_CASE("beam schemes: lumped mass converges with order 2 to a motion of its own", "[planar_beam]") {
  const PlanarBeam<2> model(soft_beam(4));
  planar_beam::State states[3];
  for (int k = 0; k < 3; ++k)
    states[k] = model.restore(run_beam("beam-verlet", model, 1.0, 1.0 / (640 << k)).state);
  const auto coarse = model.distance(states[0], states[1]), fine = model.distance(states[1], states[2]);
  const auto other = model.distance(
      states[2], model.restore(run_beam("beam-verlet-consistent", model, 1.0, 1.0 / 2560).state));
  for (int k = 0; k < 4; ++k) {
    INFO(model.metrics[k].name << ": " << coarse[k] << " " << fine[k] << " " << other[k]);
    CHECK(std::abs(std::log2(coarse[k] / fine[k]) - 2.0) <= 0.1);
    CHECK(other[k] >= 30.0 * fine[k]);
  }
}

TEST_CASE("beam schemes: lumped mass keeps its own angular momentum", "[planar_beam]") {
  const PlanarBeam<1> model(spinning_beam(10, true));
  const beam::NodalBeamOf<PlanarBeam<1>> nodal(model);
  const std::vector<double> mass = nodal.lumped_mass();
  const auto momentum = [&](const planar_beam::State& state) {
    double sum = 0.0;
    for (int i = 0; i < model.nodes(); ++i) {
      const double x = model.positions()[2 * i] + state.u[3 * i],
                   z = model.positions()[2 * i + 1] + state.u[3 * i + 1];
      sum +=
          mass[3 * i] * (z * state.v[3 * i] - x * state.v[3 * i + 1]) + mass[3 * i + 2] * state.v[3 * i + 2];
    }
    return sum;
  };
  const auto end = model.restore(run_beam("beam-verlet", model, 10.0, 0.004).state);
  const double before = momentum(model.initial());
  CHECK(std::abs(momentum(end) - before) <= 1e-11 * std::abs(before));
  CHECK(std::abs(model.momenta(end)[2] - model.momenta(model.initial())[2]) >= 1e-6 * std::abs(before));
}
