#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "integrators/rotation/rotation.hpp"
#include "src/scheme.hpp"

namespace gnomon::rotation {

using Quaternion = Eigen::Quaterniond;

/// The unit quaternion of the rotation by the rotation vector p [rad].
inline Quaternion exponential(const Vector3& p) {
  const double square = 0.25 * p.squaredNorm();  // of half the angle
  const Sinc half = sinc(square);
  Quaternion q;
  q.w() = 1.0 - square * half.versine;
  q.vec() = 0.5 * half.sine * p;
  return q;
}

/// The unit quaternion (1, c)/|(1, c)|: the rotation about c by the angle 2 atan|c|, the Cayley map of 2 c.
inline Quaternion cayley(const Vector3& c) {
  const double w = 1.0 / std::sqrt(1.0 + c.squaredNorm());
  Quaternion q;
  q.w() = w;
  q.vec() = w * c;
  return q;
}

/// Brings q back to norm 1, but leaves it as it is to the last bit where it is there within rounding: a body
/// at rest stays where it is.
inline void normalize(Quaternion& q) {
  const double square = q.squaredNorm();
  if (std::abs(square - 1.0) > 8.0 * std::numeric_limits<double>::epsilon()) q.coeffs() /= std::sqrt(square);
}

/// Attitude and angular momentum, the latter in space, where a free body keeps it.
struct Pose {
  Quaternion orientation;  ///< body -> space, unit
  Matrix3 attitude;        ///< its matrix A
  Vector3 momentum;        ///< H, space components, kg m^2/s

  /// m = A^T H, body components.
  Vector3 body_momentum() const { return attitude.transpose() * momentum; }
  /// Turns the body by a unit quaternion given in its own triad.
  void turn(const Quaternion& by) {
    orientation = orientation * by;
    normalize(orientation);
    attitude = orientation.toRotationMatrix();
  }
};

/// The pose of a model's state and back.
template <RotationForm M>
Pose pose_of(const typename M::State& state) {
  const Quaternion q = Quaternion(Matrix3(state.attitude)).normalized();
  return {q, q.toRotationMatrix(), state.attitude * state.angular_momentum};
}
template <RotationForm M>
typename M::State state_of(const Pose& pose) {
  return {pose.attitude, pose.body_momentum()};
}

}  // namespace gnomon::rotation
