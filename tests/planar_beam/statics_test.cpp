#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/planar_beam/beams.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

template <int p>
Eigen::MatrixXd stiffness(const PlanarBeam<p>& beam, const Eigen::VectorXd& u) {
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(beam.unknowns(), beam.unknowns());
  constexpr int size = 3 * (p + 1);
  for (int e = 0; e < beam.elements(); ++e)
    K.block<size, size>(3 * p * e, 3 * p * e) += beam.element_tangent(u.data(), e);
  return K;
}

template <int p>
double tangent_error() {
  Data data = flying_beam(3, 100.0);
  data.curvature = 0.13;
  const PlanarBeam<p> beam(data);
  const int n = beam.unknowns();
  Eigen::VectorXd u = random_values(n, 2.0, 7), up(n), down(n);
  const Eigen::MatrixXd K = stiffness(beam, u);
  Eigen::MatrixXd difference(n, n);
  for (int j = 0; j < n; ++j) {
    const double kept = u[j], step = 1e-6;
    u[j] = kept + step;
    beam.internal_force(u.data(), up.data());
    u[j] = kept - step;
    beam.internal_force(u.data(), down.data());
    u[j] = kept;
    difference.col(j) = (up - down) / (2.0 * step);
  }
  CHECK((K - K.transpose()).norm() <= 1e-14 * K.norm());
  return (K - difference).norm() / K.norm();
}

/// The displacements of a rigid turn by `angle` about +y round the origin.
template <int p>
Eigen::VectorXd rigid_turn(const PlanarBeam<p>& beam, double angle) {
  Eigen::VectorXd u(beam.unknowns());
  for (int i = 0; i < beam.nodes(); ++i) {
    const double x = beam.positions()[2 * i], z = beam.positions()[2 * i + 1];
    u[3 * i] = x * std::cos(angle) + z * std::sin(angle) - x;
    u[3 * i + 1] = -x * std::sin(angle) + z * std::cos(angle) - z;
    u[3 * i + 2] = angle;
  }
  return u;
}

template <int p>
double turned_strain(bool curved, double angle, planar_beam::Geometry geometry) {
  Data data = spinning_beam(5, curved);
  data.geometry = geometry;
  const PlanarBeam<p> beam(data);
  return beam.strains(rigid_turn(beam, angle).data()).cwiseAbs().maxCoeff();
}

/// Equilibrium of a clamped beam under a dead tip force, by Newton's iteration with load steps.
template <int p>
Eigen::VectorXd elastica(int elements, double load, double stiffness_ratio) {
  Data data;
  data.elements = elements;
  data.section = {stiffness_ratio, stiffness_ratio, 1.0, 1.0, 1.0};
  data.supports[0] = {true, true, {}};
  const PlanarBeam<p> beam(data);
  const int n = beam.unknowns();
  Eigen::VectorXd u = Eigen::VectorXd::Zero(n), force(n);
  const int steps = 20;
  for (int k = 1; k <= steps; ++k) {
    double size = 1.0;
    for (int iteration = 0; iteration < 30 && size > 1e-13; ++iteration) {
      beam.internal_force(u.data(), force.data());
      Eigen::VectorXd residual = -force;
      residual[n - 2] += load * k / steps;
      Eigen::MatrixXd K = stiffness(beam, u);
      for (int i : beam.held()) {
        K.row(i).setZero();
        K.col(i).setZero();
        K(i, i) = 1.0;
        residual[i] = 0.0;
      }
      const Eigen::VectorXd change = K.partialPivLu().solve(residual);
      u += change;
      size = change.norm();
    }
    REQUIRE(size <= 1e-9);
  }
  return u.tail(3);
}

}  // namespace

TEST_CASE("planar beam: stiffness against finite differences", "[planar_beam]") {
  for (double error : {tangent_error<1>(), tangent_error<2>(), tangent_error<3>(), tangent_error<4>()})
    CHECK(error <= 1e-7);
}

TEST_CASE("planar beam: a rigid turn does not strain it", "[planar_beam]") {
  using planar_beam::Geometry;
  for (double angle : {0.0, 0.7, 3.141592653589793, 5.3})
    for (bool curved : {false, true}) {
      CHECK(turned_strain<1>(curved, angle, Geometry::interpolated) <= 1e-14);
      CHECK(turned_strain<2>(curved, angle, Geometry::interpolated) <= 1e-14);
      CHECK(turned_strain<3>(curved, angle, Geometry::interpolated) <= 1e-14);
      CHECK(turned_strain<4>(curved, angle, Geometry::interpolated) <= 2e-14);
    }
  // The exact tangent is not the derivative of the interpolated geometry.
  CHECK(turned_strain<1>(true, 0.7, Geometry::exact) >= 1e-4);
  CHECK(turned_strain<1>(true, 0.0, Geometry::exact) <= 1e-14);
  CHECK(turned_strain<1>(false, 0.7, Geometry::exact) <= 1e-14);
}

TEST_CASE("planar beam: the elastica under a dead tip force", "[planar_beam][long]") {
  // With EA = GA = S the rotation is that of the elastica and the deflection gains P L/S.
  struct Row {
    double load, deflection, shortening, angle;
  };
  for (const Row& row : {Row{1, .301720773800, .056433236283, .461351949712},
                         Row{2, .493457480397, .160641720825, .781749831557},
                         Row{5, .713791523612, .387628360724, 1.215368117612},
                         Row{10, .810609024880, .554995597754, 1.430285538804}}) {
    const double S = 1e4;
    const Eigen::VectorXd tip = elastica<4>(12, row.load, S);
    INFO("P L^2/EI = " << row.load << ": " << tip.transpose());
    // A positive rotation about +y turns z towards x, so a force along z gives a negative one.
    CHECK(std::abs(tip[1] - row.load / S - row.deflection) <= 1e-8);
    CHECK(std::abs(-tip[0] - row.shortening) <= 1e-8);
    CHECK(std::abs(-tip[2] - row.angle) <= 1e-8);
  }
  // Order 2 p, and no locking.
  const auto error = [](const Eigen::VectorXd& tip) { return std::abs(-tip[2] - 1.430285538804); };
  const double linear = std::log2(error(elastica<1>(16, 10, 1e4)) / error(elastica<1>(32, 10, 1e4)));
  const double quadratic = std::log2(error(elastica<2>(8, 10, 1e4)) / error(elastica<2>(16, 10, 1e4)));
  CHECK(std::abs(linear - 2.0) <= 0.1);
  CHECK(std::abs(quadratic - 4.0) <= 0.3);
  for (double S : {1e6, 1e8}) CHECK(error(elastica<1>(8, 10, S)) <= 2.0 * error(elastica<1>(8, 10, 1e3)));
}

TEST_CASE("planar beam: Timoshenko's lowest frequency of a clamped beam", "[planar_beam]") {
  Data spin_up = flying_beam(12, 1.4e4);
  spin_up.section = {2.8e7, 1e7, 1.4e4, 1.2, 6e-4};
  for (auto& [data, expected] :
       {std::pair{flying_beam(12, 500.0), 0.646852}, std::pair{flying_beam(12, 100.0), 0.289403},
        std::pair{flying_beam(12, 1000.0), 0.914306}, std::pair{spin_up, 3.797563}}) {
    Data held = data;
    held.supports[0] = {true, true, {}};
    const PlanarBeam<4> beam(held);
    const int n = static_cast<int>(beam.free().size());
    const auto form = beam.ode();
    std::vector<double> y(form.size(), 0.0), J(static_cast<std::size_t>(form.size()) * form.size());
    form.jacobian(10.0, y.data(), J.data());
    const Eigen::MatrixXd A = -Eigen::Map<Eigen::MatrixXd>(J.data(), 2 * n, 2 * n).bottomLeftCorner(n, n);
    const double lowest =
        std::sqrt(Eigen::EigenSolver<Eigen::MatrixXd>(A, false).eigenvalues().real().minCoeff());
    INFO(lowest);
    CHECK(std::abs(lowest - expected) <= 1e-6);
  }
}
