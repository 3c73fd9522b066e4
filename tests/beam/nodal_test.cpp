// Schemes on nodal values: their linear systems, damping, options.
#include <Eigen/Dense>
#include <cmath>
#include <complex>

#include "integrators/beam/generalized_alpha.hpp"
#include "tests/planar_beam/beams.hpp"
#include "tests/support/eigenvalues.hpp"

using namespace gnomon;
using namespace gnomon::test;
using beam::AlphaParameters;

namespace {

/// Largest modulus of the eigenvalues of the step of an oscillator of frequency w, in h^2 a, h v, u.
double spectral_radius(const AlphaParameters& p, double wh) {
  // The new (u, v, a): A new = B old.
  Eigen::Matrix3d A, B;
  A << 1, 0, -p.beta, 0, 1, -p.gamma, (1 - p.alpha_f) * wh * wh, 0, 1 - p.alpha_m;
  B << 1, 1, 0.5 - p.beta, 0, 1, 1 - p.gamma, -p.alpha_f * wh * wh, 0, -p.alpha_m;
  double radius = 0.0;
  for (const auto& value : eigenvalues(A.inverse() * B)) radius = std::max(radius, std::abs(value));
  return radius;
}

/// Relative error of what was factorised against dense matrices of finite differences of the force.
template <int p>
double factorisation_error() {
  Data data = soft_beam(3);
  data.supports[1].spring = 0.3;
  data.loads[0].follower = true;
  const PlanarBeam<p> model(data);
  beam::NodalBeamOf<PlanarBeam<p>> nodal(model);
  const int n = model.unknowns();
  const Eigen::VectorXd u = random_values(n, 1.0, 3);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd up(n), down(n), mass(n);
  for (int j = 0; j < n; ++j) {
    Eigen::VectorXd at = u, unit = Eigen::VectorXd::Unit(n, j);
    at[j] += 1e-6;
    nodal.internal_force(0.0, at.data(), up.data());
    at[j] -= 2e-6;
    nodal.internal_force(0.0, at.data(), down.data());
    nodal.momentum(unit.data(), mass.data());
    matrix.col(j) = 3.0 * mass + 0.7 * (up - down) / 2e-6;
  }
  const Eigen::VectorXd right = random_values(n, 1.0, 4);
  Eigen::VectorXd x = right;
  nodal.factorise(3.0, 0.7, 0.0, u.data());
  const auto copy = nodal.clone();  // with what was factorised
  nodal.factorise(1.0, 0.0, 0.0, u.data());
  copy->solve(x.data());
  for (int i : model.held()) CHECK(x[i] == 0.0);
  Eigen::VectorXd left = matrix * x - right;
  for (int i : model.held()) left[i] = 0.0;
  return left.norm() / right.norm();
}

RunSpec spec_of(double t_end, double step, const SchemeOptions& options) {
  RunSpec spec;
  spec.t_end = t_end;
  spec.step = step;
  spec.scheme = options;
  return spec;
}

}  // namespace

TEST_CASE("beam schemes: nodal systems against finite differences", "[planar_beam]") {
  CHECK(factorisation_error<1>() <= 1e-8);
  CHECK(factorisation_error<2>() <= 1e-8);
}

TEST_CASE("beam schemes: spectral radius at infinite frequency", "[planar_beam]") {
  for (double radius : {0.0, 0.3, 0.5, 0.8, 1.0}) {
    // A double or triple eigenvalue, of which rounding leaves a root.
    CHECK(std::abs(spectral_radius(beam::chung_hulbert_parameters(radius), 1e5) - radius) <= 1e-3);
    if (radius >= 0.5) CHECK(std::abs(spectral_radius(beam::hht_parameters(radius), 1e5) - radius) <= 1e-3);
  }
  const AlphaParameters newmark = beam::trapezoidal_parameters(), hht = beam::hht_parameters(1.0);
  CHECK(newmark.beta == hht.beta);
  CHECK(newmark.gamma == hht.gamma);
  CHECK(hht.alpha_f == 0.0);
  for (double wh : {0.1, 1.0, 10.0, 1e3}) CHECK(std::abs(spectral_radius(newmark, wh) - 1.0) <= 1e-7);
  CHECK(spectral_radius(beam::chung_hulbert_parameters(0.8), 1.0) < 1.0);
}

TEST_CASE("beam schemes: --spectral-radius damps", "[planar_beam]") {
  const PlanarBeam<1> model(flying_beam(10, 500.0));
  for (const char* scheme : {"beam-generalized-alpha", "beam-hht"}) {
    double energies[3];
    int k = 0;
    for (double radius : {0.5, 0.8, 1.0}) {
      SchemeOptions options;
      options.spectral_radius = radius;
      const RunResult result = run_beam(scheme, model, spec_of(10.0, 0.05, options));
      REQUIRE(result.status == Status::ok);
      const auto state = model.restore(result.state);
      energies[k++] = model.kinetic_energy(state.v) + model.strain_energy(state.strain);
    }
    INFO(scheme << ": " << energies[0] << " " << energies[1] << " " << energies[2]);
    CHECK(energies[0] <= (1.0 - 1e-4) * energies[1]);
    CHECK(energies[1] <= (1.0 - 1e-4) * energies[2]);
    // 0.8 where nothing is said.
    const RunResult by_default = run_beam(scheme, model, 10.0, 0.05);
    const auto state = model.restore(by_default.state);
    CHECK(model.kinetic_energy(state.v) + model.strain_energy(state.strain) == energies[1]);
  }
}

TEST_CASE("beam schemes: --modified-newton factorises less and comes to the same", "[planar_beam]") {
  const PlanarBeam<1> model(flying_beam(10, 500.0));
  for (const char* scheme : {"beam-midpoint", "beam-energy-momentum", "beam-trapezoidal", "beam-bathe"}) {
    SchemeOptions options;
    const RunResult full = run_beam(scheme, model, spec_of(5.0, 0.1, options));
    options.modified_newton = true;
    const RunResult modified = run_beam(scheme, model, spec_of(5.0, 0.1, options));
    REQUIRE(full.status == Status::ok);
    REQUIRE(modified.status == Status::ok);
    const auto difference = model.distance(model.restore(full.state), model.restore(modified.state));
    INFO(scheme << ": " << full.cost.factorizations << " " << modified.cost.factorizations << " "
                << difference[0]);
    CHECK(modified.cost.factorizations < full.cost.factorizations);
    CHECK(modified.cost.newton_iterations > full.cost.newton_iterations);
    CHECK(difference[0] <= 1e-7);
  }
}
