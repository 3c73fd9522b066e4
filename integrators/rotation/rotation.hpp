#pragma once
#include <Eigen/Core>
#include <cmath>
#include <concepts>

#include "integrators/rotation/sinc_coefficients.hpp"
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

/// sin(x)/x and (1 - cos x)/x^2 as functions of x^2: up to the limit polynomials, exact to rounding and
/// smooth through 0; above by the half angle.
struct Sinc {
  double sine;     ///< sin(x)/x
  double versine;  ///< (1 - cos x)/x^2
};

inline Sinc sinc(double square) {
  if (square > sinc_limit) {
    const double angle = std::sqrt(square), half = std::sin(0.5 * angle);
    return {std::sin(angle) / angle, 2.0 * half * half / square};
  }
  // Estrin's scheme: the powers side by side, because a step waits for the result.
  const double square2 = square * square, square4 = square2 * square2;
  const auto sum = [&](const double(&c)[8]) {
    return ((c[0] + c[1] * square) + (c[2] + c[3] * square) * square2) +
           ((c[4] + c[5] * square) + (c[6] + c[7] * square) * square2) * square4;
  };
  return {sum(sine_coefficients), sum(versine_coefficients)};
}

/// A vector whose components stay in registers of their own. Eigen packs two of three into one, and a step of
/// a single body waits for each packing and unpacking.
struct Triple {
  double x, y, z;
  Triple(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
  explicit Triple(const Vector3& a) : x(a[0]), y(a[1]), z(a[2]) {}
  Vector3 vector() const { return {x, y, z}; }
};

inline Triple operator+(const Triple& a, const Triple& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Triple operator-(const Triple& a, const Triple& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Triple operator*(double factor, const Triple& a) { return {factor * a.x, factor * a.y, factor * a.z}; }
/// Component by component.
inline Triple product(const Triple& a, const Triple& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Triple cross(const Triple& a, const Triple& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// rot(p, .) of Munjiza (5.68), the rotation by the rotation vector p [rad], without the division by |p|, as
/// a matrix: 1 + (sin|p|/|p|) hat(p) + ((1 - cos|p|)/|p|^2) hat(p)^2. The kernels of ensembles do the same
/// operations in the same order and get the same bits.
class Rotation {
 public:
  explicit Rotation(const Vector3& p) : Rotation(Triple(p)) {}
  explicit Rotation(const Triple& p) {
    const double xx = p.x * p.x, yy = p.y * p.y, zz = p.z * p.z;
    const auto [sine, versine] = sinc((xx + yy) + zz);
    const Triple s = sine * p;
    const double xy = versine * (p.x * p.y), xz = versine * (p.x * p.z), yz = versine * (p.y * p.z);
    xx_ = 1.0 - versine * (yy + zz), xy_ = xy - s.z, xz_ = xz + s.y;
    yx_ = xy + s.z, yy_ = 1.0 - versine * (xx + zz), yz_ = yz - s.x;
    zx_ = xz - s.y, zy_ = yz + s.x, zz_ = 1.0 - versine * (xx + yy);
  }

  Triple operator()(const Triple& a) const {
    return {(xx_ * a.x + xy_ * a.y) + xz_ * a.z, (yx_ * a.x + yy_ * a.y) + yz_ * a.z,
            (zx_ * a.x + zy_ * a.y) + zz_ * a.z};
  }
  Triple inverse(const Triple& a) const {
    return {(xx_ * a.x + yx_ * a.y) + zx_ * a.z, (xy_ * a.x + yy_ * a.y) + zy_ * a.z,
            (xz_ * a.x + yz_ * a.y) + zz_ * a.z};
  }
  Vector3 operator()(const Vector3& a) const { return (*this)(Triple(a)).vector(); }
  Vector3 inverse(const Vector3& a) const { return inverse(Triple(a)).vector(); }
  /// The same as a matrix R.
  Matrix3 matrix() const {
    Matrix3 R;
    R << xx_, xy_, xz_, yx_, yy_, yz_, zx_, zy_, zz_;
    return R;
  }
  /// A R.
  Matrix3 after(const Matrix3& A) const {
    Matrix3 product;
    for (int row = 0; row < 3; ++row) {
      const Triple turned = inverse(Triple(A(row, 0), A(row, 1), A(row, 2)));
      product(row, 0) = turned.x, product(row, 1) = turned.y, product(row, 2) = turned.z;
    }
    return product;
  }

 private:
  double xx_, xy_, xz_, yx_, yy_, yz_, zx_, zy_, zz_;
};

}  // namespace rotation
}  // namespace gnomon
