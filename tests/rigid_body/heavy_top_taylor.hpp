#pragma once
// Reference integrator for tests: the heavy symmetric top in long double by its Taylor series, with no
// formula in common with the closed form.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace gnomon::tests {

struct HeavyTopL {
  Eigen::Quaternion<long double> orientation;
  Eigen::Matrix<long double, 3, 1> angular_momentum;  ///< body components
};

/// Solves q' = 1/2 q o (0, w), m' = m x w + torque (g2, -g1, 0), w = (m1/I1, m2/I1, m3/I3), g the vertical in
/// the body, over [0, time] with series of degree 30; their last terms are below 1e-21.
inline HeavyTopL integrate_heavy_top(long double transverse, long double axial, long double torque,
                                     HeavyTopL state, long double time) {
  constexpr int degree = 30;
  using Series = std::array<long double, degree + 1>;
  std::array<Series, 4> q{};
  std::array<Series, 3> m{}, w{}, g{};
  const std::array<long double, 3> inertia{transverse, transverse, axial};
  const long double direction = time < 0 ? -1 : 1;
  for (long double left = std::abs(time); left > 0;) {
    q[0][0] = state.orientation.w();
    for (int i = 0; i < 3; ++i) q[i + 1][0] = state.orientation.vec()[i], m[i][0] = state.angular_momentum[i];
    g[0][0] = 2 * (q[1][0] * q[3][0] - q[0][0] * q[2][0]);
    g[1][0] = 2 * (q[2][0] * q[3][0] + q[0][0] * q[1][0]);
    g[2][0] = q[0][0] * q[0][0] - q[1][0] * q[1][0] - q[2][0] * q[2][0] + q[3][0] * q[3][0];
    for (int n = 0; n < degree; ++n) {
      for (int i = 0; i < 3; ++i) w[i][n] = m[i][n] / inertia[i];
      std::array<long double, 3> dm{torque * g[1][n], -torque * g[0][n], 0}, dg{};
      std::array<long double, 4> dq{};
      for (int j = 0; j <= n; ++j) {
        const int k = n - j;
        for (int i = 0; i < 3; ++i) {
          const int a = (i + 1) % 3, b = (i + 2) % 3;
          dm[i] += m[a][j] * w[b][k] - m[b][j] * w[a][k];
          dg[i] += g[a][j] * w[b][k] - g[b][j] * w[a][k];
          dq[i + 1] += q[0][j] * w[i][k] + q[a + 1][j] * w[b][k] - q[b + 1][j] * w[a][k];
          dq[0] -= q[i + 1][j] * w[i][k];
        }
      }
      for (int i = 0; i < 3; ++i) m[i][n + 1] = dm[i] / (n + 1), g[i][n + 1] = dg[i] / (n + 1);
      for (int i = 0; i < 4; ++i) q[i][n + 1] = dq[i] / (2 * (n + 1));
    }
    long double step = left;
    const long double size = std::max(state.angular_momentum.norm(), std::sqrt(torque * transverse));
    for (const int n : {degree - 1, degree}) {
      long double last = 0;
      for (const Series& s : q) last = std::max(last, std::abs(s[n]));
      for (const Series& s : m) last = std::max(last, std::abs(s[n]) / size);
      if (last > 0) step = std::min(step, std::pow(1e-21L / last, 1.0L / n));
    }
    const auto value = [&](const Series& s) {
      long double sum = s[degree];
      for (int n = degree - 1; n >= 0; --n) sum = sum * (direction * step) + s[n];
      return sum;
    };
    state.orientation = {value(q[0]), value(q[1]), value(q[2]), value(q[3])};
    for (int i = 0; i < 3; ++i) state.angular_momentum[i] = value(m[i]);
    left -= step;
  }
  return state;
}

}  // namespace gnomon::tests
