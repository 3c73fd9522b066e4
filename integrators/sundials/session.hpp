#pragma once
#include <algorithm>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>

#include "integrators/sundials/compat.hpp"
#include "src/ode.hpp"
#include "src/run.hpp"

namespace gnomon::sundials {

/// An error of the user's equations that a smaller step may avoid.
struct RecoverableError : std::exception {
  const char* what() const noexcept override { return "a value of the equations is not finite"; }
};

/// Owners of the C objects. The context outlives everything made with it.
class Context {
 public:
  explicit Context(Messages& messages);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  operator SUNContext() const { return context_; }

 private:
  SUNContext context_ = nullptr;
};

struct Deleter {
  void operator()(N_Vector v) const { N_VDestroy(v); }
  void operator()(SUNMatrix m) const { SUNMatDestroy(m); }
  void operator()(SUNLinearSolver s) const { SUNLinSolFree(s); }
};
using Vector = std::unique_ptr<std::remove_pointer_t<N_Vector>, Deleter>;
using Matrix = std::unique_ptr<std::remove_pointer_t<SUNMatrix>, Deleter>;
using LinearSolver = std::unique_ptr<std::remove_pointer_t<SUNLinearSolver>, Deleter>;

/// Owner of the memory of an integrator, freed by the integrator's own function, also when its set-up fails
/// half way.
class Memory {
 public:
  Memory(void* memory, void (*release)(void**)) : memory_(memory), release_(release) {}
  ~Memory() {
    if (memory_) release_(&memory_);
  }
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  operator void*() const { return memory_; }

 private:
  void* memory_;
  void (*release_)(void**);
};

/// A dense or, where the system declares a pattern, a sparse matrix with KLU.
struct Linear {
  Matrix matrix;
  LinearSolver solver;
};
Linear make_linear(const FirstOrderSystem& system, N_Vector like, SUNContext context);

/// The solver of a system that eliminates its own; its matrix is empty.
Linear make_linear(NewtonSolver& newton, SUNContext context);

/// GMRES with a preconditioner on the left and no matrix.
Linear make_krylov(N_Vector like, SUNContext context);

/// Calls `fill(values)` on the entries of a dense matrix (all, by columns) or of a sparse one (in the
/// pattern's order).
double* matrix_values(SUNMatrix matrix, const std::optional<SparsePattern>& pattern);

/// What the solvers share: context, state, tolerances, counters, and exceptions carried across the C
/// boundary.
class Session : public AdaptiveSolver {
 public:
  double t() const final { return t_; }
  const double* y() const final { return N_VGetArrayPointer(y_.get()); }
  std::string message() const final { return message_; }

 protected:
  Session(const FirstOrderSystem& system, const RunSpec& spec);

  Vector make_vector(const std::vector<double>& values) const;
  Vector make_vector() const;

  /// Runs a callback's body and turns what it throws into SUNDIALS' return codes: 0, +1 recoverable, -1
  /// fatal.
  template <class Body>
  int guarded(Body&& body) noexcept {
    try {
      body();
      return 0;
    } catch (const RecoverableError&) {
      return 1;
    } catch (...) {
      failure_ = std::current_exception();
      return -1;
    }
  }
  static void require_finite(const double* values, int size);
  /// The time at which the equations are to be evaluated: before a break, the limit from that side.
  double one_sided(double t) const { return t < segment_end_ ? t : before_segment_end_; }
  /// How many steps the next call may take.
  long call_limit(long steps_so_far) const { return std::clamp(max_steps_ - steps_so_far, 1L, step_window); }
  /// To be called at the start and at each restart.
  void enter_segment();

  /// Turns a return code of a solver into a status and a message, and rethrows what a callback threw.
  Status finish(int flag, char* (*flag_name)(long), const char* solver);
  /// Throws std::runtime_error when a set-up call failed.
  void check(int flag, const char* call) const;

  Messages messages_;
  Context context_;
  Vector y_;
  double t_ = 0.0;
  int size_;
  double rtol_;
  Vector atol_;
  long max_steps_;  ///< of the whole run
  std::optional<SparsePattern> pattern_;
  Linear linear_;
  std::vector<double> breaks_;
  double segment_end_ = 0.0;  ///< the next break; infinite when there is none
  double before_segment_end_ = 0.0;
  double stop_ = -1.0;  ///< the stop time that the solver has been told
  long rhs_ = 0;
  std::exception_ptr failure_;
  std::string message_;
};

/// True if the library that is linked was compiled with optimisation, by the record that its build left
/// beside it; packaged libraries leave none and are compiled without.
bool optimised();
/// Compiler flags of that record, or empty.
std::string build_record();

}  // namespace gnomon::sundials
