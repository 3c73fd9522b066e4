#pragma once
#include <vector>

#include "models/planar_beam/data.hpp"

namespace gnomon::planar_beam {

/// The unknowns that no support holds and no hinge ties to others, as y = (u_f, w), and back. Where supports
/// prescribe motions s(t), w = v_f + M_ff^-1 M_fc s'(t): it is v_f without what s' gives it at once. So it
/// stays continuous where s' jumps and the impulse makes v_f jump, and M_ff w' = f_f needs no s''. Else w =
/// v_f.
template <class Beam>
class FreeUnknowns {
 public:
  explicit FreeUnknowns(const Beam& beam) : beam_(&beam), u_(beam.unknowns()), f_(beam.unknowns()) {
    u_.setZero();
    for (const auto& one : beam.driven()) {
      driven_.push_back({one.unknown, &one.motion, {}});
      for (int i : beam.free())
        driven_.back().response.push_back(i % 3 == one.unknown % 3 ? one.response[i / 3] : 0.0);
    }
  }
  int count() const { return static_cast<int>(beam_->free().size()); }
  int size() const { return 2 * count(); }

  /// Lengths and radians for u, the scale of the motion's velocity for w.
  std::vector<double> scales() const {
    const double length = beam_->data().length, velocity = beam_->scales().velocity;
    std::vector<double> scales;
    for (int i : beam_->free()) scales.push_back(i % 3 == 2 ? 1.0 : length);
    for (int i : beam_->free()) scales.push_back(i % 3 == 2 ? velocity / length : velocity);
    return scales;
  }
  void pack(double t, const State& state, double* y) const {
    for (int i : beam_->free()) *y++ = state.u[i];
    for (int i : beam_->free()) *y++ = state.v[i];
    for (const Driven& end : driven_) add_response(end, -end.motion->rate_before(t), y - count());
  }
  State unpack(double t, const double* y) const {
    State state{Eigen::VectorXd::Zero(beam_->unknowns()), Eigen::VectorXd::Zero(beam_->unknowns()), {}};
    for (int i : beam_->free()) state.u[i] = *y++;
    for (int i : beam_->free()) state.v[i] = *y++;
    for (const Driven& end : driven_) {
      const double rate = end.motion->rate_before(t);
      state.u[end.unknown] = end.motion->value(t);
      state.v[end.unknown] = rate;
      for (int i = 0; i < count(); ++i) state.v[beam_->free()[i]] += rate * end.response[i];
    }
    beam_->numbering().spread(state.u.data());
    beam_->numbering().spread(state.v.data());
    state.strain = beam_->strains(state.u.data());
    return state;
  }

 protected:
  /// All displacements at time t, those of the free unknowns from the first half of y.
  const double* displacements(double t, const double* y) const {
    for (const Driven& end : driven_) u_[end.unknown] = end.motion->value(t);
    for (int i : beam_->free()) u_[i] = *y++;
    beam_->numbering().spread(u_.data());
    return u_.data();
  }
  /// Velocities of the free unknowns just behind t.
  void velocities(double t, const double* y, double* v) const {
    const int n = count();
    for (int i = 0; i < n; ++i) v[i] = y[n + i];
    for (const Driven& end : driven_) add_response(end, end.motion->rate_after(t), v);
  }
  /// External less internal forces on all unknowns.
  const Eigen::VectorXd& forces(double t, const double* y) const {
    beam_->internal_force(displacements(t, y), f_.data());
    external_.resize(f_.size());
    beam_->external_force(t, external_.data());
    f_ = external_ - f_;
    beam_->add_following(t, u_.data(), f_.data());
    return f_;
  }

  /// Takes alpha M_ff w off the forces.
  void damp(const double* y) const {
    if (beam_->damping() == 0.0) return;
    w_.setZero(beam_->unknowns());
    external_.resize(f_.size());
    for (int i = 0; i < count(); ++i) w_[beam_->free()[i]] = y[count() + i];
    beam_->numbering().spread(w_.data());
    beam_->momentum(w_.data(), external_.data());
    f_ -= beam_->damping() * external_;
  }

  const Beam* beam_;
  mutable Eigen::VectorXd u_, w_, f_, external_;

 private:
  struct Driven {
    int unknown;
    const Motion* motion;
    std::vector<double> response;  ///< -M_ff^-1 M_fc, of each free unknown
  };
  void add_response(const Driven& end, double rate, double* v) const {
    if (rate != 0.0)
      for (int i = 0; i < count(); ++i) v[i] += rate * end.response[i];
  }
  std::vector<Driven> driven_;
};

}  // namespace gnomon::planar_beam
