#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/catch.hpp"
#include "tests/planar_beam/beams.hpp"
#include "tests/support/eigenvalues.hpp"

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

/// Equilibrium of a clamped beam of length and EI 1 under a dead force or a moment at its end: displacement
/// and rotation there.
template <int p>
Eigen::Vector3d bent_tip(int elements, double force, double moment, double EA, double GA) {
  Data data;
  data.elements = elements;
  data.section = {EA, GA, 1.0, 1.0, 1.0};
  data.supports[0] = {true, true, {}};
  data.loads = {{planar_beam::Place::end, {0.0, force}, moment, planar_beam::Profile::constant, 0.0}};
  const PlanarBeam<p> beam(data);
  const StaticPath path = follow_equilibrium(*beam.statics());
  INFO(path.message);
  REQUIRE(path.status == Status::ok);
  return beam.restore(path.points.back().state).u.tail(3);
}
template <int p>
Eigen::Vector3d elastica(int elements, double load, double S) {
  return bent_tip<p>(elements, load, 0.0, S, S);
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
    const Eigen::Vector3d tip = elastica<4>(24, row.load, S);
    INFO("P L^2/EI = " << row.load << ": " << tip.transpose());
    // A positive rotation about +y turns z towards x, so a force along z gives a negative one.
    CHECK(std::abs(tip[1] - row.load / S - row.deflection) <= 1e-9);
    CHECK(std::abs(-tip[0] - row.shortening) <= 1e-9);
    CHECK(std::abs(-tip[2] - row.angle) <= 1e-9);
  }
}

TEST_CASE("planar beam: the static error is of order 2 p and does not lock", "[planar_beam]") {
  const double angle = 1.430285538804;
  const auto error = [&](const Eigen::Vector3d& tip) { return std::abs(-tip[2] - angle); };
  const auto order = [&](double coarse, double fine) { return std::log2(coarse / fine); };
  CHECK(std::abs(order(error(elastica<1>(16, 10, 1e4)), error(elastica<1>(32, 10, 1e4))) - 2.0) <= 0.1);
  CHECK(std::abs(order(error(elastica<2>(8, 10, 1e4)), error(elastica<2>(16, 10, 1e4))) - 4.0) <= 0.3);
  CHECK(std::abs(order(error(elastica<3>(4, 10, 1e4)), error(elastica<3>(8, 10, 1e4))) - 6.0) <= 0.6);
  CHECK(std::abs(order(error(elastica<4>(3, 10, 1e4)), error(elastica<4>(6, 10, 1e4))) - 8.0) <= 1.0);
  // The same error at all ratios EA L^2/EI.
  const double coarse[4] = {error(elastica<1>(8, 10, 1e2)), error(elastica<2>(4, 10, 1e2)),
                            error(elastica<3>(3, 10, 1e2)), error(elastica<4>(2, 10, 1e2))};
  for (double S : {1e4, 1e6, 1e8}) {
    const double found[4] = {error(elastica<1>(8, 10, S)), error(elastica<2>(4, 10, S)),
                             error(elastica<3>(3, 10, S)), error(elastica<4>(2, 10, S))};
    for (int k = 0; k < 4; ++k) {
      INFO("order " << k + 1 << ", S = " << S << ": " << found[k] << " and " << coarse[k]);
      CHECK(found[k] <= 3.0 * coarse[k]);
      CHECK(found[k] >= 0.01 * coarse[k]);
    }
  }
}

TEST_CASE("planar beam: a moment rolls it up to a half circle", "[planar_beam]") {
  const double pi = 3.141592653589793;
  // A circle exactly: the tip is at (0, -2/pi), turned by pi, whatever EA and GA.
  const auto error = [&](const Eigen::Vector3d& tip) { return std::hypot(tip[0] + 1.0, tip[1] + 2.0 / pi); };
  const Eigen::Vector3d fine = bent_tip<3>(12, 0.0, pi, 1e4, 1e3);
  INFO(fine.transpose());
  CHECK(error(fine) <= 1e-9);
  CHECK(std::abs(fine[2] - pi) <= 1e-11);
  const double linear = error(bent_tip<1>(8, 0.0, pi, 1e4, 1e3)),
               linear_fine = error(bent_tip<1>(16, 0.0, pi, 1e4, 1e3));
  CHECK(std::abs(std::log2(linear / linear_fine) - 2.0) <= 0.1);
  const double quadratic = error(bent_tip<2>(4, 0.0, pi, 1e4, 1e3)),
               quadratic_fine = error(bent_tip<2>(8, 0.0, pi, 1e4, 1e3));
  CHECK(std::abs(std::log2(quadratic / quadratic_fine) - 4.0) <= 0.3);
}

TEST_CASE("planar beam: equilibrium by arc length is that by load steps", "[planar_beam]") {
  Data data = soft_beam(4);
  data.curvature = 0.7;
  const PlanarBeam<2> beam(data);
  StaticsOptions options;
  const StaticPath by_load = follow_equilibrium(*beam.statics(), options);
  options.arc_length = true;
  const StaticPath by_length = follow_equilibrium(*beam.statics(), options);
  REQUIRE(by_load.status == Status::ok);
  REQUIRE(by_length.status == Status::ok);
  CHECK(by_load.points.size() == 10);
  const Eigen::VectorXd u = beam.restore(by_load.points.back().state).u,
                        other = beam.restore(by_length.points.back().state).u;
  CHECK((u - other).norm() <= 1e-12 * u.norm());
  CHECK(by_length.points.back().factor == 1.0);
  // It is one: no force is left on free unknowns.
  Eigen::VectorXd inner(beam.unknowns()), outer(beam.unknowns());
  beam.internal_force(u.data(), inner.data());
  beam.external_force(0.0, outer.data());
  for (int i : beam.free()) CHECK(std::abs(inner[i] - outer[i]) <= 1e-13);
  CHECK(outer.norm() >= 0.1);
}

TEST_CASE("planar beam: statics with springs, followers, slides and moved ends", "[planar_beam]") {
  using planar_beam::Motion;
  // A rigid bar on a pin with a spring: k phi = moment of the force.
  Data bar;
  bar.elements = 2;
  bar.section = {1e7, 1e7, 1e7, 1.0, 1.0};
  bar.supports[0].place = true;
  bar.supports[0].spring = 2.0;
  bar.loads = {{planar_beam::Place::end, {0.0, -3.0}, 0.0, planar_beam::Profile::constant, 0.0}};
  const auto turn = [](const Data& data) {
    const PlanarBeam<1> beam(data);
    const StaticPath path = follow_equilibrium(*beam.statics());
    REQUIRE(path.status == Status::ok);
    return beam.restore(path.points.back().state).u[2];
  };
  const double dead = turn(bar);
  CHECK(std::abs(2.0 * dead - 3.0 * std::cos(dead)) <= 1e-5);
  bar.loads[0].follower = true;
  CHECK(std::abs(turn(bar) - 1.5) <= 1e-5);
  // A moved end against a clamped one: stretched and sheared.
  Data moved;
  moved.elements = 1;
  moved.section = {10.0, 5.0, 1.0, 1.0, 1.0};
  moved.supports[0] = {true, true, {}};
  moved.supports[1].displacement[0] = Motion{0.1, 1.0};
  const PlanarBeam<2> beam(moved);
  const StaticPath path = follow_equilibrium(*beam.statics());
  REQUIRE(path.status == Status::ok);
  const auto state = beam.restore(path.points.back().state);
  CHECK(std::abs(state.u[beam.unknowns() - 3] - 0.1) <= 1e-15);
  for (int k = 0; k < beam.point_count(); ++k) CHECK(std::abs(state.strain[3 * k] - 0.1) <= 1e-13);
  // What is not held has no equilibrium to look for.
  Data loose = soft_beam(2);
  loose.supports[0].rotation = false;
  CHECK_FALSE(PlanarBeam<1>(loose).statics()->refusal().empty());
  loose.supports[0].spring = 1.0;
  CHECK(PlanarBeam<1>(loose).statics()->refusal().empty());
  loose.supports[0] = {};
  loose.supports[0].place = loose.supports[1].place = true;
  CHECK(PlanarBeam<1>(loose).statics()->refusal().empty());
  loose.supports[0].slide = loose.supports[1].slide = 0;
  CHECK_FALSE(PlanarBeam<1>(loose).statics()->refusal().empty());
}

TEST_CASE("planar beam: a follower's flutter load", "[planar_beam]") {
  // M. Beck, Z. angew. Math. Phys. 3 (1952) 225-228: a cantilever pushed by a force that follows its tip
  // flutters from P L^2/EI = 20.0509 on; a dead one buckles at pi^2/4.
  const auto modes = [](double push, bool follower) {
    Data data;
    data.elements = 8;
    data.section = {1e6, 1e6, 1.0, 1.0, 1e-5};
    data.supports[0] = {true, true, {}};
    data.loads = {{planar_beam::Place::end, {-push, 0.0}, 0.0, planar_beam::Profile::constant, 0.0}};
    data.loads[0].follower = follower;
    const PlanarBeam<3> beam(data);
    const StaticPath path = follow_equilibrium(*beam.statics());
    REQUIRE(path.status == Status::ok);
    const auto ode = beam.ode();
    const int n = ode.size() / 2;
    std::vector<double> y(2 * n), J(4 * n * n);
    ode.pack(0.0, beam.restore(path.points.back().state), y.data());
    ode.jacobian(0.0, y.data(), J.data());
    const Eigen::MatrixXd A = -Eigen::Map<Eigen::MatrixXd>(J.data(), 2 * n, 2 * n).bottomLeftCorner(n, n);
    // The smallest square of a frequency, and the largest imaginary part among those of bending.
    double least = std::numeric_limits<double>::infinity(), imaginary = 0.0;
    for (const auto& value : eigenvalues(A)) {
      least = std::min(least, value.real());
      if (std::abs(value) < 1e3) imaginary = std::max(imaginary, std::abs(value.imag()));
    }
    return std::pair{least, imaginary};
  };
  CHECK(modes(20.0, true).second <= 1e-3);
  CHECK(modes(20.0, true).first > 1.0);
  CHECK(modes(20.1, true).second >= 1.0);
  CHECK(modes(2.46, false).first > 0.0);
  CHECK(modes(2.48, false).first < 0.0);
}

TEST_CASE("planar beam: Timoshenko's lowest frequency of a clamped beam", "[planar_beam]") {
  // Of the equations linearised at rest.
  const auto lowest = [](Data data, int elements) {
    data.elements = elements;
    data.supports[0] = {true, true, {}};
    const PlanarBeam<4> beam(data);
    const int n = static_cast<int>(beam.free().size());
    const auto form = beam.ode();
    std::vector<double> y(form.size(), 0.0), J(static_cast<std::size_t>(form.size()) * form.size());
    form.jacobian(10.0, y.data(), J.data());
    const Eigen::MatrixXd A = -Eigen::Map<Eigen::MatrixXd>(J.data(), 2 * n, 2 * n).bottomLeftCorner(n, n);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& value : eigenvalues(A)) least = std::min(least, value.real());
    return std::sqrt(least);
  };
  Data spin_up = flying_beam(12, 1.4e4);
  spin_up.section = {2.8e7, 1e7, 1.4e4, 1.2, 6e-4};
  for (auto& [data, expected] :
       {std::pair{flying_beam(12, 500.0), 0.646852}, std::pair{flying_beam(12, 100.0), 0.289403},
        std::pair{flying_beam(12, 1000.0), 0.914306}, std::pair{spin_up, 3.797563}}) {
    const double coarse = lowest(data, 4), fine = lowest(data, 8);
    INFO(fine << " and " << coarse);
    CHECK(std::abs(fine - expected) <= 1e-6);
    CHECK(std::abs(fine - coarse) <= 1e-6);
  }
}
