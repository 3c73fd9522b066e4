#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

namespace gnomon::rigid_body {

/// R_C(1, 1 + e), e > -1: atan(sqrt e)/sqrt e, and atanh(sqrt -e)/sqrt -e for e < 0 (DLMF 19.2.18, 19.2.19).
/// For these `sum` is 1 + e, which keeps its digits where that is a small difference.
template <class Real>
Real carlson_rc(Real e, Real sum) {
  if (std::abs(e) < Real(0.01)) {
    // 1 - e/3 + e^2/5 - ..
    Real series = 0;
    for (int n = 10; n >= 0; --n) series = Real(1) / (2 * n + 1) - e * series;
    return series;
  }
  const Real root = std::sqrt(std::abs(e));
  if (e > 0) return std::atan(root) / root;
  return (sum > Real(0.25) ? std::atanh(root) : std::log((1 + root) / std::sqrt(sum))) / root;
}

/// Carlson's integral of the third kind R_J(x, y, z, p) for x, y, z >= 0, at most one of them 0, and p > 0,
/// to a few units in the last place of double precision (B.C. Carlson, Numer. Algorithms 10 (1995) 13-26,
/// eqs. (2.11)-(2.23): duplication, then a series of order 5). Several times as fast as a library's in
/// extended precision. Infinite if p or two of x, y, z are 0, not a number for arguments that are not finite.
template <class Real>
Real carlson_rj(Real x, Real y, Real z, Real p) {
  if (!std::isfinite(x + y + z + p)) return std::numeric_limits<Real>::quiet_NaN();
  if (p <= 0 || (x <= 0) + (y <= 0) + (z <= 0) > 1) return std::numeric_limits<Real>::infinity();
  const Real start = (x + y + z + 2 * p) / 5;
  Real mean = start, power = 1, sum = 0;
  const Real dx = start - x, dy = start - y, dz = start - z;
  // The series' error is of order 6 in the distances from the mean, over which 1/64 is gained with each
  // duplication.
  const Real spread = std::max({std::abs(dx), std::abs(dy), std::abs(dz), std::abs(start - p)}) *
                      std::pow(std::numeric_limits<Real>::epsilon() / 4, -Real(1) / 6);
  // As many duplications as there are binary exponents make any finite positive numbers alike.
  for (int k = 0; power * spread >= mean && k < 2 * std::numeric_limits<Real>::max_exponent; ++k) {
    const Real sx = std::sqrt(x), sy = std::sqrt(y), sz = std::sqrt(z), sp = std::sqrt(p);
    const Real lambda = sx * sy + sx * sz + sy * sz;
    // e = (p - x)(p - y)(p - z) / d^2, |e| = (1 - u1)(1 - u2)(1 - u3).
    const Real dx1 = sp + sx, dy1 = sp + sy, dz1 = sp + sz, d = dx1 * dy1 * dz1;
    const Real u1 = 2 * std::min(sp, sx) / dx1, u2 = 2 * std::min(sp, sy) / dy1,
               u3 = 2 * std::min(sp, sz) / dz1;
    const Real e = (sp - sx) * (sp - sy) * (sp - sz) / d;
    sum += power / d * carlson_rc(e, u1 + u2 + u3 - (u1 * u2 + u1 * u3 + u2 * u3) + u1 * u2 * u3);
    power /= 4;
    mean = (mean + lambda) / 4;
    x = (x + lambda) / 4;
    y = (y + lambda) / 4;
    z = (z + lambda) / 4;
    p = (p + lambda) / 4;
  }
  const Real scale = power / mean;
  const Real X = dx * scale, Y = dy * scale, Z = dz * scale, P = -(X + Y + Z) / 2;
  const Real e2 = X * Y + X * Z + Y * Z - 3 * P * P, xyz = X * Y * Z;
  const Real e3 = xyz + 2 * e2 * P + 4 * P * P * P, e4 = (2 * xyz + e2 * P + 3 * P * P * P) * P,
             e5 = xyz * P * P;
  const Real series =
      1 - 3 * e2 / 14 + e3 / 6 + 9 * e2 * e2 / 88 - 3 * e4 / 22 - 9 * e2 * e3 / 52 + 3 * e5 / 26;
  return power * series / (mean * std::sqrt(mean)) + 6 * sum;
}

}  // namespace gnomon::rigid_body
