#pragma once
// Closed-form motion of a free rigid body with any principal moments, after Jacobi.
//
// Sources: E. Celledoni, F. Fasso, N. Safstrom, A. Zanna, SIAM J. Sci. Comput. 30 (2008) 2084-2112, and
// R. van Zon, J. Schofield, J. Comput. Phys. 225 (2007) 145-164. The signs here were derived anew and checked
// against independent integrations, because printed versions disagree in the third elliptic integral.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "models/rigid_body/elliptic.hpp"

namespace gnomon::rigid_body {

namespace detail {

/// Unevaluated sum high + low with about twice the digits of Real (T. J. Dekker, Numer. Math. 18 (1971) 224).
template <class Real>
struct TwoReals {
  Real high, low;
};

template <class Real>
TwoReals<Real> exact_sum(Real a, Real b) {
  const Real sum = a + b;
  const Real part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

template <class Real>
TwoReals<Real> exact_product(Real a, Real b) {
  const Real product = a * b;
  return {product, std::fma(a, b, -product)};
}

template <class Real>
TwoReals<Real> operator*(const TwoReals<Real>& a, const TwoReals<Real>& b) {
  const TwoReals<Real> p = exact_product(a.high, b.high);
  return exact_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

template <class Real>
TwoReals<Real> operator-(const TwoReals<Real>& a, const TwoReals<Real>& b) {
  const TwoReals<Real> s = exact_sum(a.high, -b.high);
  const TwoReals<Real> t = exact_sum(a.low, -b.low);
  const TwoReals<Real> u = exact_sum(s.high, s.low + t.high);
  return exact_sum(u.high, u.low + t.low);
}

}  // namespace detail

/// Exact solution of q' = 1/2 q o (0, I^-1 m), m' = m x I^-1 m for q the unit quaternion body -> space and m
/// the body components of the angular momentum, inertia I = diag(I1, I2, I3) > 0 in any order.
///
/// With G = |m|, m circulates about one of the two axes of extreme inertia, a; b is the middle axis and c the
/// other extreme one:
///     m_a = s_a A dn u,  m_b = s_b B sn u,  m_c = s_c C cn u,   u = lambda t + u0.
/// The turn about the fixed angular momentum is psi, measured against P(m), the shortest rotation taking m/G
/// to s_a e_a; s_a m_a never changes sign, so the opposite pole, where P is singular, is out of reach:
///     q(t) = q(0) conj(P(m(0))) (cos psi/2, s_a e_a sin psi/2) P(m(t)).
/// psi is elementary for two equal moments and contains an elliptic integral of the third kind otherwise.
///
/// Conditioning. On the separatrix (k1 = 0) m approaches +-e_b and never returns; near it m flips from one to
/// the other after every 2 K / lambda ~ 2 ln(4 / k1) / lambda, and k1^2 is a difference of two squares of the
/// data. A relative change eps of the data, or the roundoff of an integrator, changes k1^2 by about eps, the
/// time of each flip by eps / (k1^2 lambda) and, after n flips, the phase u by n eps / k1^2. That is a
/// property of the problem. Here the data are taken as exact and k1^2 is formed with twice the working
/// precision, so that the values returned do not suffer from it: error_bound() grows with the angle turned,
/// plus a term in n (eps / k1)^2.
template <class Real>
class ExactFreeTop {
 public:
  using Vector3 = Eigen::Matrix<Real, 3, 1>;
  using Quaternion = Eigen::Quaternion<Real>;

  /// Orientation (unit quaternion, body -> space) and body components of the angular momentum [kg m^2/s].
  struct State {
    Quaternion orientation;
    Vector3 angular_momentum;
  };

  /// Principal moments [kg m^2] and the state at t = 0. The orientation is normalised.
  /// Throws std::invalid_argument if a moment is not positive, a value is not finite or the norm of the
  /// orientation differs from 1 by more than 1e-6.
  ExactFreeTop(const Vector3& inertia, const Quaternion& orientation, const Vector3& angular_momentum)
      : initial_{orientation.normalized(), angular_momentum},
        rate_(angular_momentum.cwiseQuotient(inertia)),
        magnitude_(std::hypot(angular_momentum[0], angular_momentum[1], angular_momentum[2])) {
    if (!inertia.allFinite() || !(inertia.minCoeff() > 0))
      throw std::invalid_argument("ExactFreeTop: the moments of inertia must be finite and positive");
    if (!std::isfinite(magnitude_))
      throw std::invalid_argument("ExactFreeTop: the angular momentum must be finite");
    if (!(std::abs(orientation.norm() - 1) < Real(1e-6)))
      throw std::invalid_argument("ExactFreeTop: the orientation must be a unit quaternion");
    choose_axes(inertia);
    if (!steady_) prepare(inertia);
  }

  /// State at time t [s], of either sign.
  State at(Real t) const {
    if (steady_) return steady_state(t);
    const Real u = lambda_ * t + u0_;
    // Whole half periods 2 K are taken off; each adds a constant to psi and changes the signs of sn and cn.
    const Real quarter = jacobi_.quarter_period();
    const Real half_periods = std::nearbyint(u / (2 * quarter));
    const Real rest = half_periods == 0 ? u : std::clamp(u - half_periods * (2 * quarter), -quarter, quarter);
    const JacobiValues<Real> v = jacobi_.at(rest);
    const Real rest_of_psi =
        psi_sign_ * (half_periods * psi_half_period_ + (psi_periodic(v, rest) - psi_start_));
    const Real psi = rest_of_psi + (turns_slowly_ ? psi_rate_ / lambda_ * (rest - u0_) : psi_rate_ * t);

    const Real parity = std::fmod(half_periods, Real(2)) == 0 ? Real(1) : Real(-1);
    Vector3 m;
    m[a_] = amplitude_[0] * v.dn;
    m[b_] = parity * amplitude_[1] * v.sn;
    m[c_] = parity * amplitude_[2] * v.cn;
    Quaternion turn(std::cos(psi / 2), 0, 0, 0);
    turn.vec()[a_] = std::copysign(Real(1), amplitude_[0]) * std::sin(psi / 2);
    return {(base_ * turn * to_axis(m)).normalized(), m};
  }

  /// Upper bound of the errors of at(t) against the exact solution for the data as given: of the orientation
  /// (geodesic distance [rad]) and of the angular momentum divided by its magnitude.
  Real error_bound(Real t) const {
    const Real eps = std::numeric_limits<Real>::epsilon();
    const Real time = std::abs(t);
    if (steady_) return 4 * eps * (1 + rate_.norm() * time);
    const Real phase = lambda_ * time;
    const Real rounding = 8 * eps * (1 + 2 * std::abs(u0_) + greatest_rate_ * time);
    // An error d of k1^2 shifts each half period by about d / (2 k1^2); on the separatrix it grows
    // exponentially.
    if (separation_error_ == 0) return rounding;
    return rounding + std::min(Real(4), separation_error_ * (k1_ > 0 ? phase : std::exp(phase)));
  }

  /// Period of the body angular momentum, 4 K / lambda [s]; infinite where m is constant or on the
  /// separatrix.
  Real period() const {
    return steady_ ? std::numeric_limits<Real>::infinity() : 4 * jacobi_.quarter_period() / lambda_;
  }

  /// Complementary modulus k1 of the Jacobi functions, in [0, 1]: the distance from the separatrix, on which
  /// it is 0. A constant m has 1, or 0 if it lies along the unstable middle axis.
  Real complementary_modulus() const { return k1_; }

 private:
  State steady_state(Real t) const {
    const Real speed = rate_.stableNorm();
    Quaternion turn(std::cos(speed * t / 2), 0, 0, 0);
    if (speed > 0) turn.vec() = std::sin(speed * t / 2) * (rate_ / speed);
    return {(initial_.orientation * turn).normalized(), initial_.angular_momentum};
  }

  // Sets a, b, c, whether m is constant, and (k1 A)^2.
  void choose_axes(const Vector3& inertia) {
    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int i, int j) { return inertia[i] < inertia[j]; });
    const int low = order[0];
    const int high = order[2];
    b_ = order[1];
    const Vector3& m = initial_.angular_momentum;
    const auto uncoupled = [&](int i, int j) { return m[i] == 0 || m[j] == 0 || inertia[i] == inertia[j]; };
    steady_ = uncoupled(0, 1) && uncoupled(1, 2) && uncoupled(2, 0);
    if (steady_) {
      const bool unstable = inertia[low] < inertia[b_] && inertia[b_] < inertia[high] && m[b_] != 0;
      k1_ = unstable && m[low] == 0 && m[high] == 0 ? Real(0) : Real(1);
      return;
    }

    // G^2 - 2 T I_b = m_high^2 (I_high - I_b) / I_high - m_low^2 (I_b - I_low) / I_low decides about which
    // axis m circulates. Powers of two are taken out against overflow and underflow.
    using detail::exact_product;
    using detail::exact_sum;
    using detail::TwoReals;
    const int inertia_exponent = std::ilogb(inertia[high]);
    const auto moment = [&](int i) { return std::ldexp(inertia[i], -inertia_exponent); };
    // A term vanishes if its two moments are equal, and must not set the scale then.
    momentum_exponent_ = std::ilogb(std::max(inertia[b_] > inertia[low] ? std::abs(m[low]) : Real(0),
                                             inertia[b_] < inertia[high] ? std::abs(m[high]) : Real(0)));
    bool exact = true;
    const auto term = [&](Real upper, Real lower, Real m_i, Real inertia_j) {
      if (upper == lower) return TwoReals<Real>{Real(0), Real(0)};
      const Real scaled = std::ldexp(m_i, -momentum_exponent_);
      const TwoReals<Real> square = exact_product(scaled, scaled);
      const TwoReals<Real> difference = exact_sum(upper, -lower);
      const TwoReals<Real> product = square * difference;
      exact = exact && square.low == 0 && difference.low == 0 && product.low == 0;
      return product * TwoReals<Real>{inertia_j, Real(0)};
    };
    const TwoReals<Real> high_term = term(moment(high), moment(b_), m[high], moment(low));
    const TwoReals<Real> low_term = term(moment(b_), moment(low), m[low], moment(high));
    const Real difference = (high_term - low_term).high;
    a_ = difference >= 0 ? high : low;
    c_ = difference >= 0 ? low : high;
    separation_ = std::abs(difference) / (moment(c_) * std::abs(moment(a_) - moment(b_)));
    const Real eps = std::numeric_limits<Real>::epsilon();
    const Real size = high_term.high + low_term.high;
    separation_error_ = exact ? Real(0) : 8 * eps * eps * (difference != 0 ? size / std::abs(difference) : 2);
  }

  void prepare(const Vector3& inertia) {
    const Real i_a = inertia[a_];
    const Real i_b = inertia[b_];
    const Real i_c = inertia[c_];
    // Differences of moments come as ratios of the same sign, each with full relative accuracy.
    const Real ab_over_ac = (i_a - i_b) / (i_a - i_c);
    const Real bc_over_ac = (i_b - i_c) / (i_a - i_c);
    const Real bc_over_ab = (i_b - i_c) / (i_a - i_b);
    const Vector3& m = initial_.angular_momentum;
    const Real c_over_b = std::sqrt(i_c / i_b * ab_over_ac);
    const Real amplitude_a = std::hypot(m[a_], m[b_] * std::sqrt(i_a / i_b * bc_over_ac));
    const Real amplitude_b = std::hypot(m[b_], m[c_] / c_over_b);
    const Real amplitude_c = std::hypot(m[c_], m[b_] * c_over_b);
    b_over_c_ = 1 / c_over_b;
    r2_ = i_a / i_c * bc_over_ab;  // (B/C)^2 - 1
    k_ = std::min(Real(1), amplitude_c / amplitude_a * std::sqrt(r2_));
    k1_ = std::min(Real(1), std::ldexp(std::sqrt(separation_), momentum_exponent_) / amplitude_a);
    jacobi_ = JacobiFunctions<Real>(k_, k1_);
    lambda_ = amplitude_a / i_a * std::sqrt((i_a - i_c) / i_b * ((i_a - i_b) / i_c));

    // Euler's equations fix the sign of m_b relative to those of m_a and m_c for lambda > 0.
    const bool right_handed = (a_ + 1) % 3 == b_;
    const Real sign_a = std::copysign(Real(1), m[a_]);
    const Real sign_c = std::copysign(Real(1), m[c_]);
    const Real sign_b = right_handed == (i_c > i_a) ? sign_a * sign_c : -sign_a * sign_c;
    amplitude_ = Vector3(sign_a * amplitude_a, sign_b * amplitude_b, sign_c * amplitude_c);
    const JacobiValues<Real> start{sign_b * m[b_] / amplitude_b, std::abs(m[c_]) / amplitude_c,
                                   std::abs(m[a_]) / amplitude_a};
    u0_ = jacobi_argument(start);

    // psi' = G / I_a - (G^2 - 2 T I_a) / (G I_a) / (1 + |m_a| / G).
    psi_sign_ = i_a > i_c ? Real(1) : Real(-1);
    g_over_a_ = magnitude_ / amplitude_a;
    psi_rate_ = magnitude_ / (r2_ <= 1 ? i_c : i_a);
    const Real quarter = jacobi_.quarter_period();
    psi_half_period_ =
        std::isfinite(quarter) ? 2 * psi_by_integral({Real(1), Real(0), k1_}, quarter) : Real(0);
    if constexpr (by_theta) prepare_theta();
    psi_start_ = psi_periodic(start, u0_);
    greatest_rate_ = psi_rate_ + lambda_;
    prepare_slow_turn(i_a, i_b, i_c);
    base_ = initial_.orientation * to_axis(m).conjugate();
  }

  // Of moments that violate the triangle inequality, m may circulate about the axis of the greatest one much
  // faster than the body turns. Then psi_rate t and the rest of psi cancel, so what both gain in a half
  // period is taken from
  //     psi' = G / I_a + X / (1 + |m_a| / G),    X = (2 T - G^2 / I_a) / G,
  // whose terms are positive, by the trapezoidal rule: 1 / (1 + (A / G) dn u) has the period 2 K and no pole
  // with |Im u| < K'.
  void prepare_slow_turn(Real i_a, Real i_b, Real i_c) {
    if (i_a < i_b) return;
    const Vector3& m = initial_.angular_momentum;
    const Real excess = m[b_] * (m[b_] / magnitude_) * ((i_a - i_b) / (i_a * i_b)) +
                        m[c_] * (m[c_] / magnitude_) * ((i_a - i_c) / (i_a * i_c));
    const Real quarter = jacobi_.quarter_period();
    turns_slowly_ = std::max(psi_rate_, lambda_) > 4 * (magnitude_ / i_a + excess) && quarter < 20;
    if (!turns_slowly_) return;
    const Real pi = boost::math::constants::pi<Real>();
    const Real log_nome = jacobi_.hyperbolic() ? pi * pi / jacobi_.log_nome() : jacobi_.log_nome();
    const Real nodes = std::floor(std::log(std::numeric_limits<Real>::epsilon()) / (2 * log_nome)) + 2;
    Real mean = 0;
    for (Real node = 0; node < nodes; node += 1)
      mean += 1 / (1 + jacobi_.at((node + Real(0.5)) / nodes * quarter).dn / g_over_a_);
    psi_half_period_ = (magnitude_ / i_a + excess * (mean / nodes)) * (2 * quarter / lambda_);
    greatest_rate_ = magnitude_ / i_a + std::abs(amplitude_[2]) / i_c;
  }

  // In double precision psi is taken from a theta function, at half the cost of the integral of the third
  // kind; in extended precision, which references are made in, from the integral itself.
  static constexpr bool by_theta = std::is_same_v<Real, double>;

  // 1 + r^2 sn^2 is zero at i a.
  void prepare_theta() {
    if (!(k1_ > 0) || !(r2_ > 0)) return;
    const Real over = 1 / (1 + r2_);
    theta_ = ThetaArgument<Real>(jacobi_,
                                 jacobi_argument(JacobiValues<Real>{std::sqrt(over), std::sqrt(r2_ * over),
                                                                    std::sqrt((r2_ + k_ * k_) * over)}));
    const Real quarter = jacobi_.quarter_period();
    const auto end = theta_.at(quarter);
    theta_slope_ =
        (psi_half_period_ / 2 + std::atan2(jacobi_.hyperbolic() ? end.y : Real(0), end.x)) / quarter;
  }

  Real psi_periodic(const JacobiValues<Real>& v, Real u) const {
    if constexpr (by_theta)
      if (k1_ > 0 && r2_ > 0) {
        const auto theta = theta_.at(u);
        const Real turned = b_over_c_ * v.sn;
        return theta_slope_ * u +
               std::atan2(theta.x * v.cn - theta.y * turned, theta.y * v.cn + theta.x * turned);
      }
    return psi_by_integral(v, u);
  }

  // The part of psi other than psi_rate t, without its sign, from 0 to u, |u| <= K. The integral of the third
  // kind Pi(-r^2; u) = u - r^2 J(u) is used through J for r <= 1, its part u going into psi_rate; for r > 1,
  // where u and r^2 J nearly cancel, through Pi of the other characteristic (DLMF 19.7.9), all of whose terms
  // are positive.
  Real psi_by_integral(const JacobiValues<Real>& v, Real u) const {
    const Real angle = std::atan2(b_over_c_ * v.sn, v.cn);
    if (r2_ <= 1) {
      const Real r = std::sqrt(r2_);
      const Real j = k1_ > 0 ? static_cast<Real>(elliptic_j(v, b_over_c_))
                             : (u - (r > 0 ? std::atan(r * v.sn) / r : v.sn)) / (1 + r2_);
      return -g_over_a_ * b_over_c_ * r2_ * j - angle;
    }
    // The other characteristic is omega2, and 1 - omega2 = k1^2 / (1 + r^2).
    const Real k2 = k_ * k_;
    const Real omega2 = (k2 + r2_) / (1 + r2_);
    const Real r_omega = std::sqrt(r2_ * omega2);
    Real sum = k2 * u + r_omega * std::atan2(r_omega * v.sn * v.cn, v.dn);
    if (k1_ > 0) {
      const long double other_pi = u + omega2 * elliptic_j(v, k1_ / b_over_c_);
      const long double k1 = k1_;
      sum += static_cast<Real>(k1 * k1 * other_pi) * (r2_ / (1 + r2_));
    }
    return g_over_a_ * b_over_c_ * sum / (k2 + r2_) - angle;
  }

  // Shortest rotation taking m / |m| to s_a e_a.
  Quaternion to_axis(const Vector3& m) const {
    const Real norm = std::hypot(m[0], m[1], m[2]);
    Vector3 axis = Vector3::Zero();
    axis[a_] = std::copysign(Real(1), amplitude_[0]);
    Quaternion p;
    p.w() = 1 + std::abs(m[a_]) / norm;
    p.vec() = (m / norm).cross(axis);
    return p.normalized();
  }

  State initial_;
  Vector3 rate_;    // angular velocity at t = 0, body components
  Real magnitude_;  // G
  bool steady_{};   // m is constant
  int a_{}, b_{}, c_{};
  int momentum_exponent_{};
  Real separation_{};        // (k1 A)^2 / 4^momentum_exponent_
  Real separation_error_{};  // relative error of separation_; absolute, over A^2, if that is 0
  Real k1_{}, k_{};
  JacobiFunctions<Real> jacobi_{Real(0), Real(1)};
  Real lambda_{}, u0_{};
  Vector3 amplitude_ = Vector3::Zero();
  Real r2_{}, b_over_c_{1}, g_over_a_{1};
  Real psi_sign_{1}, psi_rate_{}, psi_start_{};
  Real psi_half_period_{};  // what psi gains in a half period of m; without psi_rate t unless turns_slowly_
  bool turns_slowly_ = false;
  Real greatest_rate_{};  // that rounding errors grow with: of psi and u, or of the body
  ThetaArgument<Real> theta_;
  Real theta_slope_{};
  Quaternion base_ = Quaternion::Identity();
};

}  // namespace gnomon::rigid_body
