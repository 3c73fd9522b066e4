#pragma once
// Rotations of many bodies at once, one a lane, and of one body with the same operations in the same order.
// Compiled once for each instruction set, see lanes.hpp.

#include <cmath>
#include <type_traits>

#include "integrators/ensemble/lanes.hpp"

namespace gnomon::ensemble {
namespace {

/// Real is Lanes, or double for one body.
template <class Real>
struct Vector {
  Real x, y, z;
};

template <class Real>
Vector<Real> operator+(const Vector<Real>& a, const Vector<Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
Vector<Real> operator-(const Vector<Real>& a, const Vector<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
Vector<Real> operator*(const Real& factor, const Vector<Real>& a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}
/// Component by component.
template <class Real>
Vector<Real> product(const Vector<Real>& a, const Vector<Real>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class Real>
Vector<Real> cross(const Vector<Real>& a, const Vector<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Real>
Real dot(const Vector<Real>& a, const Vector<Real>& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

/// sin(x)/x and (1 - cos x)/x^2.
template <class Real>
struct Sinc {
  Real sine, versine;
};

/// Up to this x^2, x = 1.25 rad, both are polynomials in x^2 of degree 7: they interpolate at Chebyshev
/// nodes, their constant coefficient being kept exact. With the coefficients rounded to double they are off
/// by at most 1.6e-17 and 8e-18 of the value, so that it is rounding alone that counts.
constexpr double sinc_limit = 1.5625;
constexpr double sine_coefficients[8] = {1.0,
                                         -0.16666666666666666,
                                         0.008333333333332851,
                                         -0.00019841269840776478,
                                         2.755731903444393e-06,
                                         -2.505207369721675e-08,
                                         1.6055782815851143e-10,
                                         -7.494895594805586e-13};
constexpr double versine_coefficients[8] = {0.5,
                                            -0.041666666666666664,
                                            0.001388888888888862,
                                            -2.4801587301312778e-05,
                                            2.755731911852423e-07,
                                            -2.0876737688872267e-09,
                                            1.1468931586384285e-11,
                                            -4.694801929763846e-14};

/// Estrin's scheme: the powers side by side.
template <class Real>
Real sum(const double (&c)[8], const Real& s, const Real& s2, const Real& s4) {
  return ((Real(c[0]) + Real(c[1]) * s) + (Real(c[2]) + Real(c[3]) * s) * s2) +
         ((Real(c[4]) + Real(c[5]) * s) + (Real(c[6]) + Real(c[7]) * s) * s2) * s4;
}

/// As functions of x^2. Lanes beyond the limit get wrong values: the caller has to look for them. A single
/// body then gets them by the half angle from the library.
template <class Real>
Sinc<Real> sinc(const Real& square) {
  if constexpr (std::is_same_v<Real, double>) {
    if (!(square <= sinc_limit)) {
      const double angle = std::sqrt(square), half = std::sin(0.5 * angle);
      return {std::sin(angle) / angle, 2.0 * half * half / square};
    }
  }
  const Real square2 = square * square, square4 = square2 * square2;
  return {sum(sine_coefficients, square, square2, square4),
          sum(versine_coefficients, square, square2, square4)};
}

/// rot(p, .) of Munjiza (5.68), the rotation by the rotation vector p [rad], without the division by |p|:
/// rot(p, a) = a cos|p| + p (p.a) (1 - cos|p|)/|p|^2 + (sin|p|/|p|) p x a. Keeps a reference to p.
template <class Real>
class Rotation {
 public:
  explicit Rotation(const Vector<Real>& p)
      : p_(p), square_(dot(p, p)), factor_(sinc(square_)), cosine_(Real(1.0) - square_ * factor_.versine) {}

  Vector<Real> operator()(const Vector<Real>& a) const {
    return (cosine_ * a + (factor_.versine * dot(p_, a)) * p_) + factor_.sine * cross(p_, a);
  }
  Vector<Real> inverse(const Vector<Real>& a) const {
    return (cosine_ * a + (factor_.versine * dot(p_, a)) * p_) - factor_.sine * cross(p_, a);
  }
  /// |p|^2
  const Real& square() const { return square_; }
  const Vector<Real>& vector() const { return p_; }
  const Sinc<Real>& factor() const { return factor_; }

 private:
  const Vector<Real>& p_;
  Real square_;
  Sinc<Real> factor_;
  Real cosine_;
};

/// The columns of the matrix of a rotation.
template <class Real>
struct Columns {
  Vector<Real> x, y, z;
};

template <class Real>
Columns<Real> columns(const Rotation<Real>& rotation) {
  const Vector<Real>& p = rotation.vector();
  const Vector<Real> s = rotation.factor().sine * p, c = rotation.factor().versine * p;
  const Real xx = c.x * p.x, yy = c.y * p.y, zz = c.z * p.z;
  const Real xy = c.x * p.y, xz = c.x * p.z, yz = c.y * p.z, one = 1.0;
  return {{one - (yy + zz), xy + s.z, xz - s.y},
          {xy - s.z, one - (xx + zz), yz + s.x},
          {xz + s.y, yz - s.x, one - (xx + yy)}};
}

}  // namespace
}  // namespace gnomon::ensemble
