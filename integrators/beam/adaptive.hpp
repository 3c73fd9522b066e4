#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "integrators/beam/stepper.hpp"
#include "src/run.hpp"

namespace gnomon::beam {

/// A scheme in progress whose steps can be taken back.
class BeamSteps {
 public:
  virtual ~BeamSteps() = default;
  virtual Status step(double t, double h) = 0;
  /// Remembers the present state, and goes back to the one remembered last.
  virtual void keep() = 0;
  virtual void back() = 0;
  virtual const Eigen::VectorXd& u() const = 0;
  virtual const Eigen::VectorXd& v() const = 0;
  /// The model's state, flattened.
  virtual void state(std::vector<double>& flat) const = 0;
  virtual Cost cost() const = 0;
};

/// A beam whose y is its flattened state, with the steps that integrate it.
class BeamStepsSystem : public FirstOrderSystem {
 public:
  virtual std::unique_ptr<BeamSteps> steps(const SchemeOptions& options) const = 0;
  virtual double length() const = 0;
  virtual double velocity() const = 0;  ///< scale, m/s
  virtual double time() const = 0;      ///< scale, s
};

template <BeamForm M>
class EnergyMomentumSteps final : public BeamSteps {
 public:
  EnergyMomentumSteps(const M& model, const SchemeOptions& options)
      : model_(&model), stepper_(model, model.initial(), options) {
    keep();
  }
  Status step(double t, double h) override { return stepper_.step(*model_, t, h); }
  void keep() override {
    u_ = stepper_.u;
    v_ = stepper_.v;
    history_ = stepper_.history;
  }
  void back() override {
    stepper_.u = u_;
    stepper_.v = v_;
    stepper_.history = history_;
  }
  const Eigen::VectorXd& u() const override { return stepper_.u; }
  const Eigen::VectorXd& v() const override { return stepper_.v; }
  void state(std::vector<double>& flat) const override { flat = model_->flatten(stepper_.view(*model_)); }
  Cost cost() const override {
    return {.rhs = stepper_.evaluations,
            .jacobians = stepper_.factorizations,
            .factorizations = stepper_.factorizations,
            .newton_iterations = stepper_.iterations};
  }

 private:
  const M* model_;
  Stepper<M, Turning::cayley> stepper_;
  Eigen::VectorXd u_, v_;
  std::vector<PointHistory> history_;
};

template <BeamForm M>
class EnergyMomentumSystem final : public BeamStepsSystem {
 public:
  /// The model has to outlive it.
  explicit EnergyMomentumSystem(const M& model) : model_(&model) {
    for (const InvariantInfo& info : model.invariant_info()) invariants_ += info.size;
  }
  int size() const override { return 2 * model_->unknowns() + 3 * model_->point_count(); }
  std::vector<double> scales() const override {
    return std::vector<double>(static_cast<std::size_t>(size()), 1.0);
  }
  std::vector<double> breaks() const override { return model_->breaks(); }
  std::optional<SparsePattern> sparsity() const override { return std::nullopt; }
  int invariant_count() const override { return invariants_; }
  void invariants(double t, const double* y, double* out) const override {
    model_->invariants(t, model_->restore({y, y + size()}), out);
  }
  std::vector<double> model_state(double, const double* y) const override { return {y, y + size()}; }
  void start(double* y) const override {
    const std::vector<double> flat = model_->flatten(model_->initial());
    std::copy(flat.begin(), flat.end(), y);
  }
  std::unique_ptr<BeamSteps> steps(const SchemeOptions& options) const override {
    return std::make_unique<EnergyMomentumSteps<M>>(*model_, options);
  }
  double length() const override { return model_->data().length; }
  double velocity() const override { return model_->scales().velocity; }
  double time() const override { return model_->scales().time; }

 private:
  const M* model_;
  int invariants_ = 0;
};

/// Chooses the steps of a symmetric scheme of order 2: each is made once as a whole and once as two halves,
/// which are kept. A third of the difference estimates their error; its root mean squares over the nodes, of
/// displacements by the length of the beam, rotations by one radian, and velocities by the scale of the
/// motion's, all stay below spec.tol.
std::unique_ptr<AdaptiveSolver> make_adaptive(const BeamStepsSystem& system, const RunSpec& spec);

struct BeamEnergyMomentumAdaptive {
  static constexpr SchemeInfo info{
      .name = "beam-energy-momentum-adaptive",
      .family = "beam",
      .summary =
          "beam-energy-momentum with steps by an estimate of the error in each; energy and momenta exact",
      .citation =
          "E. Hairer, S.P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, II.4, eqs "
          "(4.4) and (4.13), on the step of beam-energy-momentum",
      .form = "beam",
      .stepping = Stepping::adaptive,
      .conserves_energy = true,
      .conserves_momentum = true,
      .uses = {.newton_tol = true, .modified_newton = true, .linear_solver = true},
  };
  template <BeamForm M>
  static std::unique_ptr<BeamStepsSystem> system(const M& model) {
    return std::make_unique<EnergyMomentumSystem<M>>(model);
  }
  static std::unique_ptr<AdaptiveSolver> make(const BeamStepsSystem& system, const RunSpec& spec) {
    return make_adaptive(system, spec);
  }
};

}  // namespace gnomon::beam
