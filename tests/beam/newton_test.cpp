// One step of the beam schemes from inside: residual, tangent, elimination, Newton's iteration.
#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "integrators/beam/mixed_midpoint.hpp"
#include "integrators/beam/stander_stein.hpp"
#include "tests/catch.hpp"
#include "tests/planar_beam/beams.hpp"

using namespace gnomon;
using namespace gnomon::test;
using beam::BeamEnergyMomentum;
using beam::BeamMidpoint;
using beam::BeamMixedMidpoint;
using beam::BeamStanderStein;

namespace {

/// The tangent of all unknowns as the elements make it, rows and columns of held ones those of the unit
/// matrix; `inertia` = 0 leaves the inertia term out.
template <int p, class State>
Eigen::MatrixXd tangent(const PlanarBeam<p>& model, const State& state, double h, double inertia = 1.0) {
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(model.unknowns(), model.unknowns());
  constexpr int size = 3 * (p + 1);
  for (int e = 0; e < model.elements(); ++e) {
    Eigen::Matrix<double, size, size> one = state.element_tangent(model, e, h);
    for (int a = 0; a <= p; ++a)
      for (int b = 0; b <= p; ++b)
        for (int k = 0; k < 3; ++k)
          one(3 * a + k, 3 * b + k) -=
              (1.0 - inertia) * 2.0 / h * model.element().mass[a][b] * model.density(k);
    K.block<size, size>(3 * p * e, 3 * p * e) += one;
  }
  for (int i : model.held()) {
    K.row(i).setZero();
    K.col(i).setZero();
    K(i, i) = 1.0;
  }
  return K;
}

template <class S, int p>
double tangent_error(unsigned seed, bool loaded = false) {
  Data data = flying_beam(3, 100.0);
  data.curvature = 0.13;
  if (loaded) {
    data.loads.push_back(data.loads[0]);
    for (auto& load : data.loads) {
      load.follower = true;
      load.force = {-900.0, 1500.0};
    }
    data.loads[1].at = planar_beam::Place::end;
    data.supports[0].spring = 2e4;
    data.supports[1].spring = 1e4;
    data.damping = 3.0;
  }
  const PlanarBeam<p> model(data);
  auto start = model.initial();
  start.u = random_values(model.unknowns(), 2.0, seed);
  start.v = random_values(model.unknowns(), 5.0, seed + 1);
  beam::Stepper<PlanarBeam<p>, S::kind> state(model, start, SchemeOptions{});
  state.mean = random_values(model.unknowns(), 5.0, seed + 2);
  state.load(model, 0.1);
  const double h = 0.3;
  const int n = model.unknowns();
  const Eigen::VectorXd middle = state.mean;
  state.evaluate(model, h);
  const Eigen::MatrixXd K = tangent(model, state, h);
  Eigen::MatrixXd difference(n, n);
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

/// Residual norms of plain Newton steps on the second step of a beam, without line search.
template <class S>
std::vector<double> residuals(double h, double inertia, int count) {
  const PlanarBeam<2> model(flying_beam(4, 100.0));
  auto state = S::start(model, model.initial());
  REQUIRE(state.step(model, 0.0, h) == Status::ok);
  state.load(model, 1.5 * h);
  state.mean = state.v;
  std::vector<double> norms;
  for (int k = 0; k < count; ++k) {
    norms.push_back(state.evaluate(model, h));
    state.mean -= tangent(model, state, h, inertia).partialPivLu().solve(state.residual());
  }
  return norms;
}

/// The elimination against a dense solution; where `held`, some unknowns of the ends are taken out.
template <int p>
double elimination_error(int elements, bool held) {
  constexpr int size = 3 * (p + 1);
  const int n = 3 * (p * elements + 1);
  const std::vector<int> out = held ? std::vector<int>{0, 2, n - 2} : std::vector<int>{};
  beam::ElementChain<p> chain(elements, out);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (int round = 0; round < 2; ++round) {  // nothing of the first matrix may be left in the second
    A.setZero();
    for (int e = 0; e < elements; ++e) {
      const Eigen::VectorXd entries = random_values(size * size, 1.0, 10U * round + e + 1);
      Eigen::Matrix<double, size, size> K =
          Eigen::Map<const Eigen::Matrix<double, size, size>>(entries.data());
      K.diagonal().array() += size;
      chain.add(e, K);
      A.block<size, size>(3 * p * e, 3 * p * e) += K;
    }
    chain.factorise();
  }
  Eigen::VectorXd right = random_values(n, 1.0, 99), x = right;
  for (int i : out) {
    A.row(i).setZero();
    A.col(i).setZero();
    A(i, i) = 1.0;
    right[i] = 0.0;
  }
  chain.solve(x.data());
  for (int i : out) CHECK(x[i] == 0.0);
  return (A * x - right).norm() / right.norm();
}

}  // namespace

TEST_CASE("beam schemes: elimination against dense matrices", "[planar_beam]") {
  for (int elements : {1, 2, 3, 4, 5, 8, 9})
    for (bool held : {false, true}) {
      INFO(elements << " elements");
      CHECK(elimination_error<1>(elements, held) <= 1e-14);
      CHECK(elimination_error<2>(elements, held) <= 1e-14);
      CHECK(elimination_error<3>(elements, held) <= 1e-14);
      CHECK(elimination_error<4>(elements, held) <= 1e-14);
    }
}

TEST_CASE("beam schemes: tangent against finite differences in large random states", "[planar_beam]") {
  for (unsigned seed : {1U, 11U, 21U})
    for (double error :
         {tangent_error<BeamMidpoint, 1>(seed), tangent_error<BeamMidpoint, 2>(seed),
          tangent_error<BeamMidpoint, 3>(seed), tangent_error<BeamMidpoint, 4>(seed),
          tangent_error<BeamEnergyMomentum, 1>(seed), tangent_error<BeamEnergyMomentum, 2>(seed),
          tangent_error<BeamEnergyMomentum, 3>(seed), tangent_error<BeamEnergyMomentum, 4>(seed),
          tangent_error<BeamStanderStein, 1>(seed), tangent_error<BeamStanderStein, 2>(seed),
          tangent_error<BeamMixedMidpoint, 1>(seed), tangent_error<BeamMixedMidpoint, 2>(seed)})
      CHECK(error <= 1e-6);
}

TEST_CASE("beam schemes: tangent with followers, springs and damping against finite differences",
          "[planar_beam]") {
  for (unsigned seed : {1U, 11U})
    for (double error :
         {tangent_error<BeamMidpoint, 1>(seed, true), tangent_error<BeamMidpoint, 3>(seed, true),
          tangent_error<BeamEnergyMomentum, 1>(seed, true), tangent_error<BeamEnergyMomentum, 3>(seed, true)})
      CHECK(error <= 1e-6);
}

TEST_CASE("beam schemes: Newton's iteration converges quadratically", "[planar_beam]") {
  for (const auto& e :
       {residuals<BeamMidpoint>(0.3, 1.0, 8), residuals<BeamEnergyMomentum>(0.3, 1.0, 8),
        residuals<BeamStanderStein>(0.3, 1.0, 8), residuals<BeamMixedMidpoint>(0.3, 1.0, 8)}) {
    // Pairs above roundoff, 1e-11: e_{k+1} <= C e_k^2 with one C. A rate of 0.1 would need C = 0.1/e_k,
    // which is 20 and more in the last pair.
    int pairs = 0;
    for (std::size_t k = 0; k + 1 < e.size(); ++k) {
      if (e[k] > 0.1 * e[0] || e[k + 1] < 1e-10) continue;
      INFO(e[k] << " -> " << e[k + 1]);
      CHECK(e[k + 1] <= 1e-2 * e[k] * e[k]);
      ++pairs;
    }
    CHECK(pairs >= 2);
    CHECK(e.back() <= 1e-13 * e[0]);
  }
}

TEST_CASE("beam schemes: without the inertia term of the tangent Newton's iteration fails at small steps",
          "[planar_beam]") {
  const auto with = residuals<BeamMidpoint>(1e-3, 1.0, 8), without = residuals<BeamMidpoint>(1e-3, 0.0, 8);
  CHECK(with.back() <= 1e-9 * with[0]);
  CHECK_FALSE(without.back() <= without[0]);
}
