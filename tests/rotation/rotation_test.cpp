#include "integrators/rotation/rotation.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;
using rotation::Rotation;
using rotation::Sinc;
using rotation::sinc;

namespace {

using Real = long double;
using Vector3L = Eigen::Matrix<Real, 3, 1>;
using Matrix3L = Eigen::Matrix<Real, 3, 3>;
constexpr double eps = std::numeric_limits<double>::epsilon();
const double pi = std::acos(-1.0);

struct SincL {
  Real sine, versine;
};

// The same from the exact square. sin(x)/x and (1 - cos x)/x^2 below 1e-3 by their first terms, whose
// remainders are below 1e-22.
SincL exact_sinc(double square) {
  const Real s = square;
  if (s < 1e-6L) return {1 - s / 6 + s * s / 120 - s * s * s / 5040, 0.5L - s / 24 + s * s / 720};
  const Real x = std::sqrt(s), half = std::sin(x / 2);
  return {std::sin(x) / x, 2 * half * half / s};
}

// Distance in units of the last place of the exact value.
double ulps(double value, Real exact) {
  const double rounded = std::abs(static_cast<double>(exact));
  const double unit = std::nextafter(rounded, 2 * rounded) - rounded;
  return static_cast<double>(std::abs(static_cast<Real>(value) - exact)) / unit;
}

// exp(hat p) through the unit quaternion, in long double.
Matrix3L exact_rotation(const Vector3& p) {
  const Vector3L v = p.cast<Real>();
  const Real angle = std::sqrt(v.squaredNorm());
  const Real factor = angle > 0 ? std::sin(angle / 2) / angle : 0.5L;
  Eigen::Quaternion<Real> q;
  q.w() = std::cos(angle / 2);
  q.vec() = factor * v;
  return q.toRotationMatrix();
}

// Rotation vectors of every size, random directions.
std::vector<Vector3> rotation_vectors() {
  std::mt19937_64 generator(7);
  const auto uniform = [&] { return 2.0 * static_cast<double>(generator() >> 11) * 0x1p-53 - 1.0; };
  std::vector<double> angles{0.0,
                             1e-300,
                             1e-160,
                             1e-154,
                             1e-20,
                             1e-8,
                             1e-4,
                             0.1,
                             std::nextafter(1.0, 0.0),
                             1.0,
                             std::nextafter(1.0, 2.0),
                             2.0,
                             3.0,
                             pi - 1e-8,
                             pi,
                             pi + 1e-8,
                             6.0,
                             2 * pi - 1e-8,
                             2 * pi,
                             2 * pi + 1e-8,
                             100.0,
                             1e4};
  for (int k = 0; k < 2000; ++k) angles.push_back(4.0 * pi * std::abs(uniform()));
  for (int k = 0; k < 2000; ++k) angles.push_back(std::pow(10.0, 6.0 * uniform() - 5.0));
  std::vector<Vector3> vectors;
  for (double angle : angles) {
    const Vector3 direction = Vector3(uniform(), uniform(), uniform()).normalized();
    vectors.push_back(angle * direction);
    for (int k = 0; k < 3 && vectors.size() < 200; ++k) vectors.push_back(angle * Vector3::Unit(k));
  }
  return vectors;
}

}  // namespace

TEST_CASE("schemes: sinc is exact to rounding up to the limit of the polynomials", "[rotation]") {
  CHECK(sinc(0.0).sine == 1.0);
  CHECK(sinc(0.0).versine == 0.5);
  for (double tiny : {0x1p-1074, 1e-300, 1e-40, 1e-20, 1e-17}) {
    CHECK(sinc(tiny).sine == 1.0);
    CHECK(sinc(tiny).versine == 0.5);
  }
  std::mt19937_64 generator(1);
  double worst = 0.0;
  for (int k = 0; k < 100000; ++k) {
    const double x = static_cast<double>(generator() >> 11) * 0x1p-53;
    const double square = k % 2 == 0 ? sinc_limit * x : std::pow(x, 8.0);
    const Sinc value = sinc(square);
    const SincL exact = exact_sinc(square);
    worst = std::max({worst, ulps(value.sine, exact.sine), ulps(value.versine, exact.versine)});
  }
  CHECK(worst <= 2.0);
  CHECK(worst >= 0.5);  // the comparison is not blind
}

TEST_CASE("schemes: sinc has no visible branch", "[rotation]") {
  // A few hundred neighbouring doubles on both sides of the switch from the polynomials to the half angle.
  double square = sinc_limit;
  for (int k = 0; k < 200; ++k) square = std::nextafter(square, 0.0);
  Sinc before = sinc(square);
  for (int k = 0; k < 400; ++k, square = std::nextafter(square, 2.0)) {
    const Sinc value = sinc(square);
    const SincL exact = exact_sinc(square);
    CHECK(ulps(value.sine, exact.sine) <= 4.0);
    CHECK(ulps(value.versine, exact.versine) <= 4.0);
    CHECK(std::abs(value.sine - before.sine) <= 2.0 * eps);
    CHECK(std::abs(value.versine - before.versine) <= 2.0 * eps);
    before = value;
  }
}

TEST_CASE("schemes: sinc at large angles", "[rotation]") {
  // The square of the angle is rounded to a double, so sin and cos may be off by eps times the angle.
  for (int k = 1; k < 4000; ++k) {
    for (double x : {0.01 * k, k * pi, k * pi * (1.0 + 1e-9), 1e4 * k + 0.3}) {
      const double square = x * x;
      if (square <= sinc_limit) continue;
      const Sinc value = sinc(square);
      const SincL exact = exact_sinc(square);
      CHECK(std::abs(static_cast<double>(value.sine - exact.sine)) * x <= eps * (1.0 + x));
      CHECK(std::abs(static_cast<double>(value.versine - exact.versine)) * square <= eps * (2.0 + x));
    }
  }
}

TEST_CASE("schemes: rotations against long double", "[rotation]") {
  std::mt19937_64 generator(3);
  const auto uniform = [&] { return 2.0 * static_cast<double>(generator() >> 11) * 0x1p-53 - 1.0; };
  // In units of eps, up to one radian and above. There |p|^2 is rounded before sin and cos are taken of its
  // root, which costs up to eps times the angle of accuracy, and near pi a few eps of orthonormality.
  struct Worst {
    double error = 0.0, orthonormality = 0.0, application = 0.0, inverse = 0.0;
  } worst[2];
  const auto note = [](double& largest, const auto& m) {
    largest = std::max(largest, static_cast<double>(m.cwiseAbs().maxCoeff()) / eps);
  };
  for (const Vector3& p : rotation_vectors()) {
    const Rotation rotation(p);
    const Matrix3 R = rotation.matrix();
    REQUIRE(R.allFinite());
    Worst& w = worst[p.norm() <= 1.0 ? 0 : 1];
    const Vector3 a(uniform(), uniform(), uniform());
    note(w.error, (R.cast<Real>() - exact_rotation(p)) / static_cast<Real>(1.0 + p.norm()));
    note(w.orthonormality, R.transpose() * R - Matrix3::Identity());
    note(w.application, rotation(a) - R * a);
    note(w.application, rotation.inverse(a) - R.transpose() * a);
    note(w.inverse, rotation.inverse(rotation(a)) - a);
  }
  CHECK(worst[0].error <= 1.5);
  CHECK(worst[0].error >= 0.3);  // the comparison is not blind
  CHECK(worst[0].orthonormality <= 4.0);
  CHECK(worst[0].application <= 4.0);
  CHECK(worst[0].inverse <= 4.0);
  CHECK(worst[1].error <= 1.5);
  CHECK(worst[1].orthonormality <= 10.0);
  CHECK(worst[1].application <= 6.0);
  CHECK(worst[1].inverse <= 12.0);
}

TEST_CASE("schemes: small rotations keep their relative accuracy", "[rotation]") {
  // What a rotation changes of a vector is p x a, to rounding of that change and not of the vector.
  for (double angle : {1e-300, 1e-160, 1e-20, 1e-12, 1e-8}) {
    const Vector3 p = angle * Vector3(0.36, 0.48, 0.8), a(0.0, 0.0, 1.0);
    const Vector3 change = Rotation(p)(a) - a;
    CHECK(std::abs(change[0] / (angle * 0.48) - 1.0) <= 4.0 * eps + angle);
    CHECK(std::abs(change[1] / (-angle * 0.36) - 1.0) <= 4.0 * eps + angle);
    CHECK(std::abs(Rotation(p).matrix()(0, 2) / (angle * 0.48) - 1.0) <= 4.0 * eps + angle);
  }
  CHECK(Rotation(Vector3::Zero()).matrix() == Matrix3::Identity());
}

TEST_CASE("schemes: a body at rest", "[rotation]") {
  const Catalogue catalogue = full_catalogue();
  RunSpec spec;
  spec.t_end = 3.0;
  spec.step = 0.1;
  const Eigen::Vector3d inertia(1.0, 2.0, 3.0);
  const BodyState rest{Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 2) / 3.0).toRotationMatrix(),
                       Eigen::Vector3d::Zero()};
  const auto is_free = box(RigidBody<Free>(inertia, rest, {}, spec.t_end));
  const auto pushed = box(RigidBody<SpaceMoment>(inertia, rest, {{0.2, 0.1, -0.3}}, spec.t_end));
  const auto hanging = box(
      RigidBody<Gravity>(inertia, {Eigen::Matrix3d::Identity(), {0, 0, 0}}, {1.0, {0, 0, -1}}, spec.t_end));
  const auto reference = pushed->reference({spec.t_end});
  REQUIRE(reference.kind == "certified");
  for (const SchemeInfo& info : schemes(catalogue, Stepping::fixed)) {
    if (!catalogue.pair(info.name, *pushed)) continue;
    INFO(info.name);
    // Without a moment, and in a stable equilibrium, nothing moves, to the last bit.
    for (const auto& model : {is_free, hanging}) {
      const RunResult result = run_scheme(catalogue, info.name, *model, spec);
      CHECK(result.status == Status::ok);
      RunSpec one = spec;
      one.max_steps = 0;
      CHECK(result.state == run_scheme(catalogue, info.name, *model, one).state);
    }
    const RunResult result = run_scheme(catalogue, info.name, *pushed, spec);
    CHECK(result.status == Status::ok);
    REQUIRE(all_finite(result.state));
    const auto error = pushed->distance(result.state, reference.states.back());
    // The motion turns by about 1 rad. Its direction of H is constant, so that kicks by the moment and drifts
    // follow it as exactly as the drifts are.
    const double drift_order = info.order_for("none").value_or(100.0);
    CHECK(error[0] <= (drift_order >= 8.0 ? 1e-13 : 0.1));
    if (drift_order < 8.0) CHECK(error[0] >= (drift_order >= 6.0 ? 1e-12 : 1e-9));
    for (double value : result.invariants.values) CHECK(std::isfinite(value));
  }
}
