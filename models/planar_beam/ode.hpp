#pragma once
#include <optional>

#include "models/planar_beam/element.hpp"
#include "models/planar_beam/free_unknowns.hpp"
#include "models/planar_beam/newton.hpp"
#include "src/ode.hpp"

namespace gnomon::planar_beam {

/// ODE form: u' = v, w' = M^-1 (f_ext(t, u) - f_int(u)) - alpha w on the free unknowns; damping alpha acts on
/// w alone because M_ff w is the whole momentum of the free unknowns. The consistent mass matrix is
/// factorised as a band. The Jacobian is dense because its inverse is, so implicit solvers had better take
/// `newton_solver`.
template <class Beam>
class OdeForm : public FreeUnknowns<Beam> {
 public:
  using FreeUnknowns<Beam>::FreeUnknowns;
  std::optional<SparsePattern> sparsity() const { return std::nullopt; }
  NewtonElimination<Beam> newton_solver() const { return NewtonElimination<Beam>(*this->beam_); }

  void rhs(double t, const double* y, double* rate) const {
    const Beam& beam = *this->beam_;
    const int n = this->count();
    this->forces(t, y);
    beam.accelerate(this->f_.data());
    this->velocities(t, y, rate);
    for (int i = 0; i < n; ++i) rate[n + i] = this->f_[beam.free()[i]] - beam.damping() * y[n + i];
  }

  void jacobian(double t, const double* y, double* values) const {
    const Beam& beam = *this->beam_;
    const int n = this->count();
    Eigen::Map<Eigen::MatrixXd> J(values, 2 * n, 2 * n);
    J.setZero();
    J.topRightCorner(n, n).setIdentity();
    J.bottomRightCorner(n, n).diagonal().setConstant(-beam.damping());
    const double* u = this->displacements(t, y);
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(beam.unknowns(), beam.unknowns());
    constexpr int p = Beam::order, size = Element<p>::unknowns;
    const Numbering& numbering = beam.numbering();
    for (int e = 0; e < beam.elements(); ++e)
      K.block<size, size>(numbering.first(e), numbering.first(e)) += beam.element_tangent(t, u, e);
    beam.for_hinge_springs([&](int k, double stiffness) {
      const int sides[2] = {numbering.left_rotation(k), numbering.right_rotation(k)};
      for (int i : sides)
        for (int j : sides) K(i, j) += i == j ? stiffness : -stiffness;
    });
    for (int i : numbering.tied()) K.col(i + 3) += K.col(i);
    for (int j = 0; j < n; ++j) {
      auto column = K.col(beam.free()[j]);
      beam.accelerate(column.data());
      for (int i = 0; i < n; ++i) J(n + i, j) = -column[beam.free()[i]];
    }
  }
};

}  // namespace gnomon::planar_beam
