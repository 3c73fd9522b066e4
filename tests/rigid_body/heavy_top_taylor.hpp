#pragma once
// Reference integrator for tests: the heavy symmetric top by its Taylor series, in extended or higher
// precision, with no formula in common with the closed form.

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <limits>

namespace gnomon::tests {

/// Thirty-four digits.
using Quadruple = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_quad::backend_type,
                                                boost::multiprecision::et_off>;

/// Unit quaternion w, x, y, z and body components of the angular momentum.
template <class Real>
struct HeavyTopState {
  std::array<Real, 4> orientation;
  std::array<Real, 3> angular_momentum;
};

/// Solves q' = 1/2 q o (0, w), m' = m x w + torque (g2, -g1, 0), w = (m1/I1, m2/I1, m3/I3), g the vertical in
/// the body, over [0, time] with series of degree 30; their last terms are below a hundredth of an epsilon.
template <class Real>
HeavyTopState<Real> integrate_heavy_top(const Real& transverse, const Real& axial, const Real& torque,
                                        HeavyTopState<Real> state, long double time) {
  constexpr int degree = 30;
  using Series = std::array<Real, degree + 1>;
  std::array<Series, 4> q{};
  std::array<Series, 3> m{}, w{}, g{};
  const std::array<Real, 3> inertia{transverse, transverse, axial};
  const long double direction = time < 0 ? -1 : 1;
  const long double least = 0.01L * static_cast<long double>(std::numeric_limits<Real>::epsilon());
  const auto size_of = [](const Real& x) { return std::abs(static_cast<long double>(x)); };
  for (long double left = std::abs(time); left > 0;) {
    for (int i = 0; i < 4; ++i) q[i][0] = state.orientation[i];
    for (int i = 0; i < 3; ++i) m[i][0] = state.angular_momentum[i];
    g[0][0] = 2 * (q[1][0] * q[3][0] - q[0][0] * q[2][0]);
    g[1][0] = 2 * (q[2][0] * q[3][0] + q[0][0] * q[1][0]);
    g[2][0] = q[0][0] * q[0][0] - q[1][0] * q[1][0] - q[2][0] * q[2][0] + q[3][0] * q[3][0];
    for (int n = 0; n < degree; ++n) {
      for (int i = 0; i < 3; ++i) w[i][n] = m[i][n] / inertia[i];
      std::array<Real, 3> dm{torque * g[1][n], -torque * g[0][n], Real(0)}, dg{};
      std::array<Real, 4> dq{};
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
    long double step = left, size = std::sqrt(size_of(torque) * size_of(transverse));
    for (const Real& x : state.angular_momentum) size = std::max(size, size_of(x));
    for (const int n : {degree - 1, degree}) {
      long double last = 0;
      for (const Series& s : q) last = std::max(last, size_of(s[n]));
      for (const Series& s : m) last = std::max(last, size_of(s[n]) / size);
      if (last > 0) step = std::min(step, std::pow(least / last, 1.0L / n));
    }
    const auto value = [&](const Series& s) {
      Real sum = s[degree];
      for (int n = degree - 1; n >= 0; --n) sum = sum * Real(direction * step) + s[n];
      return sum;
    };
    for (int i = 0; i < 4; ++i) state.orientation[i] = value(q[i]);
    for (int i = 0; i < 3; ++i) state.angular_momentum[i] = value(m[i]);
    left -= step;
  }
  return state;
}

}  // namespace gnomon::tests
