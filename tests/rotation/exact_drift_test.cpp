// The exact motion of the free body by steps, against its closed form in extended precision.

#include "integrators/rotation/exact_drift.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "models/rigid_body/exact_free_top.hpp"
#include "models/rigid_body/state.hpp"
#include "tests/catch.hpp"

using namespace gnomon;
using rotation::ExactDrift;
using rotation::Quaternion;

namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();

double angle_between(const Quaternion& a, const Quaternion& b) {
  const Quaternion relative = a.conjugate() * b;
  return 2.0 * std::atan2(relative.vec().norm(), std::abs(relative.w()));
}

Quaternion closed_form(const Vector3& inertia, const Vector3& m, double tau) {
  using Real = long double;
  const rigid_body::ExactFreeTop<Real> top(inertia.cast<Real>(), Eigen::Quaternion<Real>::Identity(),
                                           m.cast<Real>());
  return top.at(Real(tau)).orientation.normalized().cast<double>();
}

struct FreeBody {
  Vector3 inertia, momentum;
};

// In every order of the axes: asymmetric, symmetric, nearly so, spheres; momenta in any direction, along the
// axes and planes, and close to the separatrix.
std::vector<FreeBody> bodies() {
  std::mt19937_64 generator(11);
  const auto uniform = [&] { return 2.0 * static_cast<double>(generator() >> 11) * 0x1p-53 - 1.0; };
  std::vector<FreeBody> list;
  for (Vector3 I : {Vector3(0.6, 0.8, 1.0), Vector3(1.0, 1.0, 3.0), Vector3(1.0, 3.0, 3.0),
                    Vector3(2.0, 2.0, 2.0), Vector3(1.0, 1.0 + 1e-9, 2.0), Vector3(1.0, 2.0 - 1e-9, 2.0),
                    Vector3(1.0, 1.001, 50.0), Vector3(1e-3, 2.0, 2.1)}) {
    std::sort(I.data(), I.data() + 3);
    do {
      for (int k = 0; k < 6; ++k) list.push_back({I, Vector3(uniform(), uniform(), uniform())});
      for (int k = 0; k < 3; ++k) {
        list.push_back({I, uniform() * Vector3::Unit(k)});
        Vector3 in_plane(uniform(), uniform(), uniform());
        in_plane[k] = 0.0;
        list.push_back({I, in_plane});
        list.push_back({I, Vector3::Unit(k) + 1e-7 * Vector3(uniform(), uniform(), uniform())});
      }
    } while (std::next_permutation(I.data(), I.data() + 3));
  }
  return list;
}

}  // namespace

TEST_CASE("schemes: the exact drift is the closed form", "[rotation][exact_drift]") {
  double worst = 0.0, wrong = std::numeric_limits<double>::max();
  for (const FreeBody& body : bodies()) {
    const ExactDrift drift(body.inertia);
    // No rate of the motion is greater than this one: near the separatrix rounding grows by exp(rate tau).
    const double rate = body.momentum.norm() / body.inertia.minCoeff();
    for (double turned : {1e-9, 1e-3, 0.1, -0.7, 3.0}) {
      const double tau = turned / rate;
      Quaternion by;
      REQUIRE(drift.turn(body.momentum, tau, by) == Status::ok);
      const double error = angle_between(by, closed_form(body.inertia, body.momentum, tau));
      INFO("inertia " << body.inertia.transpose() << ", momentum " << body.momentum.transpose() << ", turned "
                      << turned << ", error " << error);
      // Relative to the turn, down to what the closed form in extended precision is good for.
      CHECK(error <= 40.0 * rounding * std::abs(turned) + 2e-18);
      worst = std::max(worst, error);
      if (std::abs(turned) > 0.05) {
        REQUIRE(drift.turn(body.momentum, tau * (1.0 + 1e-6), by) == Status::ok);
        wrong = std::min(wrong, angle_between(by, closed_form(body.inertia, body.momentum, tau)));
      }
    }
  }
  CHECK(worst >= 0.1 * rounding);  // the comparison is not blind
  CHECK(wrong >= 1e-11);
}

TEST_CASE("schemes: the exact drift over long steps and short ones", "[rotation][exact_drift]") {
  const Vector3 inertia(0.6, 0.8, 1.0), m(1.8, 0.4, -0.9);
  ExactDrift drift(inertia);
  Quaternion by;
  for (double tau : {50.0, -200.0}) {
    REQUIRE(drift.turn(m, tau, by) == Status::ok);
    const double error = angle_between(by, closed_form(inertia, m, tau)),
                 turned = m.norm() / 0.6 * std::abs(tau);
    INFO("error " << error << " over " << turned << " rad");
    CHECK(error <= 8.0 * rounding * turned);
    CHECK(error >= 0.01 * rounding * turned);
  }
  // Pieces of any length make the whole.
  Quaternion whole = Quaternion::Identity();
  Vector3 now = m;
  for (double tau : {0.3, -0.1, 1.7, 0.01, 2.0}) {
    REQUIRE(drift.turn(now, tau, by) == Status::ok);
    whole = whole * by;
    now = by.conjugate() * now;
  }
  REQUIRE(drift.turn(m, 3.91, by) == Status::ok);
  CHECK(angle_between(by, whole) <= 2e-14);
  CHECK(std::abs(by.norm() - 1.0) <= 4.0 * rounding);

  REQUIRE(drift.turn(Vector3::Zero(), 1.0, by) == Status::ok);
  CHECK(by.coeffs() == Quaternion::Identity().coeffs());
  CHECK(drift.turn(m, 1e9, by) == Status::ok);
  CHECK(angle_between(by, closed_form(inertia, m, 1e9)) <= 1e-5);
  CHECK(drift.turn(m, 1e13, by) == Status::diverged);
  for (int k = 0; k < 3; ++k) {
    Vector3 wrong = m;
    wrong[k] = std::numeric_limits<double>::quiet_NaN();
    CHECK(drift.turn(wrong, 0.1, by) == Status::diverged);
    wrong[k] = std::numeric_limits<double>::infinity();
    CHECK(drift.turn(wrong, 0.1, by) == Status::diverged);
  }
}

TEST_CASE("schemes: the exact drift is exact at steps of any length", "[rotation][exact_drift]") {
  const FreeBody bodies[] = {{{1.0, 2.0, 3.0}, {0.3, -4.0, 0.3}},
                             {{0.81, 0.68, 0.14}, {0.08, 3.4, 0.014}},  // both close to the unstable axis
                             {{0.6, 0.8, 1.0}, {1.8, 0.4, -0.9}}};
  const auto energy = [](const FreeBody& body, const Vector3& m) {
    return m.dot(m.cwiseQuotient(body.inertia));
  };
  for (const FreeBody& body : bodies) {
    const ExactDrift drift(body.inertia);
    for (double step : {1.0, 3.0, 10.0, 100.0, 300.0, 1000.0}) {
      const double turned = body.momentum.cwiseQuotient(body.inertia).norm() * step;
      const Quaternion truth = closed_form(body.inertia, body.momentum, step);
      Quaternion by;
      REQUIRE(drift.turn(body.momentum, step, by) == Status::ok);
      const double change = energy(body, by.conjugate() * body.momentum) / energy(body, body.momentum) - 1.0;
      INFO("inertia " << body.inertia.transpose() << ", step " << step << ", energy " << change);
      CHECK(angle_between(by, truth) <= 8.0 * rounding * (1.0 + turned));
      CHECK(std::abs(change) <= 16.0 * rounding);
      REQUIRE(drift.turn(body.momentum, step * (1.0 + 1e-12), by) == Status::ok);
      CHECK(angle_between(by, truth) >= 1e-13 * turned);
    }
  }
  // Steps in a row start from rounded momenta, which puts the energy off and with it the rates.
  const FreeBody& body = bodies[2];
  const ExactDrift drift(body.inertia);
  for (double step : {1.0, 10.0, 100.0}) {
    Quaternion q = Quaternion::Identity(), by;
    for (double t = 0.0; t < 1000.0; t += step) {
      REQUIRE(drift.turn(q.conjugate() * body.momentum, step, by) == Status::ok);
      q = (q * by).normalized();
    }
    const double change = energy(body, q.conjugate() * body.momentum) / energy(body, body.momentum) - 1.0;
    INFO("step " << step << ", energy " << change);
    CHECK(angle_between(q, closed_form(body.inertia, body.momentum, 1000.0)) <= 1e-10);
    CHECK(std::abs(change) <= 200.0 * rounding);
  }
}
