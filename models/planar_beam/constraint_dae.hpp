#pragma once
#include <algorithm>
#include <optional>
#include <vector>

#include "models/planar_beam/data.hpp"
#include "models/planar_beam/numbering.hpp"
#include "models/planar_beam/scales.hpp"
#include "models/planar_beam/sparse.hpp"

namespace gnomon::planar_beam {

/// All unknowns, with what the supports hold kept as constraints g(u, t) = u_c - s(t) = 0, and the two places
/// of a hinge as 0 = u_left - u_right, G = dg/du, in the stabilised form of C.W. Gear, B. Leimkuhler, G.K.
/// Gupta, J. Comput. Appl. Math. 12-13 (1985) 77-90:
///   u' = v + G^T mu',  M v' = f_ext(t, u) - f_int(u) - alpha M v + G^T lambda',  0 = g(u, t),  0 = G v +
///   g_t,
/// y = (u, v, mu, lambda), mu(0) = lambda(0) = 0. With the primitives of the multipliers as unknowns it has
/// index 1, and all of y is in the error test. lambda is the impulse of the supports' and hinges' forces,
/// without those that make v jump; mu stays 0 on the exact motion.
template <class Beam>
class ConstraintDaeForm {
 public:
  explicit ConstraintDaeForm(const Beam& beam)
      : beam_(&beam),
        n_(beam.unknowns()),
        constrained_(beam.held()),
        m_(static_cast<int>(beam.held().size() + beam.numbering().tied().size())),
        layout_(2 * (n_ + m_)),
        matrices_(beam, all_places(beam), n_, n_),
        forces_(n_),
        external_(n_) {
    const std::vector<int>& tied = beam.numbering().tied();
    constrained_.insert(constrained_.end(), tied.begin(), tied.end());
    for (int j = 0; j < n_; ++j) {
      layout_.add(j, j);
      layout_.add(j, n_ + j);
    }
    matrices_.add_to(layout_);
    for_constraints([&](int k, int i, double) {
      layout_.add(2 * n_ + k, i);
      layout_.add(2 * n_ + m_ + k, n_ + i);
      layout_.add(i, 2 * n_ + k);
      layout_.add(n_ + i, 2 * n_ + m_ + k);
    });
    layout_.finish();
    matrices_.find(layout_);
  }
  int size() const { return 2 * (n_ + m_); }
  std::optional<SparsePattern> sparsity() const { return layout_.pattern(); }
  std::vector<int> algebraic() const { return std::vector<int>(size(), 0); }

  /// mu has the units of u, lambda those of momenta.
  std::vector<double> scales() const {
    const Scales& motion = beam_->scales();
    const double length = beam_->data().length;
    std::vector<double> scales;
    for (int i = 0; i < n_; ++i) scales.push_back(i % 3 == 2 ? 1.0 : length);
    for (int i = 0; i < n_; ++i) scales.push_back(i % 3 == 2 ? motion.velocity / length : motion.velocity);
    for (int i : constrained_) scales.push_back(i % 3 == 2 ? 1.0 : length);
    for (int i : constrained_) scales.push_back(i % 3 == 2 ? motion.momentum * length : motion.momentum);
    return scales;
  }
  void pack(double, const State& state, double* y) const {
    std::copy(state.u.begin(), state.u.end(), y);
    std::copy(state.v.begin(), state.v.end(), y + n_);
    std::fill(y + 2 * n_, y + size(), 0.0);
  }
  State unpack(double, const double* y) const {
    using Map = Eigen::Map<const Eigen::VectorXd>;
    return {Map(y, n_), Map(y + n_, n_), beam_->strains(y)};
  }

  /// The impulse of a jump of a prescribed rate makes all velocities jump. Accelerations: s'' where
  /// prescribed, elsewhere M_ff^-1 (f_f - M_fc s'').
  void resume(double t, double* y, double* rate) const {
    double* v = y + n_;
    beam_->jump(t, v);
    std::fill(rate, rate + size(), 0.0);
    std::copy(v, v + n_, rate);
    forces(t, y, v);
    const Eigen::VectorXd loads = forces_;  // accelerate joins what acts on both sides of a hinge
    beam_->accelerate(forces_.data());
    for (const auto& one : beam_->driven())
      if (const double rise = one.motion.acceleration_after(t); rise != 0.0)
        for (int i = 0; i < beam_->nodes(); ++i) forces_[3 * i + one.unknown % 3] += rise * one.response[i];
    std::copy(forces_.begin(), forces_.end(), rate + n_);
    beam_->momentum(rate + n_, external_.data(), Sides::apart);
    for (int k = 0; k < m_; ++k) rate[2 * n_ + m_ + k] = external_[constrained_[k]] - loads[constrained_[k]];
  }
  void residual(double t, const double* y, const double* rate, double* value) const {
    forces(t, y, y + n_);
    beam_->momentum(rate + n_, value + n_, Sides::apart);
    for (int i = 0; i < n_; ++i) {
      value[i] = rate[i] - y[n_ + i];
      value[n_ + i] -= forces_[i];
    }
    for (int k = 0; k < m_; ++k) value[2 * n_ + k] = value[2 * n_ + m_ + k] = 0.0;
    for_constraints([&](int k, int i, double slope) {
      value[i] -= slope * rate[2 * n_ + k];
      value[n_ + i] -= slope * rate[2 * n_ + m_ + k];
      value[2 * n_ + k] += slope * y[i];
      value[2 * n_ + m_ + k] += slope * y[n_ + i];
    });
    for (std::size_t k = 0; k < beam_->held().size(); ++k)
      if (const Motion* motion = beam_->prescribed(beam_->held()[k])) {
        value[2 * n_ + static_cast<int>(k)] -= motion->value(t);
        value[2 * n_ + m_ + static_cast<int>(k)] -= motion->rate_after(t);
      }
  }
  void jacobian(double t, double cj, const double* y, const double*, double* values) const {
    std::fill(values, values + layout_.count(), 0.0);
    for (int j = 0; j < n_; ++j) {
      values[layout_.pattern().column_start[j]] = cj;
      values[layout_.pattern().column_start[n_ + j]] = -1.0;
    }
    matrices_.add_mass(cj + beam_->damping(), values);
    matrices_.add_stiffness(t, y, 1.0, values);
    for_constraints([&](int k, int i, double slope) {
      values[layout_.slot(2 * n_ + k, i)] = slope;
      values[layout_.slot(2 * n_ + m_ + k, n_ + i)] = slope;
      values[layout_.slot(i, 2 * n_ + k)] = -slope * cj;
      values[layout_.slot(n_ + i, 2 * n_ + m_ + k)] = -slope * cj;
    });
  }

 private:
  static std::vector<int> all_places(const Beam& beam) {
    std::vector<int> place(beam.unknowns());
    for (int i = 0; i < beam.unknowns(); ++i) place[i] = i;
    return place;
  }
  /// External less internal forces, and those of damping.
  void forces(double t, const double* u, const double* v) const {
    beam_->internal_force(u, forces_.data(), Sides::apart);
    beam_->external_force(t, external_.data(), Sides::apart);
    forces_ = external_ - forces_;
    beam_->add_following(t, u, forces_.data());
    if (beam_->damping() == 0.0) return;
    beam_->momentum(v, external_.data(), Sides::apart);
    forces_ -= beam_->damping() * external_;
  }
  /// Calls `body(k, i, dg_k/du_i)` where that is not 0.
  template <class Body>
  void for_constraints(Body&& body) const {
    for (int k = 0; k < m_; ++k) {
      body(k, constrained_[k], 1.0);
      if (k >= static_cast<int>(beam_->held().size())) body(k, constrained_[k] + 3, -1.0);
    }
  }
  const Beam* beam_;
  int n_;                         ///< unknowns
  std::vector<int> constrained_;  ///< those that are held, then those that are tied
  int m_;                         ///< constraints
  SparseLayout layout_;
  ChainMatrices<Beam> matrices_;
  mutable Eigen::VectorXd forces_, external_;
};

}  // namespace gnomon::planar_beam
