#pragma once
// Closed-form motion of a heavy symmetric top (Lagrange's top).
//
// F. Klein & A. Sommerfeld, Ueber die Theorie des Kreisels, vol. II, Teubner 1898; E. T. Whittaker, A
// Treatise on the Analytical Dynamics of Particles and Rigid Bodies, 4th ed., Cambridge 1937, sections 71-72.
// The forms here were derived anew so that they hold through both vertical positions and near steady
// precession.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>

#include "models/rigid_body/carlson.hpp"
#include "models/rigid_body/elliptic.hpp"

namespace gnomon::rigid_body {

/// A top with the moments (I1, I1, I3), its centre on the third axis of the body, torque a > 0 [N m] of the
/// weight on the axis when that is horizontal.
///
/// z, the cosine of the angle between the axis and the vertical, is z1 + (z2 - z1) sn^2(lambda t + u0)
/// between two of the roots z1 <= z2 <= 1 <= z3 of the cubic
///     I1^2 z'^2 = (1 - z^2) |m_perp|^2 - (Lz - L3 z)^2 = 2 I1 a (z - z1)(z2 - z)(z3 - z),
/// Lz and L3 being the momenta about the vertical and the axis. With the unit quaternion (w, x, y, z) of the
/// body, w + i z and x + i y have the squared moduli (1 + z)/2 and (1 - z)/2 and the rates of argument
///     (Lz + L3)/(2 I1 (1 + z)) + r/2   and   (Lz - L3)/(2 I1 (1 - z)) - r/2,   r = L3 (1/I3 - 1/I1),
/// whose integrals are elliptic ones of the third kind. The roots are found as distances from the initial z,
/// which keeps their accuracy near steady precession, where z1 = z2. Where Lz = L3, one root is z = 1. If it
/// is z2, the axis passes through the vertical, and x + i y is sqrt((z2 - z1)/2) cn with its sign, turning at
/// the rate -r/2 alone. Where Lz = -L3, the same is true of z1 = -1, w + i z, sn and r/2.
template <class Real>
class HeavySymmetricTop {
 public:
  using Vector3 = Eigen::Matrix<Real, 3, 1>;
  using Quaternion = Eigen::Quaternion<Real>;
  struct State {
    Quaternion orientation;
    Vector3 angular_momentum;  ///< body components
  };

  HeavySymmetricTop(Real transverse, Real axial, Real torque, const Quaternion& orientation, const Vector3& m)
      : i1_(transverse), l3_(m[2]) {
    const Quaternion q = orientation.normalized();
    const Complex up(q.w(), q.z()), down(q.x(), q.y());
    const Real below = 2 * std::norm(down), above = 2 * std::norm(up), z0 = (above - below) / 2;
    // The vertical in the body is (g1, g2, z).
    const Real g1 = 2 * (q.x() * q.z() - q.w() * q.y()), g2 = 2 * (q.y() * q.z() + q.w() * q.x());
    const Real across = m[0] * g1 + m[1] * g2, perpendicular = m[0] * m[0] + m[1] * m[1];
    const Real slope = m[1] * g1 - m[0] * g2;  // I1 z'
    const Real sum = across + m[2] * above, difference = across - m[2] * below, f3 = 2 * i1_ * torque;
    const auto [y1, y2, y3] =
        roots({slope * slope, -2 * z0 * perpendicular - f3 * above * below + 2 * m[2] * across,
               -perpendicular + 2 * f3 * z0 - m[2] * m[2], f3},
              above, below, sum, difference);
    range_ = y2 - y1;

    // 1 + z1 and 1 - z2, from the product of the roots where they are small differences.
    const Real gap = y3 - below, spin = m[2] * (transverse - axial) / (2 * transverse * axial);
    up_ = {above + y1, sum, spin, std::arg(up)};
    down_ = {below - y2, difference, -spin, std::arg(down)};
    if (-y1 > above / 2) up_.least = sum * sum / (f3 * (above + y2) * (above + y3));
    if (y2 > below / 2 && gap > 0) down_.least = difference * difference / (f3 * (below - y1) * gap);
    if (range_ == 0) return;

    const Real to_third = y3 - y1, k1 = std::sqrt(std::max(Real(0), (y3 - y2) / to_third));
    lambda_ = std::sqrt(torque * to_third / (2 * i1_));
    modulus_square_ = range_ / to_third;
    k1_ = k1;
    jacobi_ = JacobiFunctions<Real>(std::sqrt(modulus_square_), k1);
    const JacobiValues<Real> v{std::copysign(std::sqrt(-y1 / range_), slope), std::sqrt(y2 / range_),
                               std::sqrt(y3 / to_third)};
    u0_ = jacobi_argument(v);
    // On the separatrix, k1 = 0, there are no half periods, and the functions are hyperbolic ones.
    const JacobiValues<Real> end{1, 0, k1};
    const Quaternion w(0, m[0] / i1_, m[1] / i1_, m[2] / axial), rate = q * w;  // twice the rate
    if (passes_zero(up_)) {
      set_argument(up_, up, Complex(rate.w(), rate.z()) / Real(2), v.sn, v.cn * v.dn);
    } else {
      up_.start = up_integral(v, u0_);
      if (k1 > 0) up_.half = 2 * up_integral(end, jacobi_.quarter_period());
    }
    if (passes_zero(down_)) {
      set_argument(down_, down, Complex(rate.x(), rate.y()) / Real(2), v.cn, -v.sn * v.dn);
    } else {
      down_.start = down_integral(v, u0_);
      if (k1 > 0) down_.half = 2 * down_integral(end, jacobi_.quarter_period());
    }
  }

  /// State at time t [s], of either sign.
  State at(Real t) const {
    JacobiValues<Real> v{0, 1, 1};
    Real halves = 0, rest = 0;  // u = 2 K halves + rest
    if (range_ > 0) {
      const Real quarter = jacobi_.quarter_period(), u = lambda_ * t + u0_;
      if (std::isfinite(quarter)) halves = std::nearbyint(u / (2 * quarter));
      rest = halves == 0 ? u : u - halves * (2 * quarter);
      v = jacobi_.at(std::clamp(rest, -quarter, quarter));
    }
    const Real sign = std::fmod(halves, Real(2)) == 0 ? 1 : -1;
    const bool moves_up = range_ > 0 && !passes_zero(up_), moves_down = range_ > 0 && !passes_zero(down_);
    const auto [up, up_rate] =
        motion(up_, t, sign * v.sn, sign * v.cn * v.dn, halves, moves_up ? up_integral(v, rest) : Real(0));
    const auto [down, down_rate] = motion(down_, t, sign * v.cn, -sign * v.sn * v.dn, halves,
                                          moves_down ? down_integral(v, rest) : Real(0));
    const Quaternion q(up.real(), down.real(), down.imag(), up.imag());
    const Quaternion rate(up_rate.real(), down_rate.real(), down_rate.imag(), up_rate.imag());
    const Vector3 w = 2 * (q.conjugate() * rate).vec();
    return {q.normalized(), Vector3(i1_ * w[0], i1_ * w[1], l3_)};
  }

 private:
  using Complex = std::complex<Real>;

  /// w + i z or x + i y: twice the squared modulus is `least` + (z2 - z1) s^2 with s = sn or cn.
  struct Component {
    Real least = 0;            // 1 + z1 or 1 - z2
    Real momentum = 0;         // Lz + L3 or Lz - L3
    Real spin = 0;             // r/2 or -r/2
    Real argument = 0;         // at t = 0
    Real start = 0, half = 0;  // integrals of 1/(least + (z2 - z1) s^2) to u0, and over half a period
  };
  bool passes_zero(const Component& c) const { return c.least == 0 && range_ > 0; }

  /// The argument of a component that passes through zero, from its value and rate at u0.
  void set_argument(Component& c, Complex value, Complex rate, Real s, Real s_rate) const {
    c.argument = std::arg(value * s + (rate - Complex(0, c.spin) * value) * (s_rate / lambda_));
  }

  /// A component and its rate at time t from s, ds/du and the integral from 0 to u less half periods.
  std::array<Complex, 2> motion(const Component& c, Real t, Real s, Real s_rate, Real halves,
                                Real integral) const {
    const Real square = c.least + range_ * s * s;
    Real argument = c.argument + c.spin * t, modulus, growth, turning = c.spin;
    if (passes_zero(c)) {
      modulus = std::sqrt(range_ / 2) * s;
      growth = std::sqrt(range_ / 2) * lambda_ * s_rate;
    } else {
      modulus = std::sqrt(square / 2);
      growth = modulus > 0 ? range_ * s * lambda_ * s_rate / (2 * modulus) : Real(0);
      const Real per_time = square > 0 ? c.momentum / (2 * i1_) : Real(0);
      if (range_ > 0)
        argument += per_time * (halves * c.half + (integral - c.start)) / lambda_;
      else if (square > 0)
        argument += per_time / square * t;
      if (square > 0) turning += per_time / square;
    }
    const Complex unit = std::polar(Real(1), argument);
    return {modulus * unit, Complex(growth, turning * modulus) * unit};
  }

  // Integrals from 0 to u, |u| <= K.
  // A sum of positive terms (M. Abramowitz, I.A. Stegun, 17.7.15), unlike the integral with n < 0 itself.
  Real up_integral(const JacobiValues<Real>& v, Real u) const {
    const Real a = up_.least, most = a + range_, b = modulus_square_ * a + range_;
    // On the separatrix nothing is left of the other integral, and cn = dn may underflow.
    const Real cn_dn = k1_ > 0 ? v.cn / v.dn : Real(1);
    const Real other = k1_ > 0 ? third_kind(v, u, b / most, k1_ * std::sqrt(a / most)) : Real(0);
    return (k1_ * k1_ * (range_ / most) * other + modulus_square_ * u) / b +
           std::sqrt(range_ / (a * b * most)) * std::atan(std::sqrt(range_ * b / (a * most)) * v.sn * cn_dn);
  }
  Real down_integral(const JacobiValues<Real>& v, Real u) const {
    const Real most = down_.least + range_;
    return third_kind(v, u, range_ / most, std::sqrt(down_.least / most)) / most;
  }
  // Of 1/(1 - n sn^2); root = sqrt(1 - n).
  static Real third_kind(const JacobiValues<Real>& v, Real u, Real n, Real root) {
    if constexpr (std::is_same_v<Real, double>) {
      const Real p = v.cn * v.cn + (root * v.sn) * (root * v.sn);
      return u + n * (v.sn * v.sn * v.sn) * carlson_rj(v.cn * v.cn, v.dn * v.dn, 1.0, p) / 3;
    } else {
      return u + n * static_cast<Real>(elliptic_j(v, root));
    }
  }

  /// The roots y1 <= 0 <= y2 <= y3 of f[0] + f[1] y + f[2] y^2 + f[3] y^3, which is -(Lz - L3)^2 at y = below
  /// and -(Lz + L3)^2 at y = -above; y1 = y2 = 0 where z stays as it is.
  static std::array<Real, 3> roots(const std::array<Real, 4>& f, Real above, Real below, Real sum,
                                   Real difference) {
    std::array<Real, 3> y;
    if (sum == 0 && difference == 0) {
      const Real third = above * below > 0 ? f[0] / (f[3] * above * below) : -f[2] / f[3] + above - below;
      y = {-above, third, below};
    } else if (difference == 0) {
      y = with_root(f, below);
    } else if (sum == 0) {
      y = with_root(f, -above);
    } else {
      y = with_root(f, largest_root(f, below));
    }
    std::sort(y.begin(), y.end());
    if (f[0] == 0 && f[1] == 0) y[0] = y[1] = 0;
    return {std::min(y[0], Real(0)), std::max(y[1], Real(0)), std::max(y[2], Real(0))};
  }
  /// All roots, given one of them.
  static std::array<Real, 3> with_root(const std::array<Real, 4>& f, Real root) {
    // f3 (y - root) (y^2 + b y + c)
    const Real c = root != 0 ? -f[0] / (f[3] * root) : f[1] / f[3];
    // b by the formula with the smaller terms, hence rounding errors
    const bool forward =
        std::abs(root) * (std::abs(f[2]) + f[3] * std::abs(root)) < std::abs(f[1]) + f[3] * std::abs(c);
    const Real b = root == 0 || forward ? f[2] / f[3] + root : (c - f[1] / f[3]) / root;
    const Real t = -(b + std::copysign(std::sqrt(std::max(Real(0), b * b - 4 * c)), b)) / 2;
    return {root, t, t != 0 ? c / t : Real(0)};
  }
  // Newton's method from above, where the cubic is convex and all its roots are to the left.
  static Real largest_root(const std::array<Real, 4>& f, Real least) {
    Real y = least + 1 + (std::abs(f[0]) + std::abs(f[1]) + std::abs(f[2])) / f[3];
    for (int k = 0; k < 500; ++k) {
      const Real value = ((f[3] * y + f[2]) * y + f[1]) * y + f[0];
      const Real derivative = (3 * f[3] * y + 2 * f[2]) * y + f[1], next = y - value / derivative;
      if (!(next < y) || !(derivative > 0)) break;
      y = next;
    }
    return std::max(y, least);
  }

  Real i1_, l3_;
  Component up_, down_;
  Real range_{}, lambda_{};  // z2 - z1
  JacobiFunctions<Real> jacobi_{Real(0), Real(1)};
  Real modulus_square_{}, k1_{}, u0_{};
};

}  // namespace gnomon::rigid_body
