#pragma once
#include <vector>

#include "models/planar_beam/element_chain.hpp"
#include "models/planar_beam/free_unknowns.hpp"

namespace gnomon::planar_beam {

/// (1 - gamma J) x = b of the ODE form u' = w, w' = -M^-1 K u - alpha w: with x_u = b_u + gamma x_w there
/// remains ((1 + gamma alpha) M + gamma^2 K) x_w = M b_w - gamma K b_u,
/// which is eliminated element by element. The cost is linear in the number of elements; M^-1, which would
/// make J dense, is not needed.
template <class Beam>
class NewtonElimination : private FreeUnknowns<Beam> {
 public:
  explicit NewtonElimination(const Beam& beam)
      : FreeUnknowns<Beam>(beam),
        chain_(beam.elements(), beam.held(), beam.numbering().hinged()),
        tangents_(beam.elements()),
        along_u_(Eigen::VectorXd::Zero(beam.unknowns())),
        along_w_(Eigen::VectorXd::Zero(beam.unknowns())),
        right_(Eigen::VectorXd::Zero(beam.unknowns())) {}

  void linearise(double t, const double* y) {
    const double* u = this->displacements(t, y);
    for (int e = 0; e < this->beam_->elements(); ++e) tangents_[e] = this->beam_->element_tangent(t, u, e);
  }
  void factorise(double gamma) {
    gamma_ = gamma;
    const auto& element = this->beam_->element();
    const double damped = 1.0 + gamma * this->beam_->damping();
    double inertia[3];
    for (int k = 0; k < 3; ++k) inertia[k] = damped * this->beam_->density(k);
    this->beam_->for_hinge_springs([&](int k, double stiffness) {
      chain_.set_spring(k, -gamma * gamma * stiffness, gamma * gamma * stiffness);
    });
    for (int e = 0; e < this->beam_->elements(); ++e) {
      matrix_ = gamma * gamma * tangents_[e];
      for (int a = 0; a <= p; ++a)
        for (int b = 0; b <= p; ++b)
          for (int k = 0; k < 3; ++k) matrix_(3 * a + k, 3 * b + k) += element.mass[a][b] * inertia[k];
      chain_.add(e, matrix_);
    }
    chain_.factorise();
  }
  void solve(double* b) {
    const std::vector<int>& free = this->beam_->free();
    const int n = this->count();
    for (int i = 0; i < n; ++i) {
      along_u_[free[i]] = b[i];
      along_w_[free[i]] = b[n + i];
    }
    const Numbering& numbering = this->beam_->numbering();
    numbering.spread(along_u_.data());
    numbering.spread(along_w_.data());
    this->beam_->momentum(along_w_.data(), right_.data());
    for (int e = 0; e < this->beam_->elements(); ++e)
      right_.segment<size_>(numbering.first(e)).noalias() -=
          gamma_ * (tangents_[e] * along_u_.segment<size_>(numbering.first(e)));
    this->beam_->add_hinge_moments(-gamma_, along_u_.data(), right_.data());
    chain_.solve(right_.data());
    for (int i = 0; i < n; ++i) {
      b[n + i] = right_[free[i]];
      b[i] += gamma_ * b[n + i];
    }
  }

 private:
  static constexpr int p = Beam::order, size_ = Element<p>::unknowns;
  ElementChain<p> chain_;
  std::vector<typename Element<p>::Matrix> tangents_;
  typename Element<p>::Matrix matrix_;
  Eigen::VectorXd along_u_, along_w_, right_;
  double gamma_ = 0.0;
};

}  // namespace gnomon::planar_beam
