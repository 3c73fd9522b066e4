#pragma once
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "integrators/beam/stepper.hpp"

namespace gnomon::beam {

/// A beam by its nodal values u and v, of whatever order its elements are: M (u'' + damping u') + f(u, t) =
/// F(t) for the free unknowns. Forces on what a hinge ties to others count there. f are the internal forces
/// less those of loads that follow the beam. The schemes on it are compiled once. All vectors have
/// `unknowns()` entries.
class NodalBeam {
 public:
  virtual ~NodalBeam() = default;
  virtual std::unique_ptr<NodalBeam> clone() const = 0;

  virtual int unknowns() const = 0;
  virtual int elements() const = 0;
  virtual double length() const = 0;
  virtual planar_beam::CrossSection section() const = 0;
  virtual double damping() const = 0;  ///< 1/s
  virtual const std::vector<int>& held() const = 0;
  virtual const planar_beam::Motion* prescribed(int unknown) const = 0;
  virtual std::vector<double> breaks() const = 0;
  /// Velocities just behind the time t of a jump of prescribed rates, from those just before it.
  virtual void jump(double t, double* v) const = 0;

  virtual void external_force(double t, double* force) const = 0;
  virtual void internal_force(double t, const double* u, double* force) const = 0;  ///< f
  virtual void momentum(const double* v, double* product) const = 0;                ///< M v
  /// M_ff^-1 times the forces on the free unknowns; 0 for those that are held.
  virtual void accelerate(double* force) const = 0;
  /// Sets displacements, or their rates, that a hinge ties to others to those.
  virtual void spread(double* values) const = 0;
  /// Row sums of M.
  virtual std::vector<double> lumped_mass() const = 0;

  /// Factorises mass M + stiffness K of the free unknowns, K = df/du.
  virtual void factorise(double mass, double stiffness, double t, const double* u) = 0;
  /// Solves in place with what was factorised; 0 for unknowns that are held.
  virtual void solve(double* values) const = 0;

  /// Without the loads that follow. The sum over the elements bounds the stiffness of the beam from above.
  virtual Eigen::MatrixXd element_stiffness(const double* u, int element) const = 0;
  virtual Eigen::MatrixXd element_mass() const = 0;
};

template <BeamForm M>
class NodalBeamOf final : public NodalBeam {
 public:
  /// The model has to outlive it.
  explicit NodalBeamOf(const M& model)
      : model_(&model), chain_(model.elements(), model.held(), model.numbering().hinged()) {}
  std::unique_ptr<NodalBeam> clone() const override { return std::make_unique<NodalBeamOf>(*this); }

  int unknowns() const override { return model_->unknowns(); }
  int elements() const override { return model_->elements(); }
  double length() const override { return model_->data().length; }
  planar_beam::CrossSection section() const override { return model_->section(); }
  double damping() const override { return model_->damping(); }
  const std::vector<int>& held() const override { return model_->held(); }
  const planar_beam::Motion* prescribed(int unknown) const override { return model_->prescribed(unknown); }
  std::vector<double> breaks() const override { return model_->breaks(); }
  void jump(double t, double* v) const override { model_->jump(t, v); }

  void external_force(double t, double* force) const override { model_->external_force(t, force); }
  void internal_force(double t, const double* u, double* force) const override {
    model_->internal_force(u, force);
    if (!model_->has_followers()) return;
    for (int end = 0; end < 2; ++end) {
      const int i = model_->end_unknown(end);
      const auto load = model_->following(t, end, u[i + 2]);
      force[i] -= load.force[0];
      force[i + 1] -= load.force[1];
    }
  }
  void momentum(const double* v, double* product) const override { model_->momentum(v, product); }
  void accelerate(double* force) const override { model_->accelerate(force); }
  void spread(double* values) const override { model_->numbering().spread(values); }
  std::vector<double> lumped_mass() const override {
    std::vector<double> mass(static_cast<std::size_t>(unknowns()), 0.0);
    for (int e = 0; e < elements(); ++e)
      for (int a = 0; a <= p; ++a)
        for (int k = 0; k < 3; ++k)
          mass[model_->numbering().first(e) + 3 * a + k] += model_->element().load[a] * model_->density(k);
    for (int i : model_->numbering().tied()) mass[i] = mass[i + 3] += mass[i];
    return mass;
  }

  void factorise(double mass, double stiffness, double t, const double* u) override {
    model_->for_hinge_springs(
        [&](int k, double spring) { chain_.set_spring(k, -stiffness * spring, stiffness * spring); });
    for (int e = 0; e < elements(); ++e) {
      Matrix matrix = stiffness * model_->element_tangent(t, u, e);
      add_mass(mass, matrix);
      chain_.add(e, matrix);
    }
    chain_.factorise();
  }
  void solve(double* values) const override { chain_.solve(values); }

  Eigen::MatrixXd element_stiffness(const double* u, int element) const override {
    Matrix matrix = model_->element_tangent(u, element);
    // k (a - b)^2 <= 2 k a^2 + 2 k b^2: the spring of a hinge as one on each side
    model_->for_hinge_springs([&](int k, double spring) {
      const int right_of = model_->numbering().hinged()[k];
      if (element == right_of) matrix(2, 2) += 2.0 * spring;
      if (element == right_of - 1) matrix(3 * p + 2, 3 * p + 2) += 2.0 * spring;
    });
    return matrix;
  }
  Eigen::MatrixXd element_mass() const override {
    Matrix matrix = Matrix::Zero();
    add_mass(1.0, matrix);
    return matrix;
  }

 private:
  static constexpr int p = M::order;
  using Matrix = typename ElementChain<p>::Matrix;

  void add_mass(double factor, Matrix& matrix) const {
    for (int a = 0; a <= p; ++a)
      for (int b = 0; b <= p; ++b)
        for (int k = 0; k < 3; ++k)
          matrix(3 * a + k, 3 * b + k) += factor * model_->element().mass[a][b] * model_->density(k);
  }

  const M* model_;
  ElementChain<p> chain_;
};

/// A NodalBeam that is copied with what holds it.
class NodalBeamValue {
 public:
  explicit NodalBeamValue(std::unique_ptr<NodalBeam> beam) : beam_(std::move(beam)) {}
  NodalBeamValue(const NodalBeamValue& other) : beam_(other.beam_->clone()) {}
  NodalBeamValue(NodalBeamValue&&) noexcept = default;
  NodalBeamValue& operator=(const NodalBeamValue& other) {
    if (this != &other) beam_ = other.beam_->clone();
    return *this;
  }
  NodalBeamValue& operator=(NodalBeamValue&&) noexcept = default;
  ~NodalBeamValue() = default;

  NodalBeam* operator->() { return beam_.get(); }
  const NodalBeam* operator->() const { return beam_.get(); }
  const NodalBeam& operator*() const { return *beam_; }

 private:
  std::unique_ptr<NodalBeam> beam_;
};

}  // namespace gnomon::beam
