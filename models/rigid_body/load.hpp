#pragma once
#include <Eigen/Core>
#include <string_view>

namespace gnomon::rigid_body {

/// Loads are types, so that a free body evaluates no moment. Each gives the moment about the reference point
/// as a spatial vector from the attitude (rotation schemes) and as a body vector from the quaternion (ODE and
/// DAE forms), both in N m. `attitude` is body -> space; the quaternion is (w, x, y, z), its norm 1 on the
/// exact motion.
template <class Real>
using Vector = Eigen::Matrix<Real, 3, 1>;

/// R(q)^T e3 for a quaternion of any norm (then times |q|^2), and its derivative by q, one column a
/// component.
template <class Real>
Vector<Real> third_row(const Real* q) {
  return {2 * (q[1] * q[3] - q[0] * q[2]), 2 * (q[2] * q[3] + q[0] * q[1]),
          q[0] * q[0] - q[1] * q[1] - q[2] * q[2] + q[3] * q[3]};
}

/// R(q)^T v for a quaternion of any norm (then times |q|^2).
template <class Real>
Vector<Real> to_body(const Real* q, const Vector<Real>& v) {
  const Vector<Real> u(q[1], q[2], q[3]);
  return (q[0] * q[0] - u.squaredNorm()) * v + 2 * u.dot(v) * u - 2 * q[0] * u.cross(v);
}

/// The derivative of R(q)^T v by q: 3 x 4.
inline Eigen::Matrix<double, 3, 4> to_body_derivative(const double* q, const Vector<double>& v) {
  const Vector<double> u(q[1], q[2], q[3]);
  Eigen::Matrix<double, 3, 4> derivative;
  derivative.col(0) = 2 * q[0] * v - 2 * u.cross(v);
  for (int k = 0; k < 3; ++k) {
    const Vector<double> e = Vector<double>::Unit(k);
    derivative.col(k + 1) = -2 * u[k] * v + 2 * v[k] * u + 2 * u.dot(v) * e - 2 * q[0] * e.cross(v);
  }
  return derivative;
}

struct Free {
  static constexpr std::string_view kind = "none";
};

/// Weight W [N] along -z of space at the body point `centre` [m] (from the pivot): M = (A centre) x (-W e3).
struct Gravity {
  static constexpr std::string_view kind = "gravity";
  double weight;
  Vector<double> centre;

  Vector<double> space_moment(double, const Eigen::Matrix3d& attitude) const {
    return (attitude * centre).cross(Vector<double>(0, 0, -weight));
  }
  template <class Real>
  Vector<Real> body_moment(const Real* q) const {
    return centre.cast<Real>().cross(Vector<Real>(-Real(weight) * third_row(q)));
  }
  Eigen::Matrix<double, 3, 4> body_moment_derivative(const double* q) const {
    const Eigen::Matrix<double, 3, 4> row = to_body_derivative(q, Vector<double>(0, 0, -weight));
    Eigen::Matrix<double, 3, 4> derivative;
    for (int k = 0; k < 4; ++k) derivative.col(k) = centre.cross(Vector<double>(row.col(k)));
    return derivative;
  }
};

/// A moment [N m] that is constant in space.
struct SpaceMoment {
  static constexpr std::string_view kind = "space_moment";
  Vector<double> moment;

  Vector<double> space_moment(double, const Eigen::Matrix3d&) const { return moment; }
  template <class Real>
  Vector<Real> body_moment(const Real* q) const {
    return to_body<Real>(q, moment.cast<Real>());
  }
  Eigen::Matrix<double, 3, 4> body_moment_derivative(const double* q) const {
    return to_body_derivative(q, moment);
  }
};

/// A moment [N m] that is constant in the body.
struct BodyMoment {
  static constexpr std::string_view kind = "body_moment";
  Vector<double> moment;

  Vector<double> space_moment(double, const Eigen::Matrix3d& attitude) const { return attitude * moment; }
  template <class Real>
  Vector<Real> body_moment(const Real*) const {
    return moment.cast<Real>();
  }
  Eigen::Matrix<double, 3, 4> body_moment_derivative(const double*) const {
    return Eigen::Matrix<double, 3, 4>::Zero();
  }
};

}  // namespace gnomon::rigid_body
