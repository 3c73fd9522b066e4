#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace gnomon::rigid_body {

/// The state that every scheme starts from and is compared by.
struct State {
  Eigen::Matrix3d attitude;          ///< A, body -> space; its columns are the body triad
  Eigen::Vector3d angular_momentum;  ///< body components, kg m^2/s
};

/// The matrix of a quaternion (w, x, y, z) of any norm, which stays in it: A^T A = |q|^4.
inline Eigen::Matrix3d homogeneous_matrix(const double* q) {
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  Eigen::Matrix3d A;
  A << w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y),  //
      2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x),   //
      2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z;
  return A;
}

/// |v|, also where squares of the components would leave the range of double; not finite if one of them is
/// not. The scaling is by a power of two: elsewhere every digit is that of the plain norm.
inline double scaled_norm(const Eigen::Vector3d& v) {
  const double size = v.lpNorm<1>();
  if (!(size > 0.0) || !std::isfinite(size)) return size;
  const int exponent = std::ilogb(size);
  const Eigen::Vector3d scaled = v.unaryExpr([&](double x) { return std::ldexp(x, -exponent); });
  return std::ldexp(scaled.norm(), exponent);
}

/// The unit quaternion of an attitude, w >= 0.
inline Eigen::Quaterniond unit_quaternion(const Eigen::Matrix3d& attitude) {
  Eigen::Quaterniond q(attitude);
  q.normalize();
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  return q;
}

/// y = (q, m) of the ODE form.
inline void pack_state(const State& state, double* y) {
  const Eigen::Quaterniond q = unit_quaternion(state.attitude);
  y[0] = q.w(), y[1] = q.x(), y[2] = q.y(), y[3] = q.z();
  for (int k = 0; k < 3; ++k) y[4 + k] = state.angular_momentum[k];
}
inline State unpack_state(const double* y) {
  return {homogeneous_matrix(y), Eigen::Vector3d(y[4], y[5], y[6])};
}

/// The angle [rad, 0 to pi] of the rotation that takes one attitude to the other; accurate to rounding at
/// every angle.
inline double geodesic_angle(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  const Eigen::Quaterniond q = unit_quaternion(a), r = unit_quaternion(b);
  const Eigen::Quaterniond relative = q.conjugate() * r;
  return 2.0 * std::atan2(relative.vec().norm(), std::abs(relative.w()));
}

}  // namespace gnomon::rigid_body
