#pragma once
#include <limits>

#include "integrators/rotation/rotation.hpp"

namespace gnomon::rotation {

/// x of A x = b by Cramer's rule; not finite where A is singular.
inline Vector3 solve(const Matrix3& A, const Vector3& b) {
  const Vector3 a0 = A.col(0), a1 = A.col(1), a2 = A.col(2), a12 = a1.cross(a2);
  return Vector3(b.dot(a12), a0.dot(b.cross(a2)), a0.dot(a1.cross(b))) / a0.dot(a12);
}

/// The matrix of x -> v x x.
inline Matrix3 cross_matrix(const Vector3& v) {
  Matrix3 V;
  V << 0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0;
  return V;
}

/// D where the turn by x + dx is that by x followed by that by D dx, all in one frame:
///     1 + (1 - cos|x|)/|x|^2 hat(x) + (|x| - sin|x|)/|x|^3 hat(x)^2.
/// Exact to rounding, because Newton's method multiplies its errors by the ratio of the moments of inertia.
inline Matrix3 left_derivative(const Vector3& x) {
  const double square = x.squaredNorm();
  const auto [sine, versine] = sinc(square);
  // The rounding of 1 - sine is multiplied by x^2.
  const double cubic = square > 0.0 ? (1.0 - sine) / square : 1.0 / 6.0;
  const Matrix3 X = cross_matrix(x);
  return Matrix3::Identity() + versine * X + cubic * (X * X);
}

/// Tells when the corrections of an iteration have come down to rounding.
class Corrections {
 public:
  enum class Verdict { go_on, done, failed };

  /// Greatest components of the correction just made and of the corrected unknown.
  Verdict add(double change, double size) {
    constexpr double eps = std::numeric_limits<double>::epsilon();
    ++count_;
    if (change <= 4.0 * eps * size) return Verdict::done;
    if (!(size < 1e100) || count_ >= 50) return Verdict::failed;
    // The next correction is about change^2/previous or smaller; or rounding has stopped the progress.
    if (count_ > 1 && change * (change / previous_) <= 0.1 * eps * size) return Verdict::done;
    if (count_ > 2 && change >= 0.5 * previous_ && change <= 1e3 * eps * size) return Verdict::done;
    previous_ = change;
    return Verdict::go_on;
  }

 private:
  int count_ = 0;
  double previous_ = 0.0;
};

}  // namespace gnomon::rotation
