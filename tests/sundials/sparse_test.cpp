// Systems that declare the pattern of their Jacobian are solved with KLU, and as the same system without it.

#include <cmath>

#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include "integrators/sundials/session.hpp"
#include "tests/catch.hpp"
#include "tests/sundials/systems.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

constexpr int cells = 50;
const double pi = std::acos(-1.0);

double mode(int k) { return std::sin(pi * (k + 1) / (cells + 1)); }

// Heat conduction in a rod of 50 cells, ends held at 0, from a sine wave: it decays at the rate returned by
// `decay`.
double decay() { return 4.0 * std::pow(std::sin(0.5 * pi / (cells + 1)), 2.0) * cells; }

TestOde heat(bool sparse) {
  TestOde ode;
  for (int k = 0; k < cells; ++k) ode.initial.push_back(mode(k));
  ode.f = [](double, const double* y, double* rate) {
    for (int k = 0; k < cells; ++k)
      rate[k] = cells * ((k > 0 ? y[k - 1] : 0.0) - 2.0 * y[k] + (k + 1 < cells ? y[k + 1] : 0.0));
  };
  ode.df = [](double, const double*, double* dense) {
    for (int k = 0; k < cells; ++k) {
      dense[k * cells + k] = -2.0 * cells;
      if (k > 0) dense[(k - 1) * cells + k] = dense[k * cells + k - 1] = cells;
    }
  };
  Places places;
  for (int k = 0; k < cells; ++k)
    for (int other : {k - 1, k, k + 1})
      if (other >= 0 && other < cells) places.emplace_back(k, other);
  if (sparse) ode.pattern = pattern_of(cells, places);
  return ode;
}

// A chain of 50 masses between springs, (x, v): x' = v, v' = second difference of x. Its Jacobian has no
// diagonal. The first mode swings as cos(frequency t).
double frequency() { return 2.0 * std::sin(0.5 * pi / (cells + 1)); }

TestOde chain(bool sparse, bool with_diagonal) {
  constexpr int n = 2 * cells;
  TestOde ode;
  for (int k = 0; k < cells; ++k) ode.initial.push_back(mode(k));
  ode.initial.resize(n, 0.0);
  ode.f = [](double, const double* y, double* rate) {
    for (int k = 0; k < cells; ++k) {
      rate[k] = y[cells + k];
      rate[cells + k] = (k > 0 ? y[k - 1] : 0.0) - 2.0 * y[k] + (k + 1 < cells ? y[k + 1] : 0.0);
    }
  };
  Places places;
  for (int k = 0; k < cells; ++k) {
    places.emplace_back(k, cells + k);
    for (int other : {k - 1, k, k + 1})
      if (other >= 0 && other < cells) places.emplace_back(cells + k, other);
  }
  ode.df = [places](double, const double*, double* dense) {
    for (const auto& [row, column] : places)
      dense[column * n + row] = row < cells ? 1.0 : row == cells + column ? -2.0 : 1.0;
  };
  if (with_diagonal)
    for (int k = 0; k < n; ++k) places.emplace_back(k, k);
  if (sparse) ode.pattern = pattern_of(n, places);
  return ode;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, std::abs(a[k] - b[k]));
  return largest;
}

// The two runs take the same steps; the factorisations round differently.
void check_same(const RunResult& dense, const RunResult& sparse) {
  REQUIRE(dense.status == Status::ok);
  REQUIRE(sparse.status == Status::ok);
  CHECK(largest_difference(dense.state, sparse.state) <= 1e-10);
  CHECK(std::abs(dense.cost.steps - sparse.cost.steps) <= dense.cost.steps / 20 + 1);
  for (const Cost& cost : {dense.cost, sparse.cost}) {
    CHECK(cost.factorizations >= 2);
    CHECK(cost.jacobians >= 1);
    CHECK(cost.jacobians <= cost.factorizations);
    CHECK(cost.factorizations <= 4 * cost.steps);
    CHECK(cost.newton_iterations >= cost.steps);
  }
}

}  // namespace

TEST_CASE("sundials: heat conduction with KLU and with a dense matrix", "[sundials]") {
  const RunSpec spec = tolerance(2.0, 1e-8);
  const double amplitude = std::exp(-decay() * 2.0);
  const auto check = [&](const RunResult& dense, const RunResult& sparse) {
    check_same(dense, sparse);
    for (int k = 0; k < cells; ++k) CHECK(std::abs(sparse.state[k] - amplitude * mode(k)) <= 1e-5);
  };
  for (const OdeSolver& solver : ode_solvers) {
    if (!solver.implicit) continue;
    INFO(solver.name);
    check(run_ode(solver, heat(false), spec), run_ode(solver, heat(true), spec));
  }
  INFO("ida-bdf");
  check(run_dae(as_dae(heat(false)), spec), run_dae(as_dae(heat(true)), spec));
}

TEST_CASE("sundials: a chain of oscillators with KLU and with a dense matrix", "[sundials]") {
  const RunSpec spec = tolerance(20.0, 1e-8);
  const double amplitude = std::cos(frequency() * 20.0);
  const auto check = [&](const RunResult& dense, const RunResult& sparse) {
    check_same(dense, sparse);
    for (int k = 0; k < cells; ++k) CHECK(std::abs(sparse.state[k] - amplitude * mode(k)) <= 1e-5);
  };
  for (const OdeSolver& solver : ode_solvers) {
    if (!solver.implicit) continue;
    INFO(solver.name);
    const RunResult dense = run_ode(solver, chain(false, false), spec);
    check(dense, run_ode(solver, chain(true, true), spec));
    // Without the diagonal in the pattern the solver has to add it for 1 - gamma J.
    check(dense, run_ode(solver, chain(true, false), spec));
  }
  INFO("ida-bdf");
  check(run_dae(as_dae(chain(false, true)), spec), run_dae(as_dae(chain(true, true)), spec));
}

TEST_CASE("sundials: the pattern decides where the values go", "[sundials]") {
  // A Jacobian whose declared pattern misses the coupling makes Newton's iteration slow, not the result
  // wrong; one that is written to the wrong places shows in the cost. Both are seen.
  const RunSpec spec = tolerance(2.0, 1e-8);
  const OdeSolver& bdf = ode_solvers[1];
  REQUIRE(bdf.name == "cvode-bdf");
  const RunResult right = run_ode(bdf, heat(true), spec);
  TestOde transposed = heat(true);
  transposed.df = [](double, const double*, double* dense) {
    for (int k = 0; k < cells; ++k) dense[k * cells + k] = 2.0 * cells;
  };
  const RunResult wrong = run_ode(bdf, transposed, spec);
  CHECK((wrong.status != Status::ok || wrong.cost.newton_iterations > 2 * right.cost.newton_iterations));
}

TEST_CASE("sundials: a declared pattern chooses the matrix and the solver", "[sundials]") {
  gnomon::sundials::Messages messages;
  const gnomon::sundials::Context context(messages);
  const gnomon::sundials::Vector like(N_VNew_Serial(cells, context));
  const gnomon::sundials::Linear dense = gnomon::sundials::make_linear(heat(false), like.get(), context);
  CHECK(SUNMatGetID(dense.matrix.get()) == SUNMATRIX_DENSE);
  CHECK(SUNLinSolGetID(dense.solver.get()) == SUNLINEARSOLVER_DENSE);
  const TestOde system = heat(true);
  const gnomon::sundials::Linear sparse = gnomon::sundials::make_linear(system, like.get(), context);
  CHECK(SUNMatGetID(sparse.matrix.get()) == SUNMATRIX_SPARSE);
  CHECK(SUNLinSolGetID(sparse.solver.get()) == SUNLINEARSOLVER_KLU);
  CHECK(SUNSparseMatrix_NNZ(sparse.matrix.get()) == 3 * cells - 2);
  CHECK(system.pattern->column_start.back() == 3 * cells - 2);
  // The entries go to the places of the pattern.
  std::vector<double> full(cells * cells);
  system.df(0.0, system.initial.data(), full.data());
  system.jacobian(0.0, system.initial.data(),
                  gnomon::sundials::matrix_values(sparse.matrix.get(), system.pattern));
  const gnomon::sundials::Vector product(N_VNew_Serial(cells, context));
  for (int k = 0; k < cells; ++k) N_VGetArrayPointer(like.get())[k] = mode(k) + 0.1 * k;
  REQUIRE(SUNMatMatvec(sparse.matrix.get(), like.get(), product.get()) == 0);
  for (int row = 0; row < cells; ++row) {
    double expected = 0.0;
    for (int k = 0; k < cells; ++k) expected += full[k * cells + row] * N_VGetArrayPointer(like.get())[k];
    CHECK(std::abs(N_VGetArrayPointer(product.get())[row] - expected) <= 1e-10);
  }
}
