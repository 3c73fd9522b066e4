#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
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

/// A load that derives from a potential of the attitude: V [J], a bound of its size `depth` [J].
template <class Load>
concept HasPotential = requires(const Load& load, const Eigen::Matrix3d& attitude) {
  load.potential(attitude);
  load.depth();
};

struct Free {
  static constexpr std::string_view kind = "none";
};

/// Weight W [N] along -z of space at the body point `centre` [m] (from the pivot): M = (A centre) x (-W e3).
struct Gravity {
  static constexpr std::string_view kind = "gravity";
  double weight;
  Vector<double> centre;

  double potential(const Eigen::Matrix3d& attitude) const { return weight * (attitude * centre)[2]; }
  double depth() const { return std::abs(weight) * centre.norm(); }
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

/// A potential on SO(3), V(Q) = k (|Q - 1| - l)^2 - a/|Q - B| with Frobenius norms, N. Bou-Rabee, G. Ortolan,
/// A. Saccon, arXiv 1005.3078: a spring to one attitude and the attraction of another. |Q - B| = sqrt(8) |u|
/// with u the vector part of the quaternion of B^T Q. At Q = 1 and Q = B it has no derivative; there the term
/// gives no moment.
struct AttitudePotential {
  static constexpr std::string_view kind = "attitude_potential";
  double stiffness;                 ///< k, J
  double rest;                      ///< l, 0 to sqrt(8)
  double attraction;                ///< a, J
  std::array<double, 4> attractor;  ///< B, unit quaternion w, x, y, z

  double potential(const Eigen::Matrix3d& attitude) const {
    const Eigen::Quaterniond q(attitude), b(attractor[0], attractor[1], attractor[2], attractor[3]);
    const double stretch = root8 * q.vec().norm() - rest;
    const double spring = stiffness * stretch * stretch;
    return attraction != 0.0 ? spring - attraction / (root8 * (b.conjugate() * q).vec().norm()) : spring;
  }
  double depth() const {
    const double stretch = std::max(rest, root8 - rest);
    return stiffness * stretch * stretch + std::abs(attraction);
  }
  Vector<double> space_moment(double, const Eigen::Matrix3d& attitude) const {
    const Eigen::Quaterniond q(attitude);
    const double coefficients[4] = {q.w(), q.x(), q.y(), q.z()};
    return attitude * body_moment(coefficients);
  }
  /// 8 k (l/(sqrt(8) |u|) - 1) u0 u - (a/(sqrt(32) |r|^3)) r0 r, with (u0, u) = q and (r0, r) = B^-1 q.
  template <class Real>
  Vector<Real> body_moment(const Real* q) const {
    using std::sqrt;
    const Vector<Real> u(q[1], q[2], q[3]);
    const Real r0 = Real(attractor[0]) * q[0] + axis().template cast<Real>().dot(u);
    const Vector<Real> r = relative(q);
    const Real length = sqrt(u.squaredNorm()), distance = sqrt(r.squaredNorm());
    const Real spring = length > 0 ? Real(root8 * stiffness * rest) / length - Real(8 * stiffness) : Real(0);
    const Real pull =
        distance > 0 ? Real(attraction / (2 * root8)) / (distance * distance * distance) : Real(0);
    return (spring * q[0]) * u - (pull * r0) * r;
  }
  Eigen::Matrix<double, 3, 4> body_moment_derivative(const double* q) const {
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    const Vector<double> u(q[1], q[2], q[3]), b = axis(), r = relative(q);
    const double b0 = attractor[0], r0 = b0 * q[0] + b.dot(u), length = u.norm(), distance = r.norm();
    Eigen::Matrix<double, 3, 4> derivative = Eigen::Matrix<double, 3, 4>::Zero();
    if (length > 0.0) {
      const double c = root8 * stiffness * rest / length, spring = c - 8.0 * stiffness;
      derivative.col(0) = spring * u;
      derivative.rightCols<3>() = q[0] * (spring * one - c / (length * length) * u * u.transpose());
    }
    if (distance > 0.0) {
      const double pull = attraction / (2 * root8) / (distance * distance * distance);
      Eigen::Matrix3d cross;
      cross << 0, -b[2], b[1], b[2], 0, -b[0], -b[1], b[0], 0;
      // d(r0 r/|r|^3) by r0 and r, times d(r0, r) by q
      const Eigen::Matrix3d by_r = r0 * (one - 3.0 / (distance * distance) * r * r.transpose());
      derivative.col(0) -= pull * (b0 * r - by_r * b);
      derivative.rightCols<3>() -= pull * (r * b.transpose() + by_r * (b0 * one - cross));
    }
    return derivative;
  }

 private:
  static constexpr double root8 = 2.0 * std::numbers::sqrt2;
  Vector<double> axis() const { return {attractor[1], attractor[2], attractor[3]}; }
  /// The vector part of B^-1 q.
  template <class Real>
  Vector<Real> relative(const Real* q) const {
    const Vector<Real> u(q[1], q[2], q[3]), b = axis().template cast<Real>();
    return Real(attractor[0]) * u - q[0] * b - b.cross(u);
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
