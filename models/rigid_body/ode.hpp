#pragma once
#include <optional>
#include <type_traits>
#include <vector>

#include "models/rigid_body/load.hpp"
#include "models/rigid_body/state.hpp"
#include "src/ode.hpp"

namespace gnomon::rigid_body {

/// The rates of y = (q, m), q the quaternion body -> space (w, x, y, z), m the body angular momentum [kg
/// m^2/s]: q' = 1/2 q o (0, I^-1 m), m' = m x I^-1 m + tau(q). In any precision, for references.
template <class Load, class Real>
void rates(const Vector<double>& inertia, const Load& load, const Real* y, Real* rate) {
  const Vector<Real> m(y[4], y[5], y[6]);
  const Vector<Real> w = m.cwiseQuotient(inertia.cast<Real>());
  const Real half = Real(0.5);
  rate[0] = half * (-y[1] * w[0] - y[2] * w[1] - y[3] * w[2]);
  rate[1] = half * (y[0] * w[0] + y[2] * w[2] - y[3] * w[1]);
  rate[2] = half * (y[0] * w[1] + y[3] * w[0] - y[1] * w[2]);
  rate[3] = half * (y[0] * w[2] + y[1] * w[1] - y[2] * w[0]);
  Vector<Real> torque = m.cross(w);
  if constexpr (!std::is_same_v<Load, Free>) torque += load.body_moment(y);
  for (int k = 0; k < 3; ++k) rate[4 + k] = torque[k];
}

/// Writes the derivative of `rates` by y into a column-major matrix with `rows` rows, from its top left on.
template <class Load>
void rates_jacobian(const Vector<double>& inertia, const Load& load, const double* y, double* values,
                    int rows) {
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 7>, 0, Eigen::OuterStride<>> J(values, 7, 7,
                                                                                  Eigen::OuterStride<>(rows));
  const Vector<double> m(y[4], y[5], y[6]), inverse = inertia.cwiseInverse(), w = m.cwiseProduct(inverse);
  J.setZero();
  J(0, 1) = -0.5 * w[0], J(0, 2) = -0.5 * w[1], J(0, 3) = -0.5 * w[2];
  J(1, 0) = 0.5 * w[0], J(1, 2) = 0.5 * w[2], J(1, 3) = -0.5 * w[1];
  J(2, 0) = 0.5 * w[1], J(2, 1) = -0.5 * w[2], J(2, 3) = 0.5 * w[0];
  J(3, 0) = 0.5 * w[2], J(3, 1) = 0.5 * w[1], J(3, 2) = -0.5 * w[0];
  const double q[4][3] = {
      {-y[1], -y[2], -y[3]}, {y[0], -y[3], y[2]}, {y[3], y[0], -y[1]}, {-y[2], y[1], y[0]}};
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 3; ++k) J(i, 4 + k) = 0.5 * q[i][k] * inverse[k];
  for (int k = 0; k < 3; ++k) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;  // (m x w)_k = m_a m_b (1/I_b - 1/I_a)
    J(4 + k, 4 + a) = m[b] * (inverse[b] - inverse[a]);
    J(4 + k, 4 + b) = m[a] * (inverse[b] - inverse[a]);
  }
  if constexpr (!std::is_same_v<Load, Free>) J.template block<3, 4>(4, 0) = load.body_moment_derivative(y);
}

/// ODE form in 7 unknowns (q, m).
template <class Load>
struct OdeForm {
  Vector<double> inertia;  ///< kg m^2
  Load load;
  double momentum_scale;  ///< kg m^2/s

  int size() const { return 7; }
  std::vector<double> scales() const {
    std::vector<double> scales(7, 1.0);
    for (int k = 4; k < 7; ++k) scales[k] = momentum_scale;
    return scales;
  }
  std::optional<SparsePattern> sparsity() const { return std::nullopt; }
  void pack(double, const State& state, double* y) const { pack_state(state, y); }
  State unpack(double, const double* y) const { return unpack_state(y); }
  void rhs(double, const double* y, double* rate) const { rates(inertia, load, y, rate); }
  void jacobian(double, const double* y, double* values) const {
    rates_jacobian(inertia, load, y, values, 7);
  }
};

}  // namespace gnomon::rigid_body
