#pragma once
#include <Eigen/Dense>
#include <optional>
#include <vector>

#include "models/rigid_body/ode.hpp"

namespace gnomon::rigid_body {

/// A heavy top in absolute coordinates: a body that moves freely in space, with its pivot as a constraint.
/// x, v are position and velocity of the centre of mass in space, q the quaternion, m the angular momentum
/// about the centre of mass in the body, J the inertia about it, w = J^-1 m, c the centre of mass seen from
/// the pivot in the body. With g(x, q) = x - A c = 0:
///   x' = v + mu',  q' = 1/2 q o (0, w + u) + s' q,  u = -c x A^T mu' / |c|^2,
///   M v' = -W e3 + lambda',  m' = m x w - c x A^T lambda',
///   0 = x - A c,  0 = v - A (w x c),  0 = 1/2 (q.q - 1),
/// y = (x, q, v, m, s, lambda, mu). This is the stabilised form of C.W. Gear, B. Leimkuhler, G.K. Gupta, J.
/// Comput. Appl. Math. 12-13 (1985) 77-90, with the primitives of the multipliers as unknowns, which makes it
/// index 1; mu and s stay 0 on the exact motion, lambda is the impulse of the pivot's force. Not stabilised,
/// it is the textbook form of index 3: the pivot's force lambda itself as unknown, no mu, and only 0 = g. The
/// motion does not depend on the mass M [kg]; M = W/g with g = 9.81 m/s^2.
template <bool stabilised>
class AbsoluteDaeForm {
 public:
  AbsoluteDaeForm(const Vector<double>& inertia, const Gravity& load, double momentum_scale)
      : inertia_(inertia),
        c_(load.centre),
        weight_(load.weight),
        mass_(mass(load)),
        J_(central_inertia(inertia, load)),
        inverse_(J_.inverse()),
        momentum_scale_(momentum_scale) {}

  /// Inertia about the centre of mass; the form needs it positive definite.
  static Eigen::Matrix3d central_inertia(const Vector<double>& inertia, const Gravity& load) {
    const Vector<double>& c = load.centre;
    return Eigen::Matrix3d(inertia.asDiagonal()) -
           mass(load) * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
  }

  int size() const { return stabilised ? 20 : 17; }
  std::optional<SparsePattern> sparsity() const { return std::nullopt; }
  std::vector<int> algebraic() const {
    std::vector<int> kinds(size(), 0);
    if constexpr (!stabilised) kinds[L] = kinds[L + 1] = kinds[L + 2] = 1;
    return kinds;
  }
  std::vector<double> scales() const {
    const double length = c_.norm(), rate = momentum_scale_ / inertia_.maxCoeff();
    std::vector<double> scales(size(), 1.0);
    for (int k = 0; k < 3; ++k) {
      scales[X + k] = length;
      scales[V + k] = length * rate;
      scales[P + k] = momentum_scale_;
      scales[L + k] = stabilised ? mass_ * length * rate : mass_ * length * rate * rate + weight_;
      if constexpr (stabilised) scales[U + k] = length;
    }
    return scales;
  }

  void pack(double, const State& state, double* y) const {
    std::fill(y, y + size(), 0.0);
    double pivot[7];
    pack_state(state, pivot);
    std::copy(pivot, pivot + 4, y + Q);
    const Vector<double> w = state.angular_momentum.cwiseQuotient(inertia_);
    put(y + X, rotated(y + Q, c_));
    put(y + V, rotated(y + Q, Vector<double>(w.cross(c_))));
    put(y + P, J_ * w);
    if constexpr (!stabilised) {
      double rate[17];
      resume(0.0, y, rate);
    }
  }
  /// The angular momentum about the pivot, from both of its parts.
  State unpack(double, const double* y) const {
    const Vector<double> momentum = at(y + P) + mass_ * c_.cross(to_body(y + Q, at(y + V)));
    return {homogeneous_matrix(y + Q), momentum};
  }

  /// Loads do not jump: the rates of the exact motion.
  void resume(double, double* y, double* rate) const {
    std::fill(rate, rate + size(), 0.0);
    const double* q = y + Q;
    const Vector<double> w = inverse_ * at(y + P), down(0, 0, -weight_);
    const Vector<double> moment = c_.cross(to_body(q, down));
    const Vector<double> turn =
        (moment - w.cross(Vector<double>(w.cwiseProduct(inertia_)))).cwiseQuotient(inertia_);
    const Vector<double> acceleration =
        rotated(q, Vector<double>(turn.cross(c_) + w.cross(Vector<double>(w.cross(c_)))));
    const Vector<double> force = mass_ * acceleration - down;
    put(rate + X, at(y + V));
    quaternion_rate(q, w, rate + Q);
    put(rate + V, acceleration);
    put(rate + P, J_ * turn);
    put(stabilised ? rate + L : y + L, force);
  }

  void residual(double, const double* y, const double* rate, double* value) const {
    const double* q = y + Q;
    const Vector<double> m = at(y + P), w = inverse_ * m;
    const Vector<double> force = at(stabilised ? rate + L : y + L);
    Vector<double> shift = Vector<double>::Zero(), turn = w;
    if constexpr (stabilised) {
      shift = at(rate + U);
      turn -= c_.cross(to_body(q, shift)) / c_.squaredNorm();
    }
    put(value + X, at(rate + X) - at(y + V) - shift);
    double spin[4];
    quaternion_rate(q, turn, spin);
    for (int k = 0; k < 4; ++k) value[Q + k] = rate[Q + k] - spin[k] - rate[S] * q[k];
    put(value + V, mass_ * at(rate + V) + Vector<double>(0, 0, weight_) - force);
    put(value + P, at(rate + P) - m.cross(w) + c_.cross(to_body(q, force)));
    value[S] = 0.5 * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1.0);
    put(value + L, at(y + X) - rotated(q, c_));
    if constexpr (stabilised) put(value + U, at(y + V) - rotated(q, Vector<double>(w.cross(c_))));
  }

  /// dF/dy + cj dF/dy', column by column.
  void jacobian(double, double cj, const double* y, const double* rate, double* values) const {
    constexpr int n = stabilised ? 20 : 17;
    Eigen::Map<Eigen::Matrix<double, n, n>> K(values);
    K.setZero();
    const double* q = y + Q;
    const Vector<double> m = at(y + P), w = inverse_ * m;
    const Vector<double> force = at(stabilised ? rate + L : y + L);
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity(), c_cross = cross(c_);
    const Eigen::Matrix3d back = homogeneous_matrix(q).transpose();
    const double multiplier = stabilised ? cj : 1.0;  // how the force is differentiated

    K.template block<3, 3>(X, X) = cj * one;
    K.template block<3, 3>(X, V) = -one;
    Vector<double> turn = w;
    Eigen::Matrix<double, 4, 3> spin;
    spin << -q[1], -q[2], -q[3], q[0], -q[3], q[2], q[3], q[0], -q[1], -q[2], q[1], q[0];
    spin *= 0.5;
    if constexpr (stabilised) {
      const Vector<double> shift = at(rate + U);
      const Eigen::Matrix3d lever = c_cross / c_.squaredNorm();
      turn -= lever * to_body(q, shift);
      K.template block<3, 3>(X, U) = -cj * one;
      K.template block<4, 4>(Q, Q) += spin * lever * to_body_derivative(q, shift);
      K.template block<4, 3>(Q, U) = cj * spin * lever * back;
    }
    for (int k = 0; k < 4; ++k) {
      K(Q + k, Q + k) += cj - rate[S];
      K(Q + k, S) = -cj * q[k];
      K(S, Q + k) = q[k];
    }
    Eigen::Matrix4d half;  // derivative of 1/2 q o (0, turn) by q
    half << 0, -turn[0], -turn[1], -turn[2], turn[0], 0, turn[2], -turn[1], turn[1], -turn[2], 0, turn[0],
        turn[2], turn[1], -turn[0], 0;
    K.template block<4, 4>(Q, Q) -= 0.5 * half;
    K.template block<4, 3>(Q, P) = -spin * inverse_;

    K.template block<3, 3>(V, V) = cj * mass_ * one;
    K.template block<3, 3>(V, L) = -multiplier * one;
    K.template block<3, 4>(P, Q) = c_cross * to_body_derivative(q, force);
    K.template block<3, 3>(P, P) = cj * one - cross(m) * inverse_ + cross(w);
    K.template block<3, 3>(P, L) = multiplier * c_cross * back;

    K.template block<3, 3>(L, X) = one;
    K.template block<3, 4>(L, Q) = -rotated_derivative(q, c_);
    if constexpr (stabilised) {
      K.template block<3, 3>(U, V) = one;
      K.template block<3, 4>(U, Q) = -rotated_derivative(q, Vector<double>(w.cross(c_)));
      K.template block<3, 3>(U, P) = back.transpose() * c_cross * inverse_;
    }
  }

 private:
  // Places of the unknowns: x, q, v, m, s, lambda, mu.
  static constexpr int X = 0, Q = 3, V = 7, P = 10, S = 13, L = 14, U = 17;

  static double mass(const Gravity& load) { return load.weight / 9.81; }
  static Vector<double> at(const double* y) { return {y[0], y[1], y[2]}; }
  static void put(double* y, const Vector<double>& v) { std::copy(v.data(), v.data() + 3, y); }
  static Eigen::Matrix3d cross(const Vector<double>& v) {
    Eigen::Matrix3d matrix;
    matrix << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
    return matrix;
  }
  static Vector<double> rotated(const double* q, const Vector<double>& v) {
    const double conjugate[4] = {q[0], -q[1], -q[2], -q[3]};
    return to_body(conjugate, v);
  }
  static Eigen::Matrix<double, 3, 4> rotated_derivative(const double* q, const Vector<double>& v) {
    const double conjugate[4] = {q[0], -q[1], -q[2], -q[3]};
    Eigen::Matrix<double, 3, 4> derivative = to_body_derivative(conjugate, v);
    derivative.rightCols<3>() *= -1.0;
    return derivative;
  }
  /// 1/2 q o (0, w)
  static void quaternion_rate(const double* q, const Vector<double>& w, double* rate) {
    rate[0] = 0.5 * (-q[1] * w[0] - q[2] * w[1] - q[3] * w[2]);
    rate[1] = 0.5 * (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]);
    rate[2] = 0.5 * (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]);
    rate[3] = 0.5 * (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]);
  }

  Vector<double> inertia_, c_;  ///< about the pivot [kg m^2]; centre of mass [m]
  double weight_, mass_;        ///< N, kg
  Eigen::Matrix3d J_, inverse_;
  double momentum_scale_;
};

}  // namespace gnomon::rigid_body
