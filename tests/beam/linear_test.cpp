// Motions whose continuous solution is known.
#include <cmath>
#include <numbers>

#include "tests/planar_beam/beams.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

/// A rod clamped at the start under a force that sets in at its end: c = 100 m/s.
Data pulled_rod(int elements) {
  Data data;
  data.length = 10.0;
  data.elements = elements;
  data.section = {1e4, 1e4, 500.0, 1.0, 10.0};
  data.supports[0] = {true, true, {}};
  data.loads = {{planar_beam::Place::end, {10.0, 0.0}, 0.0, planar_beam::Profile::constant, 0.0}};
  data.horizon = 0.4;
  return data;
}

/// Tip displacement in units of 2 F L/EA.
template <int p>
double tip(const char* scheme, int elements, double t) {
  const PlanarBeam<p> model(pulled_rod(elements));
  const RunResult result = run_beam(scheme, model, t, 1e-4);
  REQUIRE(result.status == Status::ok);
  const auto state = model.restore(result.state);
  CHECK(std::abs(state.u[model.unknowns() - 2]) <= 1e-12);
  return state.u[model.unknowns() - 3] / (2.0 * 10.0 * 10.0 / 1e4);
}

}  // namespace

TEST_CASE("planar beam: an axial wave runs to the support and back", "[planar_beam][long]") {
  for (const char* scheme : {"beam-midpoint", "beam-energy-momentum"}) {
    // Up to 2 L/c = 0.2 s and down again, on straight lines.
    CHECK(std::abs(tip<2>(scheme, 40, 0.1) - 0.5) <= 2e-3);
    CHECK(std::abs(tip<2>(scheme, 40, 0.3) - 0.5) <= 5e-3);
    CHECK(std::abs(tip<2>(scheme, 40, 0.2) - 1.0) <= 1e-2);
    CHECK(std::abs(tip<2>(scheme, 40, 0.4)) <= 1e-2);
  }
}

TEST_CASE("planar beam: a rod that spins steadily stays stretched by its own inertia", "[planar_beam]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "spinning-rod");
  const auto& model = typed<PlanarBeam<4>>(scene);
  const double k = 0.05, w = 5.0, half = std::tan(k * 5.0) / k;
  const auto initial = model.initial();
  CHECK(std::abs(initial.u[model.unknowns() - 3] - (half - 5.0)) <= 1e-14);
  const int steps = 4000;
  const RunResult result = run_beam("beam-energy-momentum", model, 5.0, 5.0 / steps);
  REQUIRE(result.status == Status::ok);
  const auto state = model.restore(result.state);
  for (int i = 0; i < model.nodes(); ++i) {
    const double x0 = model.positions()[2 * i];
    const double x = x0 + state.u[3 * i], z = state.u[3 * i + 1];
    const double r = std::sin(k * x0) / (k * std::cos(k * 5.0));
    INFO(x0 << ": " << std::hypot(x, z) - std::abs(r) << " " << state.v[3 * i + 2] - w);
    CHECK(std::abs(std::hypot(x, z) - std::abs(r)) <= 1e-7);
    // A straight rod: all sections have turned alike, clockwise on the page for a positive rate.
    CHECK(std::abs(std::remainder(std::atan2(-z, x) - state.u[3 * i + 2], std::numbers::pi)) * std::abs(r) <=
          1e-6);
    CHECK(std::abs(state.u[3 * i + 2] - w * 5.0) <= 1e-4);
  }
  // Without the stretch at the start the radius oscillates.
  Data rigid = model.data();
  rigid.u.clear();
  rigid.v.clear();
  rigid.angular_velocity = w;
  const PlanarBeam<4> plain(rigid);
  const auto other = plain.restore(run_beam("beam-energy-momentum", plain, 0.1, 5.0 / steps).state);
  CHECK(std::abs(std::hypot(5.0 + other.u[plain.unknowns() - 3], other.u[plain.unknowns() - 2]) - half) >=
        1e-3);
}
