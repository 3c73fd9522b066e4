#pragma once
// Reference integrator for tests: the free rigid body in long double by its Taylor series, with no formula in
// common with the closed form.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace gnomon::tests {

using Vector3L = Eigen::Matrix<long double, 3, 1>;
using QuaternionL = Eigen::Quaternion<long double>;

struct FreeBodyL {
  QuaternionL orientation;
  Vector3L angular_momentum;
};

/// Solves q' = 1/2 q o (0, I^-1 m), m' = m x I^-1 m over [0, time] with series of degree 30. The step keeps
/// the last terms below 1e-21, so that roundoff (about 1e-19 per step, times the growth of perturbations) is
/// all that is left.
inline FreeBodyL integrate_free_body(const Vector3L& inertia, FreeBodyL state, long double time) {
  constexpr int degree = 30;
  using Series = std::array<long double, degree + 1>;
  const Vector3L inverse = inertia.cwiseInverse();
  std::array<Series, 4> q{};
  std::array<Series, 3> m{};
  const long double direction = time < 0 ? -1 : 1;
  for (long double left = std::abs(time); left > 0;) {
    q[0][0] = state.orientation.w();
    for (int i = 0; i < 3; ++i) {
      q[i + 1][0] = state.orientation.vec()[i];
      m[i][0] = state.angular_momentum[i];
    }
    for (int n = 0; n < degree; ++n) {
      std::array<long double, 3> dm{};
      std::array<long double, 4> dq{};
      for (int j = 0; j <= n; ++j) {
        const long double w0 = m[0][n - j] * inverse[0];
        const long double w1 = m[1][n - j] * inverse[1];
        const long double w2 = m[2][n - j] * inverse[2];
        dm[0] += m[1][j] * m[2][n - j];
        dm[1] += m[2][j] * m[0][n - j];
        dm[2] += m[0][j] * m[1][n - j];
        dq[0] -= q[1][j] * w0 + q[2][j] * w1 + q[3][j] * w2;
        dq[1] += q[0][j] * w0 + q[2][j] * w2 - q[3][j] * w1;
        dq[2] += q[0][j] * w1 + q[3][j] * w0 - q[1][j] * w2;
        dq[3] += q[0][j] * w2 + q[1][j] * w1 - q[2][j] * w0;
      }
      // (1/I3 - 1/I2) without cancellation, and so on.
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const int k = (i + 2) % 3;
        m[i][n + 1] = (inertia[j] - inertia[k]) * inverse[j] * inverse[k] * dm[i] / (n + 1);
      }
      for (int i = 0; i < 4; ++i) q[i][n + 1] = dq[i] / (2 * (n + 1));
    }

    long double step = left;
    const long double size = state.angular_momentum.norm();
    for (const int n : {degree - 1, degree}) {
      long double last = 0;
      for (const Series& s : q) last = std::max(last, std::abs(s[n]));
      for (const Series& s : m) last = std::max(last, size > 0 ? std::abs(s[n]) / size : 0.0L);
      if (last > 0) step = std::min(step, std::pow(1e-21L / last, 1.0L / n));
    }
    const auto value = [&](const Series& s) {
      long double sum = s[degree];
      for (int n = degree - 1; n >= 0; --n) sum = sum * (direction * step) + s[n];
      return sum;
    };
    state.orientation = QuaternionL(value(q[0]), value(q[1]), value(q[2]), value(q[3]));
    for (int i = 0; i < 3; ++i) state.angular_momentum[i] = value(m[i]);
    left -= step;
  }
  return state;
}

/// Angle of the rotation between two orientations [rad], accurate for small angles.
inline long double rotation_angle(const QuaternionL& p, const QuaternionL& q) {
  const QuaternionL a = p.normalized();
  const QuaternionL b = q.normalized();
  const long double distance = std::min((a.coeffs() - b.coeffs()).norm(), (a.coeffs() + b.coeffs()).norm());
  return 4 * std::asin(std::min(1.0L, distance / 2));
}

}  // namespace gnomon::tests
