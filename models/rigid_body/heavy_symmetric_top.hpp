#pragma once
// Closed-form motion of a heavy symmetric top (Lagrange's top).
//
// F. Klein & A. Sommerfeld, Ueber die Theorie des Kreisels, vol. II, Teubner 1898; E. T. Whittaker, A Treatise
// on the Analytical Dynamics of Particles and Rigid Bodies, 4th ed., Cambridge 1937, sections 71-72. The forms
// here were derived anew so that they hold through both vertical positions and near steady precession.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "models/rigid_body/elliptic.hpp"

namespace gnomon::rigid_body {

/// A top with the moments (I1, I1, I3), its centre on the third axis of the body, torque a > 0 [N m] of the
/// weight on the axis when that is horizontal.
///
/// z, the cosine of the angle between the axis and the vertical, is z1 + (z2 - z1) sn^2(lambda t + u0) between
/// two of the roots z1 <= z2 <= 1 <= z3 of the cubic
///     I1^2 z'^2 = (1 - z^2) |m_perp|^2 - (Lz - L3 z)^2 = 2 I1 a (z - z1)(z2 - z)(z3 - z),
/// Lz and L3 being the momenta about the vertical and the axis. With the unit quaternion (w, x, y, z) of the
/// body, w + i z and x + i y have the squared moduli (1 + z)/2 and (1 - z)/2 and the rates of argument
///     (Lz + L3)/(2 I1 (1 + z)) + r/2   and   (Lz - L3)/(2 I1 (1 - z)) - r/2,   r = L3 (1/I3 - 1/I1),
/// whose integrals are elliptic ones of the third kind. The roots are found as distances from the initial z,
/// which keeps their accuracy near steady precession, where z1 = z2. Lz = L3 and Lz = -L3 exactly, where the
/// axis passes through the vertical, are left out.
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
      : i1_(transverse), l3_(m[2]), spin_(m[2] * (transverse - axial) / (transverse * axial)) {
    const Quaternion q = orientation.normalized();
    up_ = Complex(q.w(), q.z());
    down_ = Complex(q.x(), q.y());
    const Real below = 2 * std::norm(down_), above = 2 * std::norm(up_), z0 = (above - below) / 2;
    // The vertical in the body is (g1, g2, z).
    const Real g1 = 2 * (q.x() * q.z() - q.w() * q.y()), g2 = 2 * (q.y() * q.z() + q.w() * q.x());
    const Real across = m[0] * g1 + m[1] * g2, perpendicular = m[0] * m[0] + m[1] * m[1];
    difference_ = across - m[2] * below;
    sum_ = across + m[2] * above;
    const Real slope = m[1] * g1 - m[0] * g2;  // I1 z'

    // f0 + f1 y + f2 y^2 + f3 y^3, y = z - z0
    const Real f0 = slope * slope, f3 = 2 * i1_ * torque;
    const Real f1 = -2 * z0 * perpendicular - f3 * above * below + 2 * m[2] * across;
    const Real f2 = -perpendicular + 2 * f3 * z0 - m[2] * m[2];
    const Real y3 = largest_root(f0, f1, f2, f3, below);
    const Real c = y3 > 0 ? f0 / y3 : Real(0), b = y3 > 0 ? -(f1 + c) / y3 : f2;
    const Real t = -(b + std::copysign(std::sqrt(b * b + 4 * f3 * c), b)) / 2;
    Real y1 = t != 0 ? t / f3 : Real(0), y2 = t != 0 ? -c / t : Real(0);
    if (y1 > y2) std::swap(y1, y2);
    y1 = std::min(y1, Real(0)), y2 = std::max(y2, Real(0));
    range_ = y2 - y1;

    const Real to_third = y3 - y1;
    lambda_ = std::sqrt(torque * to_third / (2 * i1_));
    // 1 - z2 and 1 + z1, from the product of the roots where they are small differences.
    const Real gap = y3 - below;
    below2_ = below - y2;
    if (y2 > below / 2 && gap > 0) below2_ = difference_ * difference_ / (f3 * (below - y1) * gap);
    above1_ = above + y1;
    if (-y1 > above / 2) above1_ = sum_ * sum_ / (f3 * (above + y2) * (above + y3));
    jacobi_ = JacobiFunctions<Real>(std::sqrt(range_ / to_third), std::sqrt(std::max(Real(0), (y3 - y2) / to_third)));

    start_ = {Real(0), Real(1), Real(1)};
    if (range_ > 0)
      start_ = {std::copysign(std::sqrt(-y1 / range_), slope), std::sqrt(y2 / range_),
                std::sqrt(y3 / to_third)};
    u0_ = jacobi_argument(start_);
    start_above_ = third_kind(start_, u0_, above_characteristic());
    start_below_ = third_kind(start_, u0_, below_characteristic());
    const Real quarter = jacobi_.quarter_period();
    if (std::isfinite(quarter)) {
      const JacobiValues<Real> end{Real(1), Real(0), std::sqrt(std::max(Real(0), (y3 - y2) / to_third))};
      half_above_ = 2 * third_kind(end, quarter, above_characteristic());
      half_below_ = 2 * third_kind(end, quarter, below_characteristic());
    }
  }

  /// State at time t [s], of either sign.
  State at(Real t) const {
    const Real quarter = jacobi_.quarter_period(), u = lambda_ * t + u0_;
    const Real halves = std::isfinite(quarter) ? std::nearbyint(u / (2 * quarter)) : Real(0);
    const Real rest = halves == 0 ? u : u - halves * (2 * quarter);
    const JacobiValues<Real> v = jacobi_.at(std::clamp(rest, -quarter, quarter));
    const Real above = above1_ + range_ * v.sn * v.sn, below = below2_ + range_ * v.cn * v.cn;
    const Real slope = 2 * range_ * lambda_ * v.sn * v.cn * v.dn;  // z'
    const Real turned_above = (halves * half_above_ + (third_kind(v, rest, above_characteristic()) - start_above_));
    const Real turned_below = (halves * half_below_ + (third_kind(v, rest, below_characteristic()) - start_below_));
    const Real phase_up = sum_ / (2 * i1_ * above1_) * turned_above / lambda_ + spin_ * t / 2;
    const Real phase_down = difference_ / (2 * i1_ * (below2_ + range_)) * turned_below / lambda_ - spin_ * t / 2;
    const Complex up = std::polar(std::sqrt(above / 2), std::arg(up_) + phase_up);
    const Complex down = std::polar(std::sqrt(below / 2), std::arg(down_) + phase_down);
    const Complex up_rate = up * Complex(slope / (2 * above), sum_ / (2 * i1_ * above) + spin_ / 2);
    const Complex down_rate =
        down * Complex(-slope / (2 * below), difference_ / (2 * i1_ * below) - spin_ / 2);
    const Quaternion q(up.real(), down.real(), down.imag(), up.imag());
    const Quaternion rate(up_rate.real(), down_rate.real(), down_rate.imag(), up_rate.imag());
    const Vector3 w = 2 * (q.conjugate() * rate).vec();
    return {q.normalized(), Vector3(i1_ * w[0], i1_ * w[1], l3_)};
  }

 private:
  using Complex = std::complex<Real>;

  // 1/(1 - n sn^2): n and sqrt(1 - n)
  struct Characteristic {
    Real n, root;
  };
  Characteristic above_characteristic() const {
    return {-range_ / above1_, std::sqrt((above1_ + range_) / above1_)};
  }
  Characteristic below_characteristic() const {
    return {range_ / (below2_ + range_), std::sqrt(below2_ / (below2_ + range_))};
  }
  // The integral of 1/(1 - n sn^2) from 0 to u, |u| <= K.
  static Real third_kind(const JacobiValues<Real>& v, Real u, const Characteristic& c) {
    return u + c.n * static_cast<Real>(elliptic_j(v, c.root));
  }

  // Newton's method from above, where the cubic is convex and all its roots are to the left.
  static Real largest_root(Real f0, Real f1, Real f2, Real f3, Real least) {
    Real y = least + 1 + (std::abs(f0) + std::abs(f1) + std::abs(f2)) / f3;
    for (int k = 0; k < 500; ++k) {
      const Real value = ((f3 * y + f2) * y + f1) * y + f0, derivative = (3 * f3 * y + 2 * f2) * y + f1;
      const Real next = y - value / derivative;
      if (!(next < y) || !(derivative > 0)) break;
      y = next;
    }
    return std::max(y, least);
  }

  Real i1_, l3_, spin_;
  Complex up_, down_;           // w + i z and x + i y at t = 0
  Real sum_{}, difference_{};   // Lz + L3, Lz - L3
  Real range_{}, lambda_{};     // z2 - z1
  Real below2_{}, above1_{};    // 1 - z2, 1 + z1
  JacobiFunctions<Real> jacobi_{Real(0), Real(1)};
  JacobiValues<Real> start_{};
  Real u0_{}, start_above_{}, start_below_{}, half_above_{}, half_below_{};
};

}  // namespace gnomon::rigid_body
