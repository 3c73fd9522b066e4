#pragma once
// Rotations of many bodies at once, one a lane, and of one body with the same operations in the same order.
// Compiled once for each instruction set, see lanes.hpp.

#include <cmath>
#include <type_traits>

#include "integrators/ensemble/lanes.hpp"
#include "integrators/rotation/sinc_coefficients.hpp"

namespace gnomon::ensemble {
namespace {

/// Real is Lanes, or double for one body.
template <class Real>
struct Vector {
  Real x = 0.0, y = 0.0, z = 0.0;
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

/// rot(p, .) of Munjiza (5.68), the rotation by the rotation vector p [rad], without the division by |p|, as
/// a matrix: R = 1 + (sin|p|/|p|) hat(p) + ((1 - cos|p|)/|p|^2) hat(p)^2.
template <class Real>
class Rotation {
 public:
  explicit Rotation(const Vector<Real>& p) {
    const Real xx = p.x * p.x, yy = p.y * p.y, zz = p.z * p.z;
    square_ = (xx + yy) + zz;
    const auto [sine, versine] = sinc(square_);
    const Vector<Real> s = sine * p;
    const Real xy = versine * (p.x * p.y), xz = versine * (p.x * p.z), yz = versine * (p.y * p.z), one = 1.0;
    x_ = {one - versine * (yy + zz), xy + s.z, xz - s.y};
    y_ = {xy - s.z, one - versine * (xx + zz), yz + s.x};
    z_ = {xz + s.y, yz - s.x, one - versine * (xx + yy)};
  }

  Vector<Real> operator()(const Vector<Real>& a) const {
    return {(x_.x * a.x + y_.x * a.y) + z_.x * a.z, (x_.y * a.x + y_.y * a.y) + z_.y * a.z,
            (x_.z * a.x + y_.z * a.y) + z_.z * a.z};
  }
  Vector<Real> inverse(const Vector<Real>& a) const { return {dot(x_, a), dot(y_, a), dot(z_, a)}; }
  /// |p|^2
  const Real& square() const { return square_; }

 private:
  Real square_ = 0.0;
  Vector<Real> x_, y_, z_;  // columns
};

}  // namespace
}  // namespace gnomon::ensemble
