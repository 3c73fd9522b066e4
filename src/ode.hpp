#pragma once
#include <concepts>
#include <memory>
#include <optional>
#include <vector>

#include "src/model.hpp"

namespace gnomon {

/// Places of the entries of a sparse square matrix, compressed by columns.
struct SparsePattern {
  std::vector<long> column_start;  ///< size n + 1
  std::vector<long> row;           ///< row of each entry, ascending within a column
};

/// What every first-order system tells about itself, whichever equations it has.
class FirstOrderSystem {
 public:
  virtual ~FirstOrderSystem() = default;
  virtual int size() const = 0;
  /// Typical size of each component; an absolute tolerance is the relative one times this.
  virtual std::vector<double> scales() const = 0;
  virtual std::vector<double> breaks() const = 0;
  /// The Jacobian's pattern if it is worth a sparse factorisation; none means dense, column by column.
  virtual std::optional<SparsePattern> sparsity() const = 0;
  virtual int invariant_count() const = 0;
  virtual void invariants(double t, const double* y, double* out) const = 0;
  /// The model state of y at time t, flattened; where the model's data jump, the limit from the left.
  virtual std::vector<double> model_state(double t, const double* y) const = 0;
  /// y of the model's initial state.
  virtual void start(double* y) const = 0;
};

/// Newton's linear systems (1 - gamma J) x = b, J = df/dy, for a system that eliminates them itself.
class NewtonSolver {
 public:
  virtual ~NewtonSolver() = default;
  /// Keeps J at (t, y).
  virtual void linearise(double t, const double* y) = 0;
  /// Factorises 1 - gamma J with the J that was kept last.
  virtual void factorise(double gamma) = 0;
  /// Solves in place.
  virtual void solve(double* b) = 0;
};

/// f(t, y) and its derivative. Evaluated at a break, both are the limits from the right.
class RateSystem : public FirstOrderSystem {
 public:
  virtual void rhs(double t, const double* y, double* rate) const = 0;
  /// df/dy: the entries of the pattern in its order, or all n*n column by column.
  virtual void jacobian(double t, const double* y, double* values) const = 0;
};

/// y' = f(t, y), as CVODE and ARKODE take it. Erased once, so that each SUNDIALS wrapper is compiled once.
class OdeSystem : public RateSystem {
 public:
  /// The system's own solver, which may use up to all of its structure; none means by a matrix. Refers to
  /// the system.
  virtual std::unique_ptr<NewtonSolver> newton_solver() const { return nullptr; }
};

/// M y' = f(t, y) with a constant regular M, as ARKODE takes it.
class MassSystem : public RateSystem {
 public:
  /// M, laid out as the Jacobian.
  virtual void mass(double* values) const = 0;
};

/// F(t, y, y') = 0, as IDA takes it.
class DaeSystem : public FirstOrderSystem {
 public:
  /// From y just before time t to consistent values just behind it: rates, and in y what jumps there, such
  /// as velocities under an impulse or algebraic variables.
  virtual void resume(double t, double* y, double* rate) const = 0;
  virtual void residual(double t, const double* y, const double* rate, double* value) const = 0;
  /// dF/dy + cj dF/dy', laid out as in RateSystem::jacobian.
  virtual void jacobian(double t, double cj, const double* y, const double* rate, double* values) const = 0;
  /// For each component whether its derivative is absent (1: algebraic, 0: differential).
  virtual std::vector<int> algebraic() const = 0;
};

/// What the forms of a model share: the same functions as FirstOrderSystem on its State, nothing virtual.
/// `pack` takes the state at a time and `unpack` gives it back.
template <class F, class M>
concept FormOf = requires(const F& form, const typename M::State& state, double t, const double* y,
                          double* out) {
  { form.size() } -> std::convertible_to<int>;
  { form.scales() } -> std::same_as<std::vector<double>>;
  { form.sparsity() } -> std::same_as<std::optional<SparsePattern>>;
  form.pack(t, state, out);
  { form.unpack(t, y) } -> std::same_as<typename M::State>;
};

/// y' = f(t, y). May offer `newton_solver()`: a value with the functions of NewtonSolver.
template <class F, class M>
concept OdeFormOf = FormOf<F, M> && requires(const F& form, double t, const double* y, double* out) {
  form.rhs(t, y, out);
  form.jacobian(t, y, out);
};

/// M y' = f(t, y).
template <class F, class M>
concept MassFormOf = OdeFormOf<F, M> && requires(const F& form, double* out) {
  form.mass(out);
};

/// F(t, y, y') = 0.
template <class F, class M>
concept DaeFormOf = FormOf<F, M> && requires(const F& form, double t, const double* y, double* out) {
  { form.algebraic() } -> std::same_as<std::vector<int>>;
  form.resume(t, out, out);
  form.residual(t, y, y, out);
  form.jacobian(t, t, y, y, out);
};

template <class M>
concept HasOde = Model<M> && requires(const M& model) {
  { model.ode() } -> OdeFormOf<M>;
};
template <class M>
concept HasMassForm = Model<M> && requires(const M& model) {
  { model.mass_form() } -> MassFormOf<M>;
};
template <class M>
concept HasDae = Model<M> && requires(const M& model) {
  { model.dae() } -> DaeFormOf<M>;
};
/// A DAE form of index 2, kept to show that it ends with a reason.
template <class M>
concept HasIndex2Dae = Model<M> && requires(const M& model) {
  { model.dae_index2() } -> DaeFormOf<M>;
};

/// The same of index 3.
template <class M>
concept HasIndex3Dae = Model<M> && requires(const M& model) {
  { model.dae_index3() } -> DaeFormOf<M>;
};

/// A model whose constraints may be kept as equations, in the stabilised form; it says whether it has any
/// that may.
template <class M>
concept HasConstraintDae = Model<M> && requires(const M& model) {
  { model.dae_constraints() } -> DaeFormOf<M>;
  { model.is_constrained() } -> std::same_as<bool>;
};

namespace detail {

/// The part of the erasure that all forms share. The model has to outlive it.
template <class Base, Model M, class F>
class Erased : public Base {
 public:
  Erased(const M& model, F form) : model_(model), form_(std::move(form)) {
    for (const InvariantInfo& info : model_.invariant_info()) count_ += info.size;
  }
  int size() const final { return form_.size(); }
  std::vector<double> scales() const final { return form_.scales(); }
  std::vector<double> breaks() const final { return model_.breaks(); }
  std::optional<SparsePattern> sparsity() const final { return form_.sparsity(); }
  int invariant_count() const final { return count_; }
  void invariants(double t, const double* y, double* out) const final {
    model_.invariants(t, form_.unpack(t, y), out);
  }
  std::vector<double> model_state(double t, const double* y) const final {
    return model_.flatten(form_.unpack(t, y));
  }
  void start(double* y) const final { form_.pack(0.0, model_.initial(), y); }

 protected:
  const M& model_;
  F form_;
  int count_ = 0;
};

template <class Base, Model M, class F>
class ErasedRate : public Erased<Base, M, F> {
 public:
  using Erased<Base, M, F>::Erased;
  void rhs(double t, const double* y, double* rate) const final { this->form_.rhs(t, y, rate); }
  void jacobian(double t, const double* y, double* values) const final { this->form_.jacobian(t, y, values); }
};

template <class S>
class ErasedNewton final : public NewtonSolver {
 public:
  explicit ErasedNewton(S solver) : solver_(std::move(solver)) {}
  void linearise(double t, const double* y) override { solver_.linearise(t, y); }
  void factorise(double gamma) override { solver_.factorise(gamma); }
  void solve(double* b) override { solver_.solve(b); }

 private:
  S solver_;
};

template <Model M, class F>
class ErasedOde final : public ErasedRate<OdeSystem, M, F> {
 public:
  using ErasedRate<OdeSystem, M, F>::ErasedRate;
  std::unique_ptr<NewtonSolver> newton_solver() const override {
    if constexpr (requires(const F& form) { form.newton_solver(); })
      return std::make_unique<ErasedNewton<decltype(this->form_.newton_solver())>>(
          this->form_.newton_solver());
    else
      return nullptr;
  }
};

template <Model M, class F>
class ErasedMass final : public ErasedRate<MassSystem, M, F> {
 public:
  using ErasedRate<MassSystem, M, F>::ErasedRate;
  void mass(double* values) const override { this->form_.mass(values); }
};

template <Model M, class F>
class ErasedDae final : public Erased<DaeSystem, M, F> {
 public:
  using Erased<DaeSystem, M, F>::Erased;
  void resume(double t, double* y, double* rate) const override { this->form_.resume(t, y, rate); }
  void residual(double t, const double* y, const double* rate, double* value) const override {
    this->form_.residual(t, y, rate, value);
  }
  void jacobian(double t, double cj, const double* y, const double* rate, double* values) const override {
    this->form_.jacobian(t, cj, y, rate, values);
  }
  std::vector<int> algebraic() const override { return this->form_.algebraic(); }
};

}  // namespace detail

template <HasOde M>
std::unique_ptr<OdeSystem> erase_ode(const M& model) {
  auto form = model.ode();
  return std::make_unique<detail::ErasedOde<M, decltype(form)>>(model, std::move(form));
}

template <HasMassForm M>
std::unique_ptr<MassSystem> erase_mass(const M& model) {
  auto form = model.mass_form();
  return std::make_unique<detail::ErasedMass<M, decltype(form)>>(model, std::move(form));
}

template <Model M, class F>
requires DaeFormOf<F, M> std::unique_ptr<DaeSystem> erase_dae(const M& model, F form) {
  return std::make_unique<detail::ErasedDae<M, F>>(model, std::move(form));
}

}  // namespace gnomon
