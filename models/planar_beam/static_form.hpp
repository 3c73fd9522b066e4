#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "models/planar_beam/element_chain.hpp"
#include "models/planar_beam/rigid_motion.hpp"
#include "src/statics.hpp"

namespace gnomon::planar_beam {

/// Which loads a beam is in equilibrium with: those of the end, after all changes, or those at t = 0.
enum class LoadCase { last, first };

/// Equilibrium of a beam: loads and prescribed motions of a case, times the factor. Refers to the beam.
template <class Beam>
class StaticForm final : public StaticSystem {
 public:
  StaticForm(const Beam& beam, LoadCase load_case)
      : beam_(&beam),
        time_(load_case == LoadCase::first ? 0.0 : std::numeric_limits<double>::infinity()),
        chain_(beam.elements(), beam.held(), beam.numbering().hinged()),
        dead_(Vector::Zero(beam.unknowns())),
        internal_(beam.unknowns()) {
    for (const Load& load : beam.dead_loads()) beam.add_load(load, factor_of(load), dead_.data());
    beam.numbering().join(dead_.data());
    beam.for_hinge_springs([&](int k, double stiffness) { chain_.set_spring(k, -stiffness, stiffness); });
    const CrossSection& C = beam.section();
    roundoff_ = 4.0 * std::numeric_limits<double>::epsilon() * std::max(C.EA, C.GA) *
                std::sqrt(static_cast<double>(beam.nodes()));
  }
  int size() const override { return beam_->unknowns(); }
  double lever(int unknown) const override { return unknown % 3 == 2 ? beam_->data().length : 1.0; }
  double roundoff() const override { return roundoff_; }

  /// A rigid motion that neither supports nor hinges nor springs hinder would be free.
  std::string refusal() const override {
    for (const auto& one : beam_->driven())
      if (time_ != 0.0 && !one.motion.ends_at_rest()) return "a beam whose support does not come to rest";
    if (is_held_rigidly(beam_->data(), beam_->numbering(), beam_->positions(), beam_->centre())) return "";
    return beam_->has_hinges() ? "a beam whose pieces can move freely as rigid bodies"
                               : "a beam that can move freely as a rigid body";
  }

  void prescribe(double factor, double* u) const override {
    for (int i : beam_->held()) u[i] = 0.0;
    for (const auto& one : beam_->driven())
      u[one.unknown] = time_ == 0.0 ? 0.0 : factor * one.motion.final_value();
  }
  double residual(double factor, const double* u, double* r) const override {
    beam_->internal_force(u, internal_.data());
    Eigen::Map<Vector> external(r, beam_->unknowns());
    external = factor * dead_;
    for (int end = 0; end < 2; ++end) {
      const auto load = following(u, end);
      for (int k = 0; k < 2; ++k) r[beam_->end_unknown(end) + k] += factor * load.force[k];
    }
    for (int i : beam_->held()) internal_[i] = external[i] = 0.0;
    const double scale = std::max(size_of(internal_), size_of(external));
    external -= internal_;
    return scale;
  }
  void load(double factor, const double* u, double* out) const override {
    Eigen::Map<Vector> rate(out, beam_->unknowns());
    rate = dead_;
    for (int end = 0; end < 2; ++end) {
      const auto load = following(u, end);
      for (int k = 0; k < 2; ++k) out[beam_->end_unknown(end) + k] += load.force[k];
    }
    if (beam_->is_driven() && time_ != 0.0) {
      Vector moved = Vector::Zero(beam_->unknowns());
      prescribe(1.0, moved.data());
      for (int e = 0; e < beam_->elements(); ++e) {
        const auto part = moved.template segment<size_>(first(e));
        if (!part.isZero(0.0)) rate.template segment<size_>(first(e)) -= tangent(factor, u, e) * part;
      }
      beam_->numbering().join(out);
    }
    for (int i : beam_->held()) rate[i] = 0.0;
  }
  void factorise(double factor, const double* u) override {
    for (int e = 0; e < beam_->elements(); ++e) chain_.add(e, tangent(factor, u, e));
    chain_.factorise();
  }
  void solve(double* b) const override { chain_.solve(b); }
  std::vector<double> state(const double* u) const override {
    const int n = beam_->unknowns();
    return beam_->flatten({Eigen::Map<const Vector>(u, n), Vector::Zero(n), beam_->strains(u)});
  }

 private:
  using Vector = Eigen::VectorXd;
  static constexpr int p = Beam::order, size_ = Element<p>::unknowns;

  int first(int e) const { return beam_->numbering().first(e); }
  double factor_of(const Load& load) const { return time_ == 0.0 ? load.factor(0.0) : load.final_factor(); }
  /// The followers at an end, whole.
  typename Beam::Following following(const double* u, int end) const {
    typename Beam::Following sum;
    for (const Load& load : beam_->followers())
      if (load.at == (end == 0 ? Place::start : Place::end))
        sum.add(factor_of(load), load, u[beam_->end_unknown(end) + 2]);
    return sum;
  }
  typename Element<p>::Matrix tangent(double factor, const double* u, int e) const {
    typename Element<p>::Matrix matrix = beam_->element_tangent(u, e);
    if (beam_->has_followers())
      beam_->for_ends_of(e, [&](int end, int i) {
        const auto load = following(u, end);
        for (int k = 0; k < 2; ++k) matrix(i + k, i + 2) -= factor * load.slope[k];
      });
    return matrix;
  }
  double size_of(const Eigen::Ref<const Vector>& forces) const {
    double sum = 0.0;
    for (int i = 0; i < beam_->unknowns(); ++i) {
      const double f = forces[i] / lever(i);
      sum += f * f;
    }
    return std::sqrt(sum);
  }
  const Beam* beam_;
  double time_;
  ElementChain<p> chain_;
  Vector dead_;
  mutable Vector internal_;
  double roundoff_;
};

}  // namespace gnomon::planar_beam
