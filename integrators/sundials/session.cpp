#include "integrators/sundials/session.hpp"

#include <fmt/format.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#ifndef GNOMON_SUNDIALS_RECORD
#define GNOMON_SUNDIALS_RECORD ""
#endif

namespace gnomon::sundials {

Context::Context(Messages& messages) {
  if (create_context(&context_, &messages) != 0) throw std::runtime_error("SUNContext_Create failed");
}
Context::~Context() { SUNContext_Free(&context_); }

Linear make_linear(const FirstOrderSystem& system, N_Vector like, SUNContext context) {
  Linear linear;
  const sunindextype n = system.size();
  if (const auto pattern = system.sparsity()) {
    linear.matrix.reset(
        SUNSparseMatrix(n, n, static_cast<sunindextype>(pattern->row.size()), CSC_MAT, context));
    linear.solver.reset(SUNLinSol_KLU(like, linear.matrix.get(), context));
  } else {
    linear.matrix.reset(SUNDenseMatrix(n, n, context));
    linear.solver.reset(SUNLinSol_Dense(like, linear.matrix.get(), context));
  }
  if (!linear.matrix || !linear.solver) throw std::runtime_error("SUNDIALS could not make a linear solver");
  return linear;
}

namespace {

SUNMatrix_ID matrix_id(SUNMatrix) { return SUNMATRIX_CUSTOM; }
SUNLinearSolver_Type solver_type(SUNLinearSolver) { return SUNLINEARSOLVER_DIRECT; }
SUNLinearSolver_ID solver_id(SUNLinearSolver) { return SUNLINEARSOLVER_CUSTOM; }
int solver_set_up(SUNLinearSolver, SUNMatrix) { return 0; }
int solver_solve(SUNLinearSolver solver, SUNMatrix, N_Vector x, N_Vector b, sunrealtype) {
  double* values = N_VGetArrayPointer(x);
  std::copy_n(N_VGetArrayPointer(b), N_VGetLength(b), values);
  static_cast<NewtonSolver*>(solver->content)->solve(values);
  return std::all_of(values, values + N_VGetLength(x), [](double v) { return std::isfinite(v); })
             ? 0
             : SUNLS_LUFACT_FAIL;
}
int solver_free(SUNLinearSolver solver) {
  solver->content = nullptr;
  SUNLinSolFreeEmpty(solver);
  return 0;
}

}  // namespace

Linear make_linear(NewtonSolver& newton, SUNContext context) {
  Linear linear;
  linear.matrix.reset(SUNMatNewEmpty(context));
  linear.solver.reset(SUNLinSolNewEmpty(context));
  if (!linear.matrix || !linear.solver) throw std::bad_alloc();
  linear.matrix->ops->getid = matrix_id;
  linear.solver->ops->gettype = solver_type;
  linear.solver->ops->getid = solver_id;
  linear.solver->ops->setup = solver_set_up;
  linear.solver->ops->solve = solver_solve;
  linear.solver->ops->free = solver_free;
  linear.solver->content = &newton;
  return linear;
}

Linear make_krylov(N_Vector like, SUNContext context) {
  Linear linear;
  linear.solver.reset(SUNLinSol_SPGMR(like, SUN_PREC_LEFT, 0, context));
  if (!linear.solver) throw std::bad_alloc();
  return linear;
}

double* matrix_values(SUNMatrix matrix, const std::optional<SparsePattern>& pattern) {
  if (!pattern) return SUNDenseMatrix_Data(matrix);
  std::copy(pattern->column_start.begin(), pattern->column_start.end(),
            SUNSparseMatrix_IndexPointers(matrix));
  std::copy(pattern->row.begin(), pattern->row.end(), SUNSparseMatrix_IndexValues(matrix));
  return SUNSparseMatrix_Data(matrix);
}

Session::Session(const FirstOrderSystem& system, const RunSpec& spec)
    : context_(messages_),
      size_(system.size()),
      rtol_(spec.tol.value_or(1e-6)),
      max_steps_(spec.max_steps),
      pattern_(system.sparsity()),
      breaks_(system.breaks()) {
  enter_segment();
  y_ = make_vector();
  std::vector<double> absolute = system.scales();
  for (double& value : absolute) value *= rtol_;
  atol_ = make_vector(absolute);
}

void Session::enter_segment() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto next = std::upper_bound(breaks_.begin(), breaks_.end(), t_);
  segment_end_ = next == breaks_.end() ? infinity : *next;
  before_segment_end_ = std::nextafter(segment_end_, -infinity);
}

Vector Session::make_vector() const {
  Vector vector(N_VNew_Serial(size_, context_));
  if (!vector) throw std::bad_alloc();
  N_VConst(0.0, vector.get());
  return vector;
}

Vector Session::make_vector(const std::vector<double>& values) const {
  Vector vector = make_vector();
  std::copy(values.begin(), values.end(), N_VGetArrayPointer(vector.get()));
  return vector;
}

void Session::require_finite(const double* values, int size) {
  double sum = 0.0;
  for (int i = 0; i < size; ++i) sum += 0.0 * values[i];
  if (!(sum == 0.0)) throw RecoverableError();
}

Status Session::finish(int flag, char* (*flag_name)(long), const char* solver) {
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  if (flag >= 0) return Status::ok;
  char* name = flag_name(flag);
  message_ = fmt::format("{} at t = {:.6g} s: {}", solver, t_, name ? name : "unknown flag");
  if (!messages_.last.empty()) message_ += fmt::format(" ({})", messages_.last);
  std::free(name);
  std::replace(message_.begin(), message_.end(), '\n', ' ');
  return flag == CV_TOO_MUCH_WORK ? Status::step_limit : Status::solver_failed;
}

void Session::check(int flag, const char* call) const {
  if (flag < 0) throw std::runtime_error(fmt::format("{} failed with {}: {}", call, flag, messages_.last));
}

bool optimised() {
  const std::string record = build_record();
  return record.find("-O2") != std::string::npos || record.find("-O3") != std::string::npos ||
         record.find("build_type=Release") != std::string::npos;
}
std::string build_record() { return GNOMON_SUNDIALS_RECORD; }

}  // namespace gnomon::sundials
