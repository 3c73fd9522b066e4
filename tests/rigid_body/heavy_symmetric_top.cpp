// The closed form of the heavy symmetric top against its Taylor series, certified solutions and steady
// precession.

#include "models/rigid_body/heavy_symmetric_top.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "src/study/study.hpp"
#include "tests/catch.hpp"
#include "tests/rigid_body/heavy_top_taylor.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;
using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

using HeavyTop = RigidBody<Gravity>;

double apart(const HeavyTop& body, const BodyState& a, const BodyState& b) {
  const auto d = body.distance(a, b);
  return std::max(d[0], d[1]);
}

struct TopCase {
  const char* name;
  double transverse, axial, torque;
  Eigen::Quaternion<long double> orientation;
  Eigen::Matrix<long double, 3, 1> momentum;
  double time;
};

Eigen::Quaternion<long double> inclined(long double angle) {
  return {std::cos(angle / 2), std::sin(angle / 2), 0, 0};
}

// The greater of the angle [rad] and the relative distance of the momenta between the closed form in double
// or extended precision, taken a little later, and the Taylor series.
template <class Real>
double against_series(const TopCase& c, double later = 0.0) {
  const rigid_body::HeavySymmetricTop<Real> top(c.transverse, c.axial, c.torque, c.orientation.cast<Real>(),
                                                c.momentum.cast<Real>());
  const auto state = top.at(Real(c.time + later));
  const auto series =
      tests::integrate_heavy_top(c.transverse, c.axial, c.torque, {c.orientation, c.momentum}, c.time);
  const Eigen::Quaternion<long double> relative =
      state.orientation.template cast<long double>().conjugate() * series.orientation.normalized();
  const long double angle = 2 * std::atan2(relative.vec().norm(), std::abs(relative.w()));
  const long double unit = std::sqrt(static_cast<long double>(c.torque * c.transverse));
  const long double momentum =
      (state.angular_momentum.template cast<long double>() - series.angular_momentum).norm();
  return static_cast<double>(std::max(angle, momentum / std::max(c.momentum.norm(), unit)));
}

}  // namespace

TEST_CASE("rigid body: four hundred random heavy symmetric tops", "[rigid_body][closed_form]") {
  std::mt19937_64 generator(7);
  const auto uniform = [&] { return 2.0 * static_cast<double>(generator() >> 11) * 0x1p-53 - 1.0; };
  double worst = 0.0, worst_double = 0.0, least_later = 1.0;
  for (int k = 0; k < 400; ++k) {
    TopCase c{"random", std::exp(2.0 * uniform()), 0.0, 0.0, {}, {}, 0.0};
    c.axial = c.transverse * (0.05 + 0.95 * (uniform() + 1.0));
    c.torque = std::exp(2.0 * uniform());
    const double w = uniform(), x = uniform(), y = uniform(), z = uniform();
    c.orientation = Eigen::Quaternion<long double>(w, x, y, z).normalized();
    const double unit = std::sqrt(c.torque * c.transverse), size = unit * std::exp(2.5 * uniform());
    for (int i = 0; i < 3; ++i) c.momentum[i] = size * uniform();
    c.time = 10.0 * uniform() * std::sqrt(c.transverse / c.torque) / (1.0 + size / unit);
    worst = std::max(worst, against_series<long double>(c));
    worst_double = std::max(worst_double, against_series<double>(c));
    if (k < 20) least_later = std::min(least_later, against_series<long double>(c, 1e-9 * c.time));
  }
  INFO("extended precision " << worst << ", double " << worst_double << ", later " << least_later);
  CHECK(worst <= 2e-16);
  CHECK(worst >= 1e-18);
  CHECK(worst_double <= 2e-13);
  CHECK(worst_double >= 1e-15);
  CHECK(least_later >= 1e-11);
}

TEST_CASE("rigid body: heavy symmetric tops that are or become vertical", "[rigid_body][closed_form]") {
  const auto upright = inclined(0);
  const Eigen::Quaternion<long double> hanging(0, 1, 0, 0);
  const TopCase cases[] = {
      {"sleeping, stable", 5, 1, 20, upright, {0, 0, 50}, 3},
      {"sleeping, unstable", 5, 1, 20, upright, {0, 0, 3}, 3},
      {"sleeping, critical", 5, 1, 20, upright, {0, 0, 20}, 3},
      {"nearly sleeping, stable", 5, 1, 20, inclined(1e-6L), {0, 0, 50}, 3},
      {"nearly sleeping, unstable", 5, 1, 20, inclined(1e-3L), {0, 0, 3}, 3},
      {"nearly sleeping, critical", 5, 1, 20, inclined(1e-3L), {0, 0, 20}, 3},
      {"from the upper vertical, fast", 5, 1, 20, upright, {1, 2, 50}, 3},
      {"from the upper vertical, slow", 5, 1, 20, upright, {1, 2, 3}, 3},
      {"from near the upper vertical", 5, 1, 20, inclined(1e-8L), {1, 2, 50}, 3},
      {"from very near the upper vertical", 5, 1, 20, inclined(1e-16L), {1, 2, 50}, 3},
      {"hanging", 5, 1, 20, hanging, {0, 0, 3}, 3},
      {"from the lower vertical", 5, 1, 20, hanging, {3, 1, 3}, 3},
      {"from the lower vertical, backwards", 5, 1, 20, hanging, {3, 1, 3}, -3},
      {"pendulum", 5, 1, 20, inclined(1), {0, 0, 0}, 3},
      {"pendulum with a push", 5, 1, 20, inclined(0.6L), {5, 0, 0}, 3},
      {"pendulum from almost the top", 5, 1, 20, inclined(1e-3L), {0, 0, 0}, 3},
      {"pendulum over the top", 5, 1, 20, inclined(1), {40, 0, 0}, 3},
      {"pendulum over the top from below", 5, 1, 20, hanging, {30, 1, 0}, 3},
  };
  for (const TopCase& c : cases) {
    INFO(c.name << ": " << against_series<long double>(c));
    CHECK(against_series<long double>(c) <= 2e-15);
  }
}

TEST_CASE("rigid body: heavy symmetric tops near the separatrix", "[rigid_body][closed_form]") {
  // The pendulum that reaches the upper vertical in infinite time passes the lower one at the rate
  // 2 sqrt(torque/I1). With a little spin, and from a place beside that, it comes close.
  const Eigen::Quaternion<long double> hanging(0, 1, 0, 0), beside = hanging * inclined(0.1L);
  for (double d : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 0.0, -1e-12, -1e-8, -1e-4, -1e-2}) {
    const long double m = 20.0L * (1.0L + d);
    const TopCase planar{"planar", 5, 1, 20, hanging, {m, 0, 0}, 3};
    const TopCase spinning{"spinning", 5, 1, 20, beside, {m, 0.001L, 0.5L}, 3};
    INFO("distance " << d << ": " << against_series<long double>(planar) << ", "
                     << against_series<long double>(spinning));
    CHECK(against_series<long double>(planar) <= 1e-15);
    CHECK(against_series<long double>(spinning) <= 2e-14);
    CHECK(against_series<long double>(spinning, 1e-9) >= 1e-11);
  }
}

TEST_CASE("rigid body: heavy symmetric tops on the separatrix", "[rigid_body][closed_form]") {
  // Lz = L3 and just the energy of rest in the upper vertical, which the axis approaches in infinite time.
  const TopCase cases[] = {
      {"from the side", 1, 0.5, 1, {0.5L, 0.5L, 0.5L, 0.5L}, {1, 1, 1}, 3},
      {"from the side, backwards", 1, 0.5, 1, {0.5L, 0.5L, 0.5L, 0.5L}, {1, 1, 1}, -3},
      {"pendulum", 5, 1, 20, {0, 1, 0, 0}, {20, 0, 0}, 3},
      {"pendulum, the other way", 5, 1, 20, {0, 0, 1, 0}, {20, 0, 0}, -2},
  };
  for (const TopCase& c : cases) {
    INFO(c.name << ": " << against_series<long double>(c) << ", double " << against_series<double>(c));
    CHECK(against_series<long double>(c) <= 2e-15);
    CHECK(against_series<double>(c) <= 2e-14);
    CHECK(against_series<double>(c, 1e-9) >= 1e-12);
    const rigid_body::HeavySymmetricTop<double> top(c.transverse, c.axial, c.torque,
                                                    c.orientation.cast<double>(), c.momentum.cast<double>());
    // The axis has arrived.
    const Eigen::Quaterniond late = top.at(1e3 * c.time).orientation;
    CHECK(std::abs(late.norm() - 1.0) <= 1e-15);
    CHECK(std::hypot(late.x(), late.y()) <= 1e-15);
  }
}

TEST_CASE("rigid body: published end state of the fast heavy top in closed form",
          "[rigid_body][closed_form]") {
  // O. Bruls, A. Cardona, M. Arnold, Mech. Mach. Theory 48 (2012) 121; good to six digits.
  const Eigen::Quaterniond published(0.1229473, -0.4910794, 0.3504308, -0.7879869);
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "fast-heavy-top");
  const auto& top = typed<HeavyTop>(scene);
  const auto off = [&](double t) {
    const Eigen::Quaterniond q(top.symmetric_top(t).attitude);
    return std::min((q.coeffs() - published.coeffs()).norm(), (q.coeffs() + published.coeffs()).norm());
  };
  CHECK(off(2.0) <= 1e-6);
  CHECK(off(2.0001) >= 1e-5);
}

TEST_CASE("rigid body: the closed form of the heavy symmetric top", "[rigid_body][closed_form]") {
  const Catalogue catalogue = full_catalogue();
  for (const char* name : {"heavy-symmetric-top", "fast-heavy-top"}) {
    const Scene scene = load_scene(catalogue, name);
    const auto& shipped = typed<HeavyTop>(scene);
    BodyState tilted = shipped.initial();
    tilted.attitude = AngleAxisd(2.0, Vector3d(1, 2, 2) / 3.0).toRotationMatrix() * tilted.attitude;
    tilted.angular_momentum += 0.3 * tilted.angular_momentum.norm() * Vector3d(0.5, -0.2, 0.7);
    Gravity hanging = shipped.load();
    hanging.centre = -hanging.centre;
    const HeavyTop tops[] = {shipped, HeavyTop(shipped.inertia(), tilted, shipped.load(), 1.0),
                             HeavyTop(shipped.inertia(), tilted, hanging, 1.0)};
    for (const HeavyTop& top : tops) {
      REQUIRE(top.symmetric_top_refusal().empty());
      CHECK(apart(top, top.symmetric_top(0.0), top.initial()) <= 4e-15);
      const std::vector<double> times{0.05, 0.4, 1.5};
      const ReferenceStates reference =
          gnomon::detail::certified_states<HeavyTop, long double>(top, times, 50'000'000);
      REQUIRE(reference.kind == "certified");
      for (std::size_t k = 0; k < times.size(); ++k) {
        const BodyState expected = top.restore(reference.states[k]);
        const double error = apart(top, top.symmetric_top(times[k]), expected);
        INFO(name << ", t = " << times[k] << ", error " << error << ", reference " << reference.bounds[k][0]
                  << ", " << reference.bounds[k][1]);
        const double rate = top.initial().angular_momentum.cwiseQuotient(top.inertia()).norm();
        CHECK(error <= 8.0 * 2.2e-16 * (10.0 + rate * times[k]));
        CHECK(apart(top, top.symmetric_top(times[k] * (1.0 + 1e-9)), expected) >= 1e-11);
      }
    }
  }
}

TEST_CASE("rigid body: the closed form in steady precession", "[rigid_body][closed_form]") {
  const double i1 = 5.0, i3 = 1.0, torque = 20.0, tilt = 1.1, precession = 0.7;
  const double w3 = (torque / precession + i1 * precession * std::cos(tilt)) / i3;
  const double spin = w3 - precession * std::cos(tilt);
  const auto exact = [&](double t) {
    const Matrix3d A = AngleAxisd(precession * t, Vector3d::UnitZ()).toRotationMatrix() *
                       AngleAxisd(tilt, Vector3d::UnitX()).toRotationMatrix() *
                       AngleAxisd(spin * t, Vector3d::UnitZ()).toRotationMatrix();
    const Vector3d w = precession * A.transpose() * Vector3d::UnitZ() + spin * Vector3d::UnitZ();
    return BodyState{A, w.cwiseProduct(Vector3d(i1, i1, i3))};
  };
  const HeavyTop top(Vector3d(i1, i1, i3), exact(0.0), {torque, {0, 0, 1}}, 1.0);
  for (double t : {0.1, 1.0, 5.0}) CHECK(apart(top, top.symmetric_top(t), exact(t)) <= 1e-13);
}

TEST_CASE("rigid body: bodies that the closed form of the top refuses", "[rigid_body][closed_form]") {
  const Catalogue catalogue = full_catalogue();
  for (const char* name : {"asymmetric-heavy-top", "kovalevskaya"}) {
    const Scene scene = load_scene(catalogue, name);
    CHECK(!typed<HeavyTop>(scene).symmetric_top_refusal().empty());
    CHECK(catalogue.pair("exact-heavy-symmetric-top", *scene.model) == nullptr);
  }
  const Vector3d inertia(5, 5, 1), m(0, 0, 3);
  const HeavyTop upright(inertia, {Matrix3d::Identity(), m}, {1.0, {0, 0, 1}}, 1.0);
  CHECK(upright.symmetric_top_refusal().empty());
  const HeavyTop weightless(inertia, {Matrix3d::Identity(), m}, {0.0, {0, 0, 1}}, 1.0);
  CHECK(!weightless.symmetric_top_refusal().empty());
}
