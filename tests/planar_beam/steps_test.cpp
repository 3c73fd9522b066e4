#include <Eigen/Dense>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "integrators/beam/midpoint.hpp"
#include "src/reference_states.hpp"
#include "src/run.hpp"
#include "tests/catch.hpp"
#include "tests/planar_beam/beams.hpp"

using namespace gnomon;
using namespace gnomon::test;
using beam::BeamEnergyMomentum;
using beam::BeamMidpoint;

namespace {

template <class S, int p>
auto random_step(const PlanarBeam<p>& model) {
  auto start = model.initial();
  start.u = random_values(model.unknowns(), 2.0, 1);
  start.v = random_values(model.unknowns(), 5.0, 2);
  auto state = S::start(model, start);
  state.mean = random_values(model.unknowns(), 5.0, 3);
  state.load(model, 0.1);
  return state;
}

template <class S, int p>
double tangent_error() {
  Data data = flying_beam(3, 100.0);
  data.curvature = 0.13;
  const PlanarBeam<p> model(data);
  auto state = random_step<S>(model);
  const double h = 0.3;
  const int n = model.unknowns();
  constexpr int size = 3 * (p + 1);
  const Eigen::VectorXd middle = state.mean;
  state.evaluate(model, h);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n), difference(n, n);
  for (int e = 0; e < model.elements(); ++e)
    K.block<size, size>(3 * p * e, 3 * p * e) += state.element_tangent(model, e, h);
  // The elimination solves with the matrix that the elements make.
  state.linearise(model, h);
  const Eigen::VectorXd residual = state.residual();
  const Eigen::VectorXd change = state.correct();
  CHECK((K * change + residual).norm() <= 1e-11 * residual.norm());
  for (int j = 0; j < n; ++j) {
    const double step = 1e-6;
    state.mean = middle;
    state.mean[j] += step;
    state.evaluate(model, h);
    const Eigen::VectorXd up = state.residual();
    state.mean[j] -= 2.0 * step;
    state.evaluate(model, h);
    difference.col(j) = (up - state.residual()) / (2.0 * step);
  }
  return (K - difference).norm() / K.norm();
}

template <class S, int p>
RunResult run_beam(const PlanarBeam<p>& model, double t_end, double step) {
  RunSpec spec;
  spec.t_end = t_end;
  spec.step = step;
  return run<PlanarBeam<p>, S>(model, spec);
}

/// Largest change of the energy and of the momenta (norm) after the invariants' own time, by their scales.
struct Drifts {
  double energy = 0.0, linear = 0.0, angular = 0.0;
};
template <class S, int p>
Drifts drifts(const PlanarBeam<p>& model, double t_end, double step) {
  const RunResult result = run_beam<S>(model, t_end, step);
  REQUIRE(result.status == Status::ok);
  const auto infos = model.invariant_info();
  REQUIRE(infos.size() == 3);
  const double* first = nullptr;
  Drifts most;
  for (std::size_t k = 0; k < result.invariants.t.size(); ++k) {
    if (result.invariants.t[k] < infos[0].since) continue;
    const double* now = result.invariants.values.data() + 4 * k;
    if (!first) first = now;
    most.energy = std::max(most.energy, std::abs(now[0] - first[0]) / infos[0].scale);
    most.linear = std::max(most.linear, std::hypot(now[1] - first[1], now[2] - first[2]) / infos[1].scale);
    most.angular = std::max(most.angular, std::abs(now[3] - first[3]) / infos[2].scale);
  }
  return most;
}

/// Observed orders between two steps, against a certified solution on the same mesh.
template <class S>
std::array<double, 4> orders(const PlanarBeam<2>& model, const std::vector<double>& reference) {
  const auto error = [&](int steps) {
    return model.distance(model.restore(run_beam<S>(model, 1.0, 1.0 / steps).state),
                          model.restore(reference));
  };
  const auto coarse = error(1280), fine = error(2560);
  std::array<double, 4> observed{};
  for (int k = 0; k < 4; ++k) observed[k] = std::log2(coarse[k] / fine[k]);
  return observed;
}

}  // namespace

TEST_CASE("beam schemes: tangent against finite differences", "[beam]") {
  for (double error : {tangent_error<BeamMidpoint, 1>(), tangent_error<BeamMidpoint, 2>(),
                       tangent_error<BeamMidpoint, 3>(), tangent_error<BeamMidpoint, 4>(),
                       tangent_error<BeamEnergyMomentum, 1>(), tangent_error<BeamEnergyMomentum, 2>(),
                       tangent_error<BeamEnergyMomentum, 3>(), tangent_error<BeamEnergyMomentum, 4>()})
    CHECK(error <= 1e-6);
}

TEST_CASE("beam schemes: Newton's iteration converges quadratically", "[beam]") {
  const PlanarBeam<2> model(flying_beam(6, 500.0));
  const double h = 0.1;
  auto state = BeamMidpoint::start(model, model.initial());
  state.load(model, 0.05);
  std::vector<double> residuals;
  for (int k = 0; k < 8; ++k) {
    residuals.push_back(state.evaluate(model, h));
    state.linearise(model, h);
    const Eigen::VectorXd change = state.correct();
    state.mean += change;
  }
  int quadratic = 0;
  for (std::size_t k = 1; k + 1 < residuals.size(); ++k) {
    INFO(residuals[k - 1] << " " << residuals[k] << " " << residuals[k + 1]);
    if (residuals[k] < 1e-1 && residuals[k + 1] > 1e-11)
      quadratic +=
          std::log(residuals[k + 1] / residuals[k]) / std::log(residuals[k] / residuals[k - 1]) > 1.5;
  }
  CHECK(quadratic >= 1);
  CHECK(residuals.back() <= 1e-10);
}

TEST_CASE("beam schemes: momenta of a free beam, straight and curved", "[beam]") {
  for (bool curved : {false, true}) {
    const PlanarBeam<1> linear(spinning_beam(10, curved));
    const PlanarBeam<2> quadratic(spinning_beam(5, curved));
    for (const Drifts& d :
         {drifts<BeamMidpoint>(linear, 20.0, 0.02), drifts<BeamEnergyMomentum>(linear, 20.0, 0.02),
          drifts<BeamMidpoint>(quadratic, 20.0, 0.02), drifts<BeamEnergyMomentum>(quadratic, 20.0, 0.02)}) {
      CHECK(d.linear <= 1e-12);
      CHECK(d.angular <= 1e-12);
    }
  }
  // With the exact tangent a curved beam loses its angular momentum.
  Data exact = spinning_beam(10, true);
  exact.geometry = planar_beam::Geometry::exact;
  CHECK(drifts<BeamMidpoint>(PlanarBeam<1>(exact), 2.0, 0.02).angular >= 1e-4);
}

TEST_CASE("beam schemes: energy", "[beam]") {
  const PlanarBeam<1> model(flying_beam(10, 500.0));
  const Drifts kept = drifts<BeamEnergyMomentum>(model, 502.5, 0.05);
  INFO(kept.energy << " " << kept.linear << " " << kept.angular);
  CHECK(kept.energy <= 1e-11);
  CHECK(kept.linear <= 1e-11);
  CHECK(kept.angular <= 1e-11);
  const double coarse = drifts<BeamMidpoint>(model, 22.5, 0.05).energy,
               fine = drifts<BeamMidpoint>(model, 22.5, 0.025).energy,
               finest = drifts<BeamMidpoint>(model, 22.5, 0.0125).energy;
  INFO(coarse << " " << fine << " " << finest);
  CHECK(coarse >= 1e-5);
  CHECK(coarse <= 1e-2);
  CHECK(std::abs(std::log2(fine / finest) - 2.0) <= 0.3);
}

TEST_CASE("beam schemes: large steps", "[beam]") {
  for (double EI : {500.0, 100.0}) {
    const PlanarBeam<3> model(flying_beam(10, EI));
    for (double h : {0.25, 0.5}) {
      const Drifts d = drifts<BeamEnergyMomentum>(model, 50.0, h);
      INFO("EI " << EI << ", h " << h << ": " << d.energy);
      CHECK(d.energy <= 1e-11);
      CHECK(d.angular <= 1e-11);
    }
  }
}

TEST_CASE("beam schemes: order 2 in all four classes of error", "[beam]") {
  const PlanarBeam<2> model(soft_beam(4));
  const ReferenceStates reference = reference_states(model, {1.0});
  REQUIRE(reference.kind == "certified");
  for (const auto& observed : {orders<BeamMidpoint>(model, reference.states[0]),
                               orders<BeamEnergyMomentum>(model, reference.states[0])})
    for (double order : observed) CHECK(std::abs(order - 2.0) <= 0.05);
}

TEST_CASE("beam schemes: the flying beam's momentum and centre", "[beam]") {
  const PlanarBeam<3> model(flying_beam(10, 500.0));
  for (double t_end : {1.0, 2.5, 10.0}) {
    const auto state = model.restore(run_beam<BeamEnergyMomentum>(model, t_end, 0.05).state);
    const auto momenta = model.momenta(state);
    CHECK(std::abs(momenta[0] - 8.0 * std::min(t_end, 2.5)) <= 1e-11);
    CHECK(std::abs(momenta[1]) <= 1e-11);
    double centre[2] = {0, 0};
    for (int e = 0; e < model.elements(); ++e)
      for (int a = 0; a <= 3; ++a)
        for (int k = 0; k < 2; ++k) {
          const int i = 3 * e + a;
          centre[k] += model.element().load[a] * (model.positions()[2 * i + k] + state.u[3 * i + k]) / 10.0;
        }
    const double x = t_end <= 2.5 ? 3.0 + 0.4 * t_end * t_end : 5.5 + 2.0 * (t_end - 2.5);
    CHECK(std::abs(centre[0] - x) <= 1e-11);
    CHECK(std::abs(centre[1] - 4.0) <= 1e-11);
  }
}
