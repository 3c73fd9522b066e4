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
#include "models/rigid_body/heavy_symmetric_top_constants.hpp"

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
/// whose integrals are elliptic ones of the third kind. Where Lz = L3, one root is z = 1. If it is z2, the
/// axis passes through the vertical, and x + i y is sqrt((z2 - z1)/2) cn with its sign, turning at the rate
/// -r/2 alone. Where Lz = -L3, the same is true of z1 = -1, w + i z, sn and r/2.
///
/// Conditioning. On the separatrix, Lz = L3 with the energy of rest in the upper vertical, the axis
/// approaches that in infinite time; k1 = 0, and the functions are hyperbolic ones. Beside it the axis passes
/// the vertical or turns back after each half period, 2 K / lambda ~ 2 ln(4 / k1) / lambda. A relative change
/// eps of the data, or the roundoff of an integrator, changes k1^2 by about eps, and after n half periods the
/// phase by n eps / k1^2. That is a property of the problem. Here the data are taken as exact and k1 is had
/// from them with twice the digits of extended precision (heavy_symmetric_top_constants.hpp), so that the
/// values returned do not suffer from it: error_bound() grows with the angle turned, plus a term in n (eps /
/// k1)^2, eps being that of extended precision; where k1 = 0 and the data had to be rounded, the term grows
/// as exp(lambda t).
template <class Real>
class HeavySymmetricTop {
 public:
  using Vector3 = Eigen::Matrix<Real, 3, 1>;
  using Quaternion = Eigen::Quaternion<Real>;
  struct State {
    Quaternion orientation;
    Vector3 angular_momentum;  ///< body components
  };

  explicit HeavySymmetricTop(const HeavyTopData& data) { prepare(data, heavy_top_constants(data)); }

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

  /// Upper bound of the error of at(t) against the exact solution for the data as given: of the orientation
  /// (geodesic distance [rad]), and of the angular momentum over momentum_size().
  Real error_bound(Real t) const {
    const Real turned = turning_ * (std::abs(t) + (range_ > 0 ? 2 * std::abs(u0_) / lambda_ : Real(0)));
    const Real rounding = 8 * std::numeric_limits<Real>::epsilon() * (1 + turned);
    if (!(range_ > 0) || separation_error_ == 0) return rounding;
    // An error d of k1^2 shifts each half period by about d / (2 k1^2).
    const long double phase = static_cast<long double>(lambda_ * std::abs(t) + std::abs(u0_));
    const long double amplified =
        separation_error_ * (k1_ > 0 ? 1 + static_cast<long double>(turned) : std::exp(phase));
    return rounding + static_cast<Real>(std::min(4.0L, amplified));
  }
  /// The most that the angular momentum becomes, and the largest rate of turning [1/s].
  Real momentum_size() const { return momentum_size_; }
  Real turning() const { return turning_; }
  /// Complementary modulus of the Jacobi functions: the distance from the separatrix, on which it is 0; 1
  /// where the inclination stays as it is.
  Real complementary_modulus() const { return k1_; }

 private:
  using Complex = std::complex<Real>;

  [[gnu::noinline]] void prepare(const HeavyTopData& data, const HeavyTopConstants& c) {
    const long double transverse = data.transverse, axial = data.axial;
    std::array<long double, 4> p;
    for (std::size_t k = 0; k < 4; ++k) p[k] = data.orientation[k].high;
    const Quaternion q =
        Eigen::Quaternion<long double>(p[0], p[1], p[2], p[3]).normalized().template cast<Real>();
    const Complex up(q.w(), q.z()), down(q.x(), q.y());
    const Vector3 m(Real(data.angular_momentum[0]), Real(data.angular_momentum[1]),
                    Real(data.angular_momentum[2]));
    const Real spin =
        static_cast<Real>(data.angular_momentum[2] * (transverse - axial) / (2 * transverse * axial));
    i1_ = Real(transverse);
    l3_ = m[2];
    up_ = {Real(c.up), Real(c.sum), spin, std::arg(up)};
    down_ = {Real(c.down), Real(c.difference), -spin, std::arg(down)};
    momentum_size_ = Real(c.transverse_most) + std::abs(l3_);
    turning_ = Real(c.transverse_most) / i1_ + std::abs(l3_) / i1_ + 2 * std::abs(spin) +
               2 * Real(std::sqrt(data.torque.high / transverse)) + Real(c.rate);
    if (c.steady) return;

    range_ = Real(c.range);
    lambda_ = Real(c.rate);
    modulus_square_ = Real(c.k * c.k);
    k1_ = Real(c.k1);
    separation_error_ = c.separation_error;
    jacobi_ = JacobiFunctions<Real>(Real(c.k), k1_);
    const JacobiValues<Real> v{Real(c.v[0]), Real(c.v[1]), Real(c.v[2])};
    u0_ = jacobi_argument(v);
    // On the separatrix, k1 = 0, there are no half periods.
    const JacobiValues<Real> end{1, 0, k1_};
    const Quaternion w(0, m[0] / i1_, m[1] / i1_, m[2] / Real(axial)), rate = q * w;  // twice the rate
    if (passes_zero(up_)) {
      set_argument(up_, up, Complex(rate.w(), rate.z()) / Real(2), v.sn, v.cn * v.dn);
    } else {
      up_.start = up_integral(v, u0_);
      if (k1_ > 0) up_.half = 2 * up_integral(end, jacobi_.quarter_period());
    }
    if (passes_zero(down_)) {
      set_argument(down_, down, Complex(rate.x(), rate.y()) / Real(2), v.cn, -v.sn * v.dn);
    } else {
      down_.start = down_integral(v, u0_);
      if (k1_ > 0) down_.half = 2 * down_integral(end, jacobi_.quarter_period());
    }
  }

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

  Real i1_{}, l3_{};
  Component up_, down_;
  Real range_{}, lambda_{};  // z2 - z1
  JacobiFunctions<Real> jacobi_{Real(0), Real(1)};
  Real modulus_square_{}, k1_{1}, u0_{};
  Real momentum_size_{}, turning_{};
  long double separation_error_{};  // of k1^2, see HeavyTopConstants
};

}  // namespace gnomon::rigid_body
