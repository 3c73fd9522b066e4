#include "models/rigid_body/heavy_symmetric_top_constants.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gnomon::rigid_body {
namespace {

/// Arithmetic on WideReal.
struct Wide {
  WideReal v{0, 0};
  Wide() = default;
  Wide(long double x) : v{x, 0} {}
  Wide(const WideReal& x) : v(x) {}
  explicit operator long double() const { return v.high; }
};

Wide operator-(const Wide& a) { return WideReal{-a.v.high, -a.v.low}; }
Wide operator-(const Wide& a, const Wide& b) { return a.v - b.v; }
Wide operator+(const Wide& a, const Wide& b) { return a - (-b); }
Wide operator*(const Wide& a, const Wide& b) { return a.v * b.v; }
Wide operator/(const Wide& a, const Wide& b) {
  Wide q = a.v.high / b.v.high;
  for (int k = 0; k < 2; ++k) q = q + Wide((a - q * b).v.high / b.v.high);
  return q;
}
bool operator<(const Wide& a, const Wide& b) { return (a - b).v.high < 0; }
Wide root(const Wide& a) {
  if (!(a.v.high > 0)) return {};
  const Wide r = std::sqrt(a.v.high);
  return r + (a - r * r) / (r + r);
}

/// f[0] + f[1] e + f[2] e^2 + f[3] e^3.
template <class Real>
Real value(const std::array<Real, 4>& f, const Real& e) {
  return ((f[3] * e + f[2]) * e + f[1]) * e + f[0];
}
template <class Real>
Real slope(const std::array<Real, 4>& f, const Real& e) {
  return (Real(3) * f[3] * e + Real(2) * f[2]) * e + f[1];
}

/// The root next to `from`, outside of all roots, by Newton's method, which comes nearer from there without
/// ever passing it.
Wide outer_root(const std::array<Wide, 4>& f, const Wide& from) {
  std::array<long double, 4> rounded;
  for (std::size_t k = 0; k < 4; ++k) rounded[k] = f[k].v.high;
  long double e = from.v.high;
  const long double direction = value(rounded, e) > 0 ? -1 : 1;
  for (int k = 0; k < 500; ++k) {
    const long double next = e - value(rounded, e) / slope(rounded, e);
    if (!((next - e) * direction > 0)) break;
    e = next;
  }
  Wide wide = e;
  for (int k = 0; k < 4; ++k) {
    const Wide steepness = slope(f, wide);
    if (!(steepness.v.high > 0)) break;
    wide = wide - value(f, wide) / steepness;
  }
  return wide;
}

/// Both roots, ascending, of a quadratic with their sum and their product <= 0, and their distance.
struct Pair {
  Wide lesser, greater, distance;
};
Pair pair_of(const Wide& sum, const Wide& product) {
  const Wide distance = root(sum * sum - Wide(4) * product);
  const Wide half = Wide(0.5L);
  if (sum.v.high > 0) {
    const Wide greater = half * (sum + distance);
    return {product / greater, greater, distance};
  }
  const Wide lesser = half * (sum - distance);
  return {lesser, lesser.v.high < 0 ? product / lesser : Wide(), distance};
}

}  // namespace

Eigen::Quaterniond top_axes(int axis, bool upright) {
  const double turn = axis == 0 ? 0.5 : -0.5;
  const Eigen::Quaterniond cycle =
      axis == 2 ? Eigen::Quaterniond::Identity() : Eigen::Quaterniond(0.5, turn, turn, turn);
  return upright ? cycle : Eigen::Quaterniond(cycle * Eigen::Quaterniond(0, 1, 0, 0));
}

HeavyTopData HeavyTopData::of(const Eigen::Vector3d& inertia, double weight, double height, int axis,
                              const Eigen::Quaterniond& orientation,
                              const Eigen::Vector3d& angular_momentum) {
  const bool upright = weight * height > 0.0;
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  const Eigen::Vector3d& m = angular_momentum;
  const long double sign = upright ? 1 : -1;
  std::array<Wide, 4> q{Wide(orientation.w()), Wide(orientation.x()), Wide(orientation.y()),
                        Wide(orientation.z())};
  if (axis != 2) {
    // times (1/2) (1, s, s, s)
    const Wide s = axis == 0 ? 0.5L : -0.5L, half = 0.5L;
    q = {half * q[0] - s * (q[1] + q[2] + q[3]), half * q[1] + s * (q[0] + q[2] - q[3]),
         half * q[2] + s * (q[0] + q[3] - q[1]), half * q[3] + s * (q[0] + q[1] - q[2])};
  }
  if (!upright) q = {-q[1], q[0], q[3], -q[2]};
  const WideReal torque =
      detail::exact_product<long double>(std::abs(weight), std::abs(static_cast<long double>(height)));
  return {inertia[a],
          inertia[axis],
          torque,
          {q[0].v, q[1].v, q[2].v, q[3].v},
          {m[a], sign * m[b], sign * m[axis]}};
}

HeavyTopConstants heavy_top_constants(const HeavyTopData& data) {
  const Wide w = data.orientation[0], x = data.orientation[1], y = data.orientation[2],
             z = data.orientation[3];
  const Wide m1 = data.angular_momentum[0], m2 = data.angular_momentum[1], l3 = data.angular_momentum[2];
  const Wide two = 2;
  bool exact = true;
  const auto noted = [&](const Wide& value) {
    exact = exact && value.v.low == 0;
    return value;
  };

  // The vertical in the body is (g1, g2, z), all here times the square of the quaternion.
  const Wide square = noted(w * w + x * x + y * y + z * z), below_n = noted(two * (x * x + y * y));
  const Wide above = two * (w * w + z * z) / square, below = below_n / square;
  const Wide g1 = two * (x * z - w * y), g2 = two * (y * z + w * x);
  const Wide perpendicular = noted(m1 * m1 + m2 * m2), across = noted(m1 * g1 + m2 * g2);
  const Wide torque = data.torque, f3 = noted(two * Wide(data.transverse) * torque);
  const Wide difference = noted(across - noted(l3 * below_n)) / square, sum = across / square + l3 * above;
  const Wide left = noted(noted(perpendicular * square) - noted(f3 * below_n)) / square;  // P1
  const Wide incline = (m2 * g1 - m1 * g2) / square;                                      // I1 z'
  const Wide slope0 = incline * incline;
  const Wide z0 = Wide(0.5L) * (above - below);

  HeavyTopConstants c{};
  c.steady = true;
  c.sum = sum.v.high;
  c.difference = difference.v.high;
  c.above = c.up = above.v.high;
  c.below = c.down = below.v.high;
  c.transverse_most = std::sqrt(perpendicular.v.high);
  const Wide f1 = two * l3 * across / square - two * z0 * perpendicular - f3 * above * below;
  if (slope0.v.high == 0 && f1.v.high == 0) return c;

  // In e = z - 1.
  const std::array<Wide, 4> f{-(difference * difference), two * (difference * l3 - left),
                              two * f3 - left - l3 * l3, f3};
  const Wide inflection = -f[2] / (Wide(3) * f3);
  // Distances: of z1, z2 and z3 from the initial z, and of z3 from 1 and from z2.
  Wide to_first, to_second, to_third, beyond, separation, least_down;
  if (value(f, inflection).v.high > 0) {
    // z2 is nearer to z3 than to z1.
    const Wide e1 = c.sum == 0 ? Wide(-2) : outer_root(f, Wide(-2));
    const Wide product = f[0] / (-f3 * e1);
    const Pair others = pair_of((f[1] / f3 - product) / e1, product);
    separation = others.distance;
    beyond = others.greater;
    least_down = -others.lesser;
    to_third = below + beyond;
    to_first = -e1 - below;
    to_second = below - least_down;
    // The lesser one from their product.
    if (to_first < to_second)
      to_first = slope0 / (f3 * to_second * to_third);
    else
      to_second = slope0 / (f3 * to_first * to_third);
  } else {
    const bool third_is_one = c.difference == 0 && !(left.v.high > 0);
    const Wide bound =
        Wide(1) + Wide((std::abs(f[0].v.high) + std::abs(f[1].v.high) + std::abs(f[2].v.high)) / f3.v.high);
    beyond = third_is_one ? Wide() : outer_root(f, bound);
    to_third = below + beyond;
    const Wide product = -slope0 / (f3 * to_third);
    // By the formula with the smaller rounding errors.
    const Wide total = to_third.v.high > 1 ? (f1 / f3 - product) / to_third
                                           : (perpendicular - two * f3 * z0 + l3 * l3) / f3 - to_third;
    const Pair others = pair_of(total, product);
    to_first = -others.lesser;
    to_second = others.greater;
    separation = to_third - to_second;
    least_down = below - to_second;
    if (to_second.v.high > c.below / 2 && beyond.v.high > 0)
      least_down = difference * difference / (f3 * (below + to_first) * beyond);
  }
  Wide least_up = above - to_first;
  if (to_first.v.high > c.above / 2) least_up = sum * sum / (f3 * (above + to_second) * (above + to_third));

  const auto positive = [](const Wide& a) { return std::max(a.v.high, 0.0L); };
  const Wide range = to_first + to_second, all = to_first + to_third;
  c.range = positive(range);
  c.steady = !(c.range > 0);
  c.up = positive(least_up);
  c.down = positive(least_down);
  if (c.steady) return c;
  c.transverse_most = std::sqrt(positive(perpendicular + f3 * to_first));
  c.rate = std::sqrt((torque * all / Wide(2 * data.transverse)).v.high);
  c.k = std::sqrt(std::min(1.0L, (range / all).v.high));
  c.k1 = std::sqrt(std::min(1.0L, positive(separation / all)));
  c.v = {std::copysign(std::sqrt(positive(to_first / range)), incline.v.high),
         std::sqrt(positive(to_second / range)), std::sqrt(positive(to_third / all))};
  const long double eps = std::numeric_limits<long double>::epsilon();
  const long double size =
      2 + (perpendicular.v.high + data.angular_momentum[2] * data.angular_momentum[2]) / f3.v.high;
  c.separation_error = exact ? 0 : 16 * eps * eps * size / (c.k1 > 0 ? c.k1 * c.k1 * all.v.high : 1);
  return c;
}

}  // namespace gnomon::rigid_body
