#pragma once
#include "models/rigid_body/ode.hpp"

namespace gnomon::rigid_body {

/// DAE forms in 8 unknowns y = (q, m, mu): the norm of the quaternion as a constraint with a multiplier,
///   q' = 1/2 q o (0, I^-1 m) + s q,   m' = m x I^-1 m + tau(q),   0 = 1/2 (q.q - 1),
/// with s = mu' (stabilised: index 1 in the multiplier's primitive, mu(0) = 0) or s = mu (index 2). mu = 0 on
/// the exact motion of both, so the start is consistent as it stands.
template <class Load, bool stabilised>
struct DaeForm {
  Vector<double> inertia;  ///< kg m^2
  Load load;
  double momentum_scale;  ///< kg m^2/s

  int size() const { return 8; }
  std::vector<double> scales() const {
    std::vector<double> scales(8, 1.0);
    for (int k = 4; k < 7; ++k) scales[k] = momentum_scale;
    return scales;
  }
  std::optional<SparsePattern> sparsity() const { return std::nullopt; }
  std::vector<int> algebraic() const { return {0, 0, 0, 0, 0, 0, 0, stabilised ? 0 : 1}; }

  void pack(double, const State& state, double* y) const {
    pack_state(state, y);
    y[7] = 0.0;
  }
  State unpack(double, const double* y) const { return unpack_state(y); }
  /// Loads do not jump, and on the exact motion mu stays 0.
  void resume(double, const double* y, double* rate) const {
    rates(inertia, load, y, rate);
    rate[7] = 0.0;
  }

  void residual(double, const double* y, const double* rate, double* value) const {
    rates(inertia, load, y, value);
    const double s = stabilised ? rate[7] : y[7];
    for (int k = 0; k < 4; ++k) value[k] = rate[k] - value[k] - s * y[k];
    for (int k = 4; k < 7; ++k) value[k] = rate[k] - value[k];
    value[7] = 0.5 * (y[0] * y[0] + y[1] * y[1] + y[2] * y[2] + y[3] * y[3] - 1.0);
  }

  /// dF/dy + cj dF/dy', 8 x 8, column by column.
  void jacobian(double, double cj, const double* y, const double* rate, double* values) const {
    Eigen::Map<Eigen::Matrix<double, 8, 8>> J(values);
    J.setZero();
    rates_jacobian(inertia, load, y, values, 8);
    J = -J;
    const double s = stabilised ? rate[7] : y[7];
    for (int k = 0; k < 7; ++k) J(k, k) += cj;
    for (int k = 0; k < 4; ++k) {
      J(k, k) -= s;
      J(k, 7) = stabilised ? -cj * y[k] : -y[k];
      J(7, k) = y[k];
    }
  }
};

}  // namespace gnomon::rigid_body
