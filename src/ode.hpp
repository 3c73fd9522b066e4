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
  /// The model state of y, flattened.
  virtual std::vector<double> model_state(const double* y) const = 0;
};

/// y' = f(t, y), as CVODE and ARKODE take it. Erased once, so that each SUNDIALS wrapper is compiled once.
class OdeSystem : public FirstOrderSystem {
 public:
  virtual void start(double* y) const = 0;
  virtual void rhs(double t, const double* y, double* rate) const = 0;
  /// df/dy: the entries of the pattern in its order, or all n*n column by column.
  virtual void jacobian(double t, const double* y, double* values) const = 0;
};

/// F(t, y, y') = 0, as IDA takes it.
class DaeSystem : public FirstOrderSystem {
 public:
  /// A consistent start: F(0, y, y') = 0 and its hidden constraints hold.
  virtual void start(double* y, double* rate) const = 0;
  virtual void residual(double t, const double* y, const double* rate, double* value) const = 0;
  /// dF/dy + cj dF/dy', laid out as in OdeSystem::jacobian.
  virtual void jacobian(double t, double cj, const double* y, const double* rate, double* values) const = 0;
  /// For each component whether its derivative is absent (1: algebraic, 0: differential).
  virtual std::vector<int> algebraic() const = 0;
};

/// A model's own ODE form: the same functions as OdeSystem on its State, nothing virtual.
template <class F, class M>
concept OdeFormOf = requires(const F& form, const typename M::State& state, double t, const double* y,
                             double* out) {
  { form.size() } -> std::convertible_to<int>;
  { form.scales() } -> std::same_as<std::vector<double>>;
  { form.sparsity() } -> std::same_as<std::optional<SparsePattern>>;
  form.pack(state, out);
  { form.unpack(y) } -> std::same_as<typename M::State>;
  form.rhs(t, y, out);
  form.jacobian(t, y, out);
};

template <class F, class M>
concept DaeFormOf = requires(const F& form, const typename M::State& state, double t, const double* y,
                             double* out, double* rate) {
  { form.size() } -> std::convertible_to<int>;
  { form.scales() } -> std::same_as<std::vector<double>>;
  { form.sparsity() } -> std::same_as<std::optional<SparsePattern>>;
  { form.algebraic() } -> std::same_as<std::vector<int>>;
  form.pack(state, out, rate);
  { form.unpack(y) } -> std::same_as<typename M::State>;
  form.residual(t, y, y, out);
  form.jacobian(t, t, y, y, out);
};

template <class M>
concept HasOde = Model<M> && requires(const M& model) {
  { model.ode() } -> OdeFormOf<M>;
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

namespace detail {

/// The part of the erasure that ODE and DAE forms share. The model has to outlive it.
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
    model_.invariants(t, form_.unpack(y), out);
  }
  std::vector<double> model_state(const double* y) const final { return model_.flatten(form_.unpack(y)); }

 protected:
  const M& model_;
  F form_;
  int count_ = 0;
};

template <Model M, class F>
class ErasedOde final : public Erased<OdeSystem, M, F> {
 public:
  using Erased<OdeSystem, M, F>::Erased;
  void start(double* y) const override { this->form_.pack(this->model_.initial(), y); }
  void rhs(double t, const double* y, double* rate) const override { this->form_.rhs(t, y, rate); }
  void jacobian(double t, const double* y, double* values) const override {
    this->form_.jacobian(t, y, values);
  }
};

template <Model M, class F>
class ErasedDae final : public Erased<DaeSystem, M, F> {
 public:
  using Erased<DaeSystem, M, F>::Erased;
  void start(double* y, double* rate) const override { this->form_.pack(this->model_.initial(), y, rate); }
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

template <Model M, class F>
requires DaeFormOf<F, M> std::unique_ptr<DaeSystem> erase_dae(const M& model, F form) {
  return std::make_unique<detail::ErasedDae<M, F>>(model, std::move(form));
}

}  // namespace gnomon
