#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "integrators/rotation/pose.hpp"

namespace gnomon::rotation {

/// The exact motion of a free rigid body over a step, as a turn of its triad, for any principal moments.
///
/// Two equal moments: two exponentials. Else, with the axes in the order of their moments, I1 < I2 < I3, and
/// m' = (g1 m2 m3, g2 m3 m1, g3 m1 m2), the addition theorems of the Jacobi functions (DLMF 22.8) give the
/// momentum after the time t from the one before it without any inverse function:
///     m1(t) = (m1 d + g1 m2 m3 S c)/D,   m2(t) = (m2 c d + g2 m3 m1 S)/D,   m3(t) = (m3 c + g3 m1 m2 S d)/D,
///     c^2 = 1 - L S^2,   d^2 = 1 - N S^2,   D = 1 - g1 g3 m2^2 S^2,
///     L = -g2 g3 m1^2 + g1 g3 m2^2,   N = -g1 g2 m3^2 + g1 g3 m2^2   (sums of positive terms),
/// where S(t) = sn(sqrt(L) t, sqrt(N/L))/sqrt(L), an entire form of sn in L and N. The turn is that of
/// E. Celledoni, F. Fasso, N. Safstrom, A. Zanna, SIAM J. Sci. Comput. 30 (2008) 2084-2112,
///     conj(P(m(0))) (cos psi/2, s e_a sin psi/2) P(m(t)),   P(m) the shortest rotation of m to s |m| e_a,
/// a being the axis of extreme moment about which m circulates and s the sign of m_a. The rate of psi is
/// |m|/I_a - (sum over i of m_i^2 (1/I_a - 1/I_i))/(|m| + |m_a|). Steps are cut into pieces that are short
/// against the real and imaginary periods, on which a few terms of the power series of S and six Gauss nodes
/// for psi are exact to rounding. From piece to piece rounding errors grow as fast as neighbouring motions
/// part; steps of many pieces take the closed form with its elliptic functions instead.
class ExactDrift {
 public:
  static constexpr bool exact = true;
  /// Of a step; the closed form takes the time of some 45.
  static constexpr double most_pieces = 24.0;

  /// Principal moments [kg m^2], all > 0.
  explicit ExactDrift(const Vector3& inertia) {
    std::sort(axes_.begin(), axes_.end(), [&](int i, int j) { return inertia[i] < inertia[j]; });
    for (int k = 0; k < 3; ++k) inertia_[k] = inertia[axes_[k]];
    handedness_ = (axes_[0] + 1) % 3 == axes_[1] ? 1.0 : -1.0;
    const auto inverse_difference = [&](int i, int j) {  // 1/I_i - 1/I_j
      return (inertia_[j] - inertia_[i]) / (inertia_[i] * inertia_[j]);
    };
    g_ = {inverse_difference(2, 1), inverse_difference(0, 2), inverse_difference(1, 0)};
    if (g_[0] == 0.0) symmetry_axis_ = 0;
    if (g_[2] == 0.0) symmetry_axis_ = 2;
  }

  /// The turn of the body triad, in its own components, that a body with the momentum m (body components)
  /// makes in the time tau [s] of either sign. Status::diverged where the angle is beyond any use.
  Status turn(const Vector3& m, double tau, Quaternion& by) const {
    return symmetry_axis_ >= 0 ? symmetric(m, tau, by) : asymmetric(m, tau, by);
  }
  long iterations() const { return 0; }

 private:
  /// sn of the class comment at the multiples x of a time `unit`, divided by it; |x| <= 1, L unit^2 and
  /// N unit^2 <= 0.01. The numerators of the series are those of sn (DLMF 22.10.4), written in L + N and L N.
  class Sine {
   public:
    Sine(double sum, double product) {  // (L + N) unit^2, L N unit^4
      const double s = sum, p = product, s2 = s * s, p2 = p * p;
      c_ = {1.0,
            -s / 6.0,
            (s2 + 12.0 * p) / 120.0,
            -s * (s2 + 132.0 * p) / 5040.0,
            (s2 * s2 + 1224.0 * s2 * p + 3024.0 * p2) / 362880.0,
            -s * (s2 * s2 + 11064.0 * s2 * p + 132624.0 * p2) / 39916800.0,
            (s2 * s2 * s2 + 99636.0 * s2 * s2 * p + 4095792.0 * s2 * p2 + 4390848.0 * p * p2) / 6227020800.0};
    }
    double operator()(double x) const {
      const double x2 = x * x;
      double sum = c_[6];
      for (int k = 5; k >= 0; --k) sum = c_[static_cast<std::size_t>(k)] + x2 * sum;
      return x * sum;
    }

   private:
    std::array<double, 7> c_;
  };

  // exp(tau m/I) about the momentum, then the spin relative to it about the axis.
  [[gnu::noinline]] Status symmetric(const Vector3& m, double tau, Quaternion& by) const {
    const int axis = axes_[static_cast<std::size_t>(symmetry_axis_)], a = symmetry_axis_;
    const double spin = tau * m[axis] * (inertia_[1] - inertia_[a]) / (inertia_[1] * inertia_[a]);
    by = exponential(tau / inertia_[1] * m) * exponential(spin * Vector3::Unit(axis));
    return Status::ok;
  }

  [[gnu::noinline]] Status asymmetric(const Vector3& momentum, double tau, Quaternion& by) const {
    // In the right-handed triad of the ordered axes.
    Vector3 m(momentum[axes_[0]], momentum[axes_[1]], handedness_ * momentum[axes_[2]]);
    const double size = m.norm();
    by = Quaternion::Identity();
    if (size == 0.0) return Status::ok;
    const double middle = g_[0] * g_[2] * m[1] * m[1];
    const double L = middle - g_[1] * g_[2] * m[0] * m[0], N = middle - g_[0] * g_[1] * m[2] * m[2];
    const double needed = std::ceil(5.0 * std::abs(tau) * std::sqrt(std::max(L, N)));
    if (!(needed <= most_pieces && std::isfinite(size))) {
      Quaternion whole;
      const Status status = long_turn(inertia_, m, tau, whole);
      if (status == Status::ok) by = from_ordered(whole);
      return status;
    }
    const double pieces = std::max(1.0, needed), half = 0.5 * tau / pieces;

    const int a = L >= N ? 0 : 2;
    const double sign = std::copysign(1.0, m[a]);
    const double deficit =
        a == 0 ? m[2] * m[2] * g_[1] - m[1] * m[1] * g_[2] : m[1] * m[1] * g_[0] - m[0] * m[0] * g_[1];
    const Vector3 start = m;
    Vector3 change = Vector3::Zero();  // of m
    const auto advance = [&](double S) {
      change += change_of(m, S, L, N);
      m = start + change;
    };
    const Sine sine((L + N) * half * half, (L * half * half) * (N * half * half));
    constexpr double nodes[3] = {0.2386191860831969086, 0.6612093864662645137, 0.9324695142031520278};
    constexpr double weights[3] = {0.4679139345726910474, 0.3607615730481386076, 0.1713244923791703450};
    const double whole = half * sine(1.0);
    const double at_node[3] = {half * sine(nodes[0]), half * sine(nodes[1]), half * sine(nodes[2])};
    double sum = 0.0;  // of 1/(|m| + |m_a|) over the nodes
    for (double piece = 0.0; piece < pieces; piece += 1.0) {
      advance(whole);
      // The nodes lie in pairs about the middle, at which S differs in its sign alone.
      for (int k = 0; k < 3; ++k) {
        const double S = at_node[k], S2 = S * S;
        const double c = std::sqrt(1.0 - L * S2), d = std::sqrt(1.0 - N * S2);
        const double D = 1.0 - g_[0] * g_[2] * m[1] * m[1] * S2;
        const double even = size * D + sign * m[a] * (a == 0 ? d : c);
        const double odd = g_[a] * m[1] * m[2 - a] * S * (a == 0 ? c : d);
        sum += weights[k] * 2.0 * D * even / (even * even - odd * odd);
      }
      advance(whole);
    }
    const double psi = tau * size / inertia_[a] - deficit * half * sum;
    // conj(P) R (P + dP) = |P|^2 + conj(P) (dP + (R - 1)(P + dP)): what a short step turns is a sum of small
    // terms, with rounding errors as small.
    const Quaternion before = to_axis(start, a, sign, size), after = to_axis(m, a, sign, size);
    Quaternion about;  // R - 1
    about.w() = -2.0 * std::sin(0.25 * psi) * std::sin(0.25 * psi);
    about.vec() = sign * std::sin(0.5 * psi) * Vector3::Unit(a);
    Quaternion small = about * after;
    small.coeffs() += to_axis(change, a, sign, 0.0).coeffs();
    Quaternion ordered = before.conjugate() * small;
    ordered.w() += before.squaredNorm();
    ordered.normalize();
    by = from_ordered(ordered);
    return Status::ok;
  }

  /// The same for principal moments in ascending order and steps of any length, by the closed form.
  static Status long_turn(const Vector3& inertia, const Vector3& m, double tau, Quaternion& by);

  /// A rotation given in the right-handed triad of the ordered axes.
  Quaternion from_ordered(const Quaternion& ordered) const {
    Quaternion by;
    by.w() = ordered.w();
    by.vec()[axes_[0]] = ordered.x();
    by.vec()[axes_[1]] = ordered.y();
    by.vec()[axes_[2]] = handedness_ * ordered.z();
    return by;
  }

  /// m(t) - m of the class comment.
  Vector3 change_of(const Vector3& m, double S, double L, double N) const {
    const double S2 = S * S, c = std::sqrt(1.0 - L * S2), d = std::sqrt(1.0 - N * S2);
    const double e = g_[0] * g_[2] * m[1] * m[1] * S2, D = 1.0 - e;
    const double c1 = -L * S2 / (1.0 + c), d1 = -N * S2 / (1.0 + d);  // c - 1, d - 1
    return Vector3(m[0] * (d1 + e) + g_[0] * m[1] * m[2] * S * c,
                   m[1] * (c1 * d + d1 + e) + g_[1] * m[2] * m[0] * S,
                   m[2] * (c1 + e) + g_[2] * m[0] * m[1] * S * d) /
           D;
  }

  /// The shortest rotation of m to sign |m| e_a, not normalised; linear in m and its size.
  static Quaternion to_axis(const Vector3& m, int a, double sign, double size) {
    Quaternion p;
    p.w() = size + sign * m[a];
    p.vec() = sign * m.cross(Vector3::Unit(a));
    return p;
  }

  std::array<int, 3> axes_{0, 1, 2};  // from the least moment to the greatest
  double handedness_ = 1.0;           // of these axes
  int symmetry_axis_ = -1;            // in that order; the axis of a sphere is any
  Vector3 inertia_, g_;               // in that order
};

}  // namespace gnomon::rotation
