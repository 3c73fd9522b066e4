#pragma once
#include <Eigen/Core>
#include <cmath>
#include <concepts>

#include "src/model.hpp"

namespace gnomon {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

namespace rotation {

/// What the rotation schemes need of a model: its attitude A (body -> space), the principal inertia in the
/// body triad [kg m^2] and, where it has a load, the spatial moment [N m] at a time and an attitude.
template <class M>
concept RotationForm = Model<M> &&
    requires(const M& model, const typename M::State& state, double t, const Matrix3& attitude) {
  { model.inertia() } -> std::convertible_to<Vector3>;
  { M::has_moment } -> std::convertible_to<bool>;
  { model.moment(t, attitude) } -> std::convertible_to<Vector3>;
  { state.attitude } -> std::convertible_to<Matrix3>;
  { state.angular_momentum } -> std::convertible_to<Vector3>;  // body components, kg m^2/s
};

/// sin(x)/x and (1 - cos x)/x^2 as functions of x^2. Up to x = 1 rad their power series, cut where the first
/// term left out is below 1e-17 of the sum, so that they are exact to rounding and smooth through 0; above,
/// by the half angle.
struct Sinc {
  double sine;     ///< sin(x)/x
  double versine;  ///< (1 - cos x)/x^2
};

inline Sinc sinc(double square) {
  if (square > 1.0) {
    const double angle = std::sqrt(square), half = std::sin(0.5 * angle);
    return {std::sin(angle) / angle, 2.0 * half * half / square};
  }
  // Estrin's scheme: the powers side by side, because a step waits for the result.
  const auto sum = [](const double(&c)[9], double s, double s2, double s4) {
    return ((c[0] + c[1] * s) + (c[2] + c[3] * s) * s2) +
           (((c[4] + c[5] * s) + (c[6] + c[7] * s) * s2) + c[8] * s4) * s4;
  };
  constexpr double sine[9] = {1.0,
                              -1.0 / 6,
                              1.0 / 120,
                              -1.0 / 5040,
                              1.0 / 362880,
                              -1.0 / 39916800,
                              1.0 / 6227020800,
                              -1.0 / 1307674368000,
                              1.0 / 355687428096000};
  constexpr double versine[9] = {1.0 / 2,
                                 -1.0 / 24,
                                 1.0 / 720,
                                 -1.0 / 40320,
                                 1.0 / 3628800,
                                 -1.0 / 479001600,
                                 1.0 / 87178291200,
                                 -1.0 / 20922789888000,
                                 1.0 / 6402373705728000};
  const double square2 = square * square, square4 = square2 * square2;
  return {sum(sine, square, square2, square4), sum(versine, square, square2, square4)};
}

/// rot(p, .) of Munjiza (5.68), the rotation by the rotation vector p [rad], written without the division by
/// |p|: rot(p, a) = a + (sin|p|/|p|) p x a + ((1 - cos|p|)/|p|^2) p x (p x a).
class Rotation {
 public:
  explicit Rotation(const Vector3& p) : p_(p), factor_(sinc(p.squaredNorm())) {}

  Vector3 operator()(const Vector3& a) const {
    const Vector3 pa = p_.cross(a);
    return a + factor_.sine * pa + factor_.versine * p_.cross(pa);
  }
  Vector3 inverse(const Vector3& a) const {
    const Vector3 pa = p_.cross(a);
    return a - factor_.sine * pa + factor_.versine * p_.cross(pa);
  }
  /// The same as a matrix.
  Matrix3 matrix() const {
    const double s = factor_.sine, c = factor_.versine, x = p_[0], y = p_[1], z = p_[2];
    Matrix3 R;
    R << 1.0 - c * (y * y + z * z), c * x * y - s * z, c * x * z + s * y,  //
        c * x * y + s * z, 1.0 - c * (x * x + z * z), c * y * z - s * x,   //
        c * x * z - s * y, c * y * z + s * x, 1.0 - c * (x * x + y * y);
    return R;
  }

 private:
  Vector3 p_;
  Sinc factor_;
};

}  // namespace rotation
}  // namespace gnomon
