#pragma once
// Small first-order systems for tests of the solvers alone, without a model.

#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "integrators/sundials/schemes.hpp"
#include "src/ode.hpp"
#include "src/run.hpp"

namespace gnomon::test {

/// Non-zero places of a matrix, for systems that declare them.
using Places = std::vector<std::pair<int, int>>;  // (row, column)

inline SparsePattern pattern_of(int size, const Places& places) {
  SparsePattern pattern;
  for (int column = 0; column < size; ++column) {
    pattern.column_start.push_back(static_cast<long>(pattern.row.size()));
    for (int row = 0; row < size; ++row)
      for (const auto& place : places)
        if (place == std::pair(row, column)) pattern.row.push_back(row);
  }
  pattern.column_start.push_back(static_cast<long>(pattern.row.size()));
  return pattern;
}

/// A dense matrix, column by column, as the entries of a pattern; all of it where there is none.
inline void store(const std::vector<double>& dense, int size, const std::optional<SparsePattern>& pattern,
                  double* values) {
  if (!pattern) {
    std::copy(dense.begin(), dense.end(), values);
    return;
  }
  for (int column = 0; column < size; ++column)
    for (long k = pattern->column_start[column]; k < pattern->column_start[column + 1]; ++k)
      *values++ = dense[static_cast<std::size_t>(column * size + pattern->row[k])];
}

/// y' = f(t, y) of functions given by the test; the state is its own model state.
struct TestOde : OdeSystem {
  std::vector<double> initial;
  std::function<void(double t, const double* y, double* rate)> f;
  std::function<void(double t, const double* y, double* dense)> df;  ///< n x n, by columns, zero on entry
  std::vector<double> break_times;
  std::optional<SparsePattern> pattern;
  mutable long rhs_calls = 0, jacobian_calls = 0;

  int size() const override { return static_cast<int>(initial.size()); }
  std::vector<double> scales() const override { return std::vector<double>(initial.size(), 1.0); }
  std::vector<double> breaks() const override { return break_times; }
  std::optional<SparsePattern> sparsity() const override { return pattern; }
  int invariant_count() const override { return 0; }
  void invariants(double, const double*, double*) const override {}
  std::vector<double> model_state(double, const double* y) const override { return {y, y + size()}; }
  void start(double* y) const override { std::copy(initial.begin(), initial.end(), y); }
  void rhs(double t, const double* y, double* rate) const override {
    ++rhs_calls;
    f(t, y, rate);
  }
  void jacobian(double t, const double* y, double* values) const override {
    ++jacobian_calls;
    std::vector<double> dense(initial.size() * initial.size());
    if (df) df(t, y, dense.data());
    store(dense, size(), pattern, values);
  }
};

/// The same system as F = y' - f(t, y) = 0, or with further algebraic rows 0 = g of the test's own.
struct TestDae : DaeSystem {
  std::vector<double> initial;
  /// Consistent values behind a break or the start; the rates are 0 on entry.
  std::function<void(double t, double* y, double* rate)> go_on;
  std::function<void(double t, const double* y, const double* rate, double* value)> F;
  std::function<void(double t, double cj, const double* y, double* dense)> dF;  ///< by columns, zero on entry
  std::vector<int> is_algebraic;
  std::vector<double> break_times;
  std::optional<SparsePattern> pattern;
  mutable long residual_calls = 0, jacobian_calls = 0;

  int size() const override { return static_cast<int>(initial.size()); }
  std::vector<double> scales() const override { return std::vector<double>(initial.size(), 1.0); }
  std::vector<double> breaks() const override { return break_times; }
  std::optional<SparsePattern> sparsity() const override { return pattern; }
  int invariant_count() const override { return 0; }
  void invariants(double, const double*, double*) const override {}
  std::vector<double> model_state(double, const double* y) const override { return {y, y + size()}; }
  void start(double* y) const override { std::copy(initial.begin(), initial.end(), y); }
  void resume(double t, double* y, double* rate) const override {
    std::fill(rate, rate + size(), 0.0);
    if (go_on) go_on(t, y, rate);
  }
  void residual(double t, const double* y, const double* rate, double* value) const override {
    ++residual_calls;
    F(t, y, rate, value);
  }
  void jacobian(double t, double cj, const double* y, const double*, double* values) const override {
    ++jacobian_calls;
    std::vector<double> dense(initial.size() * initial.size());
    dF(t, cj, y, dense.data());
    store(dense, size(), pattern, values);
  }
  std::vector<int> algebraic() const override {
    return is_algebraic.empty() ? std::vector<int>(initial.size(), 0) : is_algebraic;
  }
};

/// An explicit system in the form that IDA takes.
inline TestDae as_dae(const TestOde& ode) {
  TestDae dae;
  dae.initial = ode.initial;
  dae.go_on = [f = ode.f](double t, double* y, double* rate) { f(t, y, rate); };
  dae.F = [f = ode.f, n = ode.size()](double t, const double* y, const double* rate, double* value) {
    f(t, y, value);
    for (int k = 0; k < n; ++k) value[k] = rate[k] - value[k];
  };
  dae.dF = [df = ode.df, n = ode.size()](double t, double cj, const double* y, double* dense) {
    if (df) df(t, y, dense);
    for (int k = 0; k < n * n; ++k) dense[k] = (k % (n + 1) == 0 ? cj : 0.0) - dense[k];
  };
  dae.break_times = ode.break_times;
  dae.pattern = ode.pattern;
  return dae;
}

using OdeMaker = std::unique_ptr<AdaptiveSolver> (*)(const OdeSystem&, const RunSpec&);

struct OdeSolver {
  std::string_view name;
  OdeMaker make;
  bool implicit;
};
inline const OdeSolver ode_solvers[] = {
    {sundials::CvodeAdams::info.name, sundials::CvodeAdams::make, true},
    {sundials::CvodeBdf::info.name, sundials::CvodeBdf::make, true},
    {sundials::ArkodeErk4::info.name, sundials::ArkodeErk4::make, false},
    {sundials::ArkodeErk5::info.name, sundials::ArkodeErk5::make, false},
    {sundials::ArkodeErk8::info.name, sundials::ArkodeErk8::make, false},
    {sundials::ArkodeDirk::info.name, sundials::ArkodeDirk::make, true},
};

inline RunResult run_ode(const OdeSolver& solver, const OdeSystem& system, const RunSpec& spec) {
  return run_adaptive(*solver.make(system, spec), system, {}, spec);
}
inline RunResult run_dae(const DaeSystem& system, const RunSpec& spec) {
  return run_adaptive(*sundials::make_ida(system, spec), system, {}, spec);
}

inline RunSpec tolerance(double t_end, double tol) {
  RunSpec spec;
  spec.t_end = t_end;
  spec.tol = tol;
  spec.watch = 8;
  return spec;
}

}  // namespace gnomon::test
