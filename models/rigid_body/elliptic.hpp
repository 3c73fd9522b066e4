#pragma once
// Jacobi elliptic functions and Legendre integrals in the variables sn, cn, dn, accurate for every modulus.
//
// Both moduli k and k1 = sqrt(1 - k^2) are arguments, never derived from each other: near k = 1 everything
// depends on the digits of k1 that 1 - k^2 has lost. Sources: DLMF (dlmf.nist.gov), chapters 19, 20 and 22.

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/ellint_rf.hpp>
#include <boost/math/special_functions/ellint_rj.hpp>
#include <cmath>
#include <limits>

namespace gnomon::rigid_body {

/// Arithmetic-geometric mean of 1 and x, 0 <= x <= 1.
template <class Real>
Real agm_with_one(Real x) {
  if (x <= 0) return 0;
  Real a = 1;
  // Quadratic convergence: the step after |a - b| < sqrt(eps) a is exact to roundoff.
  const Real enough = std::sqrt(std::numeric_limits<Real>::epsilon());
  for (Real b = x; true;) {
    const Real difference = a - b;
    const Real mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
    if (!(std::abs(difference) > enough * a)) return (a + b) / 2;
  }
}

/// sn, cn and dn of one argument.
template <class Real>
struct JacobiValues {
  Real sn, cn, dn;
};

/// Jacobi functions for |u| <= K at fixed modulus: theta series (DLMF 20.2, 22.2) in the nome, or in the
/// complementary nome with hyperbolic arguments (DLMF 22.6.iv), whichever is below exp(-pi) = 0.043. Each
/// value has a relative error of a few eps (1 + |u|), also where cn or dn is small.
template <class Real>
class JacobiFunctions {
 public:
  /// k in [0, 1] is the modulus, k1 in [0, 1] the complementary modulus; k^2 + k1^2 = 1 up to roundoff.
  JacobiFunctions(Real k, Real k1) : k1_(k1), hyperbolic_(k > k1) {
    const Real pi = boost::math::constants::pi<Real>();
    const Real mean = agm_with_one(k1);          // pi / (2 K)
    const Real complementary = agm_with_one(k);  // pi / (2 K')
    const Real infinity = std::numeric_limits<Real>::infinity();
    quarter_period_ = mean > 0 ? pi / (2 * mean) : infinity;
    scale_ = hyperbolic_ ? complementary : mean;
    const Real other = hyperbolic_ ? mean : complementary;
    log_nome_ = other > 0 ? -pi * (scale_ / other) : -infinity;
    q_ = std::exp(log_nome_);
    q2_ = q_ * q_;
    at_zero_ = sums({2 * q_, 2 * q2_ * q2_, 2 * q_ * std::pow(q2_, Real(4)), 2 * std::pow(q2_, Real(8))});
  }

  /// K, the quarter period; infinite for k1 = 0.
  Real quarter_period() const { return quarter_period_; }

  /// Whether the nome is that of k1, the lesser one: then series run in cosh and sinh of scale() u, else in
  /// cos and sin of it. log_nome() is the logarithm of that nome.
  bool hyperbolic() const { return hyperbolic_; }
  Real scale() const { return scale_; }
  Real log_nome() const { return log_nome_; }

  /// sn u, cn u, dn u for |u| <= K.
  JacobiValues<Real> at(Real u) const {
    if (2 * std::abs(u) <= quarter_period_) return near_zero(u);
    // cn and dn keep their relative accuracy where they are small (DLMF table 22.4.3).
    const JacobiValues<Real> v = near_zero(std::max(Real(0), quarter_period_ - std::abs(u)));
    return {std::copysign(v.cn / v.dn, u), k1_ * v.sn / v.dn, k1_ / v.dn};
  }

 private:
  // Terms 2 q^(j^2) cos(2 j z), j = 1..4, with cosh for cos in the hyperbolic case.
  struct Terms {
    Real h1, h2, h3, h4;
  };
  // theta_1 / (2 q^(1/4) sin z), theta_2 / (2 q^(1/4) cos z), theta_3, theta_4.
  struct Sums {
    Real theta1, theta2, theta3, theta4;
  };

  // sin(3z)/sin(z) = 1 + 2 cos(2z) and so on turn all four series into sums of the same terms. The first
  // term left out is below q^18 < 1e-24 for |u| <= K/2.
  Sums sums(const Terms& t) const {
    const Real q3 = q_ * q2_;
    const Real q5 = q2_ * q3;
    const Real q6 = q3 * q3;
    const Real first_odd = q2_ + q_ * t.h1;
    const Real second_odd = q6 + q5 * t.h1 + q2_ * t.h2;
    const Real third_odd = q6 * q6 + q6 * q5 * t.h1 + q5 * q3 * t.h2 + q3 * t.h3;
    const Real first_even = q_ * t.h1 - q2_;
    const Real second_even = q2_ * t.h2 - q5 * t.h1 + q6;
    const Real third_even = q3 * t.h3 - q5 * q3 * t.h2 + q6 * q5 * t.h1 - q6 * q6;
    return {1 - first_odd + second_odd - third_odd, 1 + first_even + second_even + third_even,
            1 + t.h1 + t.h2 + t.h3 + t.h4, 1 - t.h1 + t.h2 - t.h3 + t.h4};
  }

  JacobiValues<Real> near_zero(Real u) const { return hyperbolic_ ? hyperbolic(u) : circular(u); }

  JacobiValues<Real> circular(Real u) const {
    const Real sine = std::sin(scale_ * u);
    const Real cosine = std::cos(scale_ * u);
    const Real c2 = 2 * (cosine - sine) * (cosine + sine);  // 2 cos(2z)
    const Real c4 = c2 * c2 - 2;
    const Real q4 = q2_ * q2_;
    const Sums s = sums({q_ * c2, q4 * c4, q_ * q4 * q4 * c2 * (c4 - 1), q4 * q4 * q4 * q4 * (c4 * c4 - 2)});
    return {at_zero_.theta3 / at_zero_.theta2 * sine * s.theta1 / s.theta4,
            at_zero_.theta4 / at_zero_.theta2 * cosine * s.theta2 / s.theta4,
            at_zero_.theta4 / at_zero_.theta3 * s.theta3 / s.theta4};
  }

  JacobiValues<Real> hyperbolic(Real u) const {
    const Real v = scale_ * u;
    // q cosh(2v) as exp(log q +- 2v): q underflows and cosh overflows close to the limit k1 = 0.
    const Real up = std::exp(log_nome_ + 2 * v);
    const Real down = std::exp(log_nome_ - 2 * v);
    const Real up2 = up * up;
    const Real down2 = down * down;
    const Real q6 = q2_ * q2_ * q2_;
    const Sums s = sums({up + down, q2_ * (up2 + down2), q6 * (up2 * up + down2 * down),
                         q6 * q6 * (up2 * up2 + down2 * down2)});
    const Real sech = 1 / std::cosh(v);
    return {at_zero_.theta3 / at_zero_.theta4 * std::tanh(v) * s.theta1 / s.theta2,
            at_zero_.theta2 / at_zero_.theta4 * sech * s.theta4 / s.theta2,
            at_zero_.theta2 / at_zero_.theta3 * sech * s.theta3 / s.theta2};
  }

  Real k1_;
  bool hyperbolic_;
  Real quarter_period_{}, scale_{}, log_nome_{}, q_{}, q2_{};
  Sums at_zero_{};
};

// Carlson's integrals take squares; long double keeps them from underflowing where cn and dn are tiny.

/// F = integral of du from 0 to u, i.e. u itself, from sn u and positive cn u, dn u: sn RF(cn^2, dn^2, 1)
/// (DLMF 19.25.5 with x = cn^2, y = dn^2, z = 1, which is the same integral).
template <class Real>
Real jacobi_argument(const JacobiValues<Real>& v) {
  using Wide = long double;
  const Wide cn = v.cn;
  const Wide dn = v.dn;
  return v.sn * static_cast<Real>(boost::math::ellint_rf(cn * cn, dn * dn, Wide(1)));
}

/// Integral of sn^2 / (1 - n sn^2) from 0 to u for |u| <= K and n < 1, = sn^3 RJ(cn^2, dn^2, 1, 1 - n sn^2) /
/// 3 (DLMF 19.25.14: (Pi - F) / n). The characteristic n is given by `root` = sqrt(1 - n) > 0, which avoids
/// cancellation: 1 - n sn^2 = cn^2 + root^2 sn^2.
template <class Real>
long double elliptic_j(const JacobiValues<Real>& v, Real root) {
  using Wide = long double;
  const Wide sn = v.sn;
  const Wide cn = v.cn;
  const Wide dn = v.dn;
  const Wide p = cn * cn + (root * sn) * (root * sn);
  return sn * sn * sn * boost::math::ellint_rj(cn * cn, dn * dn, Wide(1), p) / 3;
}

/// The argument of theta_1(z + i alpha), z = pi u/(2 K), alpha = pi a/(2 K), 0 < a < K', up to a linear
/// function of u. Integrals of the third kind whose integrand has its poles at u = +-i a are of this form (C.
/// G. J. Jacobi; E. T. Whittaker, G. N. Watson, A Course of Modern Analysis, section 22.74). Where the nome
/// is that of k1 the function is taken by Jacobi's transformation (DLMF 20.7.30), the factor of which has a
/// linear argument.
template <class Real>
class ThetaArgument {
 public:
  /// The argument is pi/2 - atan2(x, y).
  struct Parts {
    Real x, y;
  };

  ThetaArgument() = default;
  ThetaArgument(const JacobiFunctions<Real>& jacobi, Real a)
      : hyperbolic_(jacobi.hyperbolic()), scale_(jacobi.scale()), log_nome_(jacobi.log_nome()) {
    const Real alpha = scale_ * a;
    Real sign = 1;
    for (int n = 0; n < 4; ++n, sign = -sign) {
      const Real power = n * (n + 1) * log_nome_;  // of the nome
      if (hyperbolic_) {
        // Their factors cosh and sinh need the power themselves.
        even_[n] = sign * std::cos((2 * n + 1) * alpha);
        odd_[n] = sign * std::sin((2 * n + 1) * alpha);
      } else {
        const Real up = n > 0 ? std::exp(power + 2 * n * alpha) : Real(1);
        const Real down = std::exp((n > 0 ? power : Real(0)) - (2 * n + 2) * alpha);
        even_[n] = sign * (up + down);
        odd_[n] = sign * (up - down);
      }
    }
  }

  /// For |u| <= K.
  Parts at(Real u) const { return hyperbolic_ ? hyperbolic(u) : circular(u); }

 private:
  Parts circular(Real u) const {
    const Real s = std::sin(scale_ * u), c = std::cos(scale_ * u);
    const Real s2 = 2 * s * c, c2 = (c - s) * (c + s);
    const Real s3 = s2 * c + c2 * s, c3 = c2 * c - s2 * s, s5 = s2 * c3 + c2 * s3, c5 = c2 * c3 - s2 * s3;
    const Real s7 = s2 * c5 + c2 * s5, c7 = c2 * c5 - s2 * s5;
    return {((even_[3] * s7 + even_[2] * s5) + even_[1] * s3) + even_[0] * s,
            ((odd_[3] * c7 + odd_[2] * c5) + odd_[1] * c3) + odd_[0] * c};
  }
  // Both parts over exp|v|, so that nothing overflows.
  Parts hyperbolic(Real u) const {
    const Real v = scale_ * std::abs(u);
    const Real e = std::exp(-2 * v), q = std::exp(log_nome_);
    const Real r = q > 0 ? std::exp(log_nome_ + 2 * v) : Real(0);  // q e^(2 v) <= 1
    // q^(n (n + 1)) e^(2 n v) = q^(n^2) r^n
    const Real q2 = q * q, q4 = q2 * q2;
    const Real t1 = q * r, t2 = q4 * r * r, t3 = q4 * q4 * q * r * r * r;
    const Real e2 = e * e, e3 = e2 * e, e5 = e3 * e2, e7 = e5 * e2;
    const Real x = ((even_[3] * t3 * (1 - e7) + even_[2] * t2 * (1 - e5)) + even_[1] * t1 * (1 - e3)) -
                   even_[0] * std::expm1(-2 * v);
    const Real y =
        ((odd_[3] * t3 * (1 + e7) + odd_[2] * t2 * (1 + e5)) + odd_[1] * t1 * (1 + e3)) + odd_[0] * (1 + e);
    return {std::copysign(x, u), y};
  }

  bool hyperbolic_ = false;
  Real scale_{}, log_nome_{};
  Real even_[4]{}, odd_[4]{};
};

}  // namespace gnomon::rigid_body
