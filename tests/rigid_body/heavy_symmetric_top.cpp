// The closed form of the heavy symmetric top against its Taylor series, certified solutions and steady
// precession.

#include "models/rigid_body/heavy_symmetric_top.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

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

rigid_body::HeavyTopData data_of(const TopCase& c) {
  const auto& q = c.orientation;
  const auto& m = c.momentum;
  return {c.transverse,
          c.axial,
          {c.torque, 0},
          {{{q.w(), 0}, {q.x(), 0}, {q.y(), 0}, {q.z(), 0}}},
          {m[0], m[1], m[2]}};
}

template <class Wide>
tests::HeavyTopState<long double> series_of(const TopCase& c) {
  using std::sqrt;
  tests::HeavyTopState<Wide> start;
  start.orientation = {c.orientation.w(), c.orientation.x(), c.orientation.y(), c.orientation.z()};
  Wide square = 0;
  for (const Wide& x : start.orientation) square += x * x;
  for (Wide& x : start.orientation) x /= sqrt(square);
  start.angular_momentum = {c.momentum[0], c.momentum[1], c.momentum[2]};
  const auto end =
      tests::integrate_heavy_top<Wide>(Wide(c.transverse), Wide(c.axial), Wide(c.torque), start, c.time);
  tests::HeavyTopState<long double> rounded;
  for (std::size_t k = 0; k < 4; ++k) rounded.orientation[k] = static_cast<long double>(end.orientation[k]);
  for (std::size_t k = 0; k < 3; ++k)
    rounded.angular_momentum[k] = static_cast<long double>(end.angular_momentum[k]);
  return rounded;
}

// The greater of the angle [rad] and the distance of the momenta, over the greatest, between the closed form
// in double or extended precision, taken a little later, and a Taylor series; and the bound of it.
struct Error {
  double found, bound;
};
template <class Real>
Error off_series(const TopCase& c, const tests::HeavyTopState<long double>& series, double later = 0.0) {
  const rigid_body::HeavySymmetricTop<Real> top(data_of(c));
  const auto state = top.at(Real(c.time + later));
  const auto& q = series.orientation;
  const Eigen::Quaternion<long double> relative =
      state.orientation.template cast<long double>().normalized().conjugate() *
      Eigen::Quaternion<long double>(q[0], q[1], q[2], q[3]).normalized();
  const long double angle = 2 * std::atan2(relative.vec().norm(), std::abs(relative.w()));
  const auto& m = series.angular_momentum;
  const long double momentum = (state.angular_momentum.template cast<long double>() -
                                Eigen::Matrix<long double, 3, 1>(m[0], m[1], m[2]))
                                   .norm();
  return {static_cast<double>(std::max(angle, momentum / static_cast<long double>(top.momentum_size()))),
          static_cast<double>(top.error_bound(Real(c.time)))};
}
template <class Real>
double against_series(const TopCase& c, double later = 0.0) {
  return off_series<Real>(c, series_of<long double>(c), later).found;
}

}  // namespace

TEST_CASE("rigid body: four hundred random heavy symmetric tops", "[rigid_body][closed_form]") {
  std::mt19937_64 generator(7);
  const auto uniform = [&] { return 2.0 * static_cast<double>(generator() >> 11) * 0x1p-53 - 1.0; };
  double worst = 0.0, worst_double = 0.0, least_later = 1.0, of_bound = 0.0, of_bound_double = 0.0;
  for (int k = 0; k < 400; ++k) {
    TopCase c{"random", std::exp(2.0 * uniform()), 0.0, 0.0, {}, {}, 0.0};
    c.axial = c.transverse * (0.05 + 0.95 * (uniform() + 1.0));
    c.torque = std::exp(2.0 * uniform());
    const double w = uniform(), x = uniform(), y = uniform(), z = uniform();
    c.orientation = Eigen::Quaternion<long double>(w, x, y, z).normalized();
    const double unit = std::sqrt(c.torque * c.transverse), size = unit * std::exp(2.5 * uniform());
    for (int i = 0; i < 3; ++i) c.momentum[i] = size * uniform();
    c.time = 10.0 * uniform() * std::sqrt(c.transverse / c.torque) / (1.0 + size / unit);
    const auto series = series_of<long double>(c);
    const Error error = off_series<long double>(c, series), error_double = off_series<double>(c, series);
    worst = std::max(worst, error.found);
    worst_double = std::max(worst_double, error_double.found);
    of_bound = std::max(of_bound, error.found / error.bound);
    of_bound_double = std::max(of_bound_double, error_double.found / error_double.bound);
    if (k < 20) least_later = std::min(least_later, against_series<long double>(c, 1e-9 * c.time));
  }
  INFO("extended precision " << worst << ", double " << worst_double << ", later " << least_later);
  CHECK(worst <= 2e-16);
  CHECK(worst >= 1e-18);
  CHECK(worst_double <= 2e-13);
  CHECK(worst_double >= 1e-15);
  CHECK(least_later >= 1e-11);
  // The bounds hold and are no empty promise.
  CHECK(of_bound <= 1.0);
  CHECK(of_bound >= 0.02);
  CHECK(of_bound_double <= 1.0);
  CHECK(of_bound_double >= 0.02);
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

TEST_CASE("rigid body: heavy symmetric tops near the separatrix", "[rigid_body][closed_form][long]") {
  // The pendulum that reaches the upper vertical in infinite time passes the lower one at the rate
  // 2 sqrt(torque/I1). With a little more momentum, or a little spin, it passes the vertical or turns, again
  // and again; k1^2 is about that little, by which extended precision is lost in a series each time.
  using tests::Quadruple;
  std::vector<TopCase> cases;
  const Eigen::Quaternion<long double> hanging(0, 1, 0, 0), slanting(0.5L, 0.5L, 0.5L, 0.5L);
  for (double d : {1e-1, 1e-4, 1e-8, 1e-12}) {
    cases.push_back({"with spin, a pass", 5, 1, 20, hanging, {20, 0, d}, 5});
    cases.push_back({"with spin, many", 5, 1, 20, hanging, {20, 0, d}, 30});
    cases.push_back({"over the top", 5, 1, 20, hanging, {20 * (1 + d), 0, 0}, 20});
    cases.push_back({"not over the top", 5, 1, 20, hanging, {20 * (1 - d), 0, 0}, -20});
    for (int k : {0, 2}) {
      TopCase c{"from the side", 1, 0.5, 1, slanting, {1, 1, 1}, 15};
      c.momentum[k] += d;
      cases.push_back(c);
    }
  }
  cases.push_back({"pendulum", 5, 1, 20, hanging, {20, 0, 0}, 15});
  double of_bound = 0.0, of_bound_double = 0.0;
  for (const TopCase& c : cases) {
    const auto series = series_of<Quadruple>(c);
    const Error error = off_series<long double>(c, series), error_double = off_series<double>(c, series);
    INFO(c.name << ", momentum " << c.momentum.transpose() << ": " << error.found << " of " << error.bound
                << ", double " << error_double.found << " of " << error_double.bound);
    CHECK(error.found <= error.bound);
    CHECK(error.bound <= 3e-16);
    CHECK(error_double.found <= error_double.bound);
    CHECK(error_double.bound <= 6e-13);
    CHECK(error_double.found <= 4e-14);
    of_bound = std::max(of_bound, error.found / error.bound);
    of_bound_double = std::max(of_bound_double, error_double.found / error_double.bound);
  }
  CHECK(of_bound >= 0.02);
  CHECK(of_bound_double >= 0.01);
  // Such passes are far apart: a moment before the second one is told from a moment after it.
  const TopCase late{"with spin", 5, 1, 20, hanging, {20, 0, 1e-6}, 13};
  CHECK(off_series<double>(late, series_of<Quadruple>(late), 1e-9).found >= 1e-12);
}

TEST_CASE("rigid body: the bound of the heavy top on the separatrix", "[rigid_body][closed_form]") {
  // Hanging, pushed so that the square of the momentum is 4 I1 torque; it is rounded for 1/3, and then a
  // top beside the separatrix cannot be told from one on it.
  const auto pushed = [](long double m) {
    rigid_body::WideReal torque = rigid_body::detail::exact_product(m, m);
    torque = {torque.high / 4, torque.low / 4};
    return rigid_body::HeavySymmetricTop<double>(
        rigid_body::HeavyTopData{1, 0.5L, torque, {{{0, 0}, {1, 0}, {0, 0}, {0, 0}}}, {m, 0, 0}});
  };
  const auto exact = pushed(0.375L), rounded = pushed(1.0L / 3);
  CHECK(exact.complementary_modulus() == 0.0);
  CHECK(rounded.complementary_modulus() == 0.0);
  // lambda is m / (2 I1).
  const auto bound = [](const auto& top, double m, double phase) { return top.error_bound(2 * phase / m); };
  CHECK(bound(exact, 0.375, 5.0) <= 1e-13);
  CHECK(bound(exact, 0.375, 80.0) <= 1e-12);
  CHECK(bound(rounded, 1.0 / 3.0, 5.0) <= 1e-13);
  CHECK(bound(rounded, 1.0 / 3.0, 80.0) >= 1e-4);
  CHECK(bound(rounded, 1.0 / 3.0, 200.0) <= 4.01);
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
    const rigid_body::HeavySymmetricTop<double> top(data_of(c));
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

TEST_CASE("rigid body: the closed form is the reference where certification is lost",
          "[rigid_body][closed_form]") {
  // A pendulum that all but stops in the upper vertical, every 4 s.
  const Matrix3d hanging = Vector3d(1, -1, -1).asDiagonal();
  const HeavyTop top(Vector3d(5, 5, 1), {hanging, {20.0000002, 0, 0}}, {20.0, {0, 0, 1}}, 20.0);
  CHECK(gnomon::detail::certified_states<HeavyTop, long double>(top, {20.0}, 50'000'000).kind.empty());
  const std::vector<double> times{5.0, 20.0};
  const ReferenceStates reference = reference_states(top, times);
  CHECK(reference.kind == "analytic");
  REQUIRE(reference.states.size() == 2);
  const TopCase c{"pendulum", 5, 1, 20, {0, 1, 0, 0}, {20.0000002, 0, 0}, 0};
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK(std::max(reference.bounds[k][0], reference.bounds[k][1]) <= 3e-15);
    TopCase at = c;
    at.time = times[k];
    const auto series = series_of<tests::Quadruple>(at);
    const auto& q = series.orientation;
    const Eigen::Quaternion<long double> exact(q[0], q[1], q[2], q[3]);
    const auto& m = series.angular_momentum;
    const BodyState expected{exact.normalized().cast<double>().toRotationMatrix(),
                             Eigen::Matrix<long double, 3, 1>(m[0], m[1], m[2]).cast<double>()};
    CHECK(apart(top, top.restore(reference.states[k]), expected) <= reference.bounds[k][0]);
  }
  // Where certification holds it stays.
  CHECK(reference_states(top, {3.0}).kind == "certified");
  const HeavyTop other(Vector3d(5, 4, 1), {hanging, {20.0000002, 0, 0}}, {20.0, {0, 0, 1}}, 20.0);
  CHECK(!other.exact_if_known(1.0));
}

TEST_CASE("rigid body: the axes of a heavy symmetric top are any of the body's",
          "[rigid_body][closed_form]") {
  const Matrix3d attitude = AngleAxisd(2.0, Vector3d(1, 2, 2) / 3.0).toRotationMatrix();
  const std::vector<double> times{0.3, 2.0};
  for (int axis = 0; axis < 3; ++axis)
    for (double height : {0.7, -0.7}) {
      Vector3d inertia = Vector3d::Ones(), centre = Vector3d::Zero();
      inertia[axis] = 0.3;
      centre[axis] = height;
      const HeavyTop top(inertia, {attitude, {1, 0.3, -0.4}}, {2.0, centre}, 1.0);
      const ReferenceStates certified =
          gnomon::detail::certified_states<HeavyTop, long double>(top, times, 50'000'000);
      REQUIRE(certified.kind == "certified");
      for (std::size_t k = 0; k < times.size(); ++k) {
        const auto exact = top.exact_if_known(times[k]);
        REQUIRE(exact);
        const BodyState expected = top.restore(certified.states[k]);
        INFO(axis << ", " << height << ": " << apart(top, exact->state, expected));
        CHECK(apart(top, exact->state, expected) <= 1e-15);
        CHECK(apart(top, top.symmetric_top(times[k]), expected) <= 1e-14);
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
