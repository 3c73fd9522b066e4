#pragma once
#include <optional>
#include <vector>

#include "models/planar_beam/data.hpp"
#include "models/planar_beam/element.hpp"
#include "src/ode.hpp"

namespace gnomon::planar_beam {

/// The unknowns that no support holds, as y = (u, v), and back.
template <class Beam>
class FreeUnknowns {
 public:
  explicit FreeUnknowns(const Beam& beam) : beam_(&beam), u_(beam.unknowns()), f_(beam.unknowns()) {
    u_.setZero();
  }
  int count() const { return static_cast<int>(beam_->free().size()); }

  std::vector<double> scales() const {
    const double length = beam_->data().length, velocity = beam_->scales().velocity;
    std::vector<double> scales;
    for (int i : beam_->free()) scales.push_back(i % 3 == 2 ? 1.0 : length);
    for (int i : beam_->free()) scales.push_back(i % 3 == 2 ? velocity / length : velocity);
    return scales;
  }
  void pack(const State& state, double* y) const {
    for (int i : beam_->free()) *y++ = state.u[i];
    for (int i : beam_->free()) *y++ = state.v[i];
  }
  State unpack(const double* y) const {
    State state{Eigen::VectorXd::Zero(beam_->unknowns()), Eigen::VectorXd::Zero(beam_->unknowns()), {}};
    for (int i : beam_->free()) state.u[i] = *y++;
    for (int i : beam_->free()) state.v[i] = *y++;
    state.strain = beam_->strains(state.u.data());
    return state;
  }

 protected:
  /// Spreads the first half of y over all unknowns.
  const double* spread(const double* y) const {
    for (int i : beam_->free()) u_[i] = *y++;
    return u_.data();
  }
  const Beam* beam_;
  mutable Eigen::VectorXd u_, f_;
};

/// ODE form: u' = v, v' = M^-1 (f_ext(t) - f_int(u)) on the free unknowns. The consistent mass matrix is
/// factorised as a band; the Jacobian is dense because its inverse is.
template <class Beam>
class OdeForm : public FreeUnknowns<Beam> {
 public:
  using FreeUnknowns<Beam>::FreeUnknowns;
  int size() const { return 2 * this->count(); }
  std::optional<SparsePattern> sparsity() const { return std::nullopt; }

  void rhs(double t, const double* y, double* rate) const {
    const Beam& beam = *this->beam_;
    const int n = this->count();
    Eigen::VectorXd &f = this->f_, &inner = inner_;
    inner.resize(beam.unknowns());
    beam.external_force(t, f.data());
    beam.internal_force(this->spread(y), inner.data());
    f -= inner;
    beam.accelerate(f.data());
    for (int i = 0; i < n; ++i) {
      rate[i] = y[n + i];
      rate[n + i] = f[beam.free()[i]];
    }
  }

  void jacobian(double, const double* y, double* values) const {
    const Beam& beam = *this->beam_;
    const int n = this->count();
    Eigen::Map<Eigen::MatrixXd> J(values, 2 * n, 2 * n);
    J.setZero();
    J.topRightCorner(n, n).setIdentity();
    const double* u = this->spread(y);
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(beam.unknowns(), beam.unknowns());
    constexpr int p = Beam::order, size = Element<p>::unknowns;
    for (int e = 0; e < beam.elements(); ++e)
      K.block<size, size>(3 * p * e, 3 * p * e) += beam.element_tangent(u, e);
    for (int j = 0; j < n; ++j) {
      auto column = K.col(beam.free()[j]);
      beam.accelerate(column.data());
      for (int i = 0; i < n; ++i) J(n + i, j) = -column[beam.free()[i]];
    }
  }

 private:
  mutable Eigen::VectorXd inner_;
};

}  // namespace gnomon::planar_beam
