#pragma once
#include <string_view>

namespace gnomon {

/// How a run ended. A failed run is a result like any other: it has a status, a reason and the time it
/// reached.
enum class Status {
  ok,
  diverged,
  newton_failed,
  solver_failed,
  step_limit,
  time_limit,
  crashed,  ///< of a run in a process of its own: a signal, an exception, or more memory than it may have
  interrupted,
  unsupported
};

/// The name that tables and JSON use.
constexpr std::string_view to_string(Status status) {
  switch (status) {
    case Status::ok:
      return "ok";
    case Status::diverged:
      return "diverged";
    case Status::newton_failed:
      return "newton_failed";
    case Status::solver_failed:
      return "solver_failed";
    case Status::step_limit:
      return "step_limit";
    case Status::time_limit:
      return "time_limit";
    case Status::crashed:
      return "crashed";
    case Status::interrupted:
      return "interrupted";
    case Status::unsupported:
      return "unsupported";
  }
  return "unsupported";
}

/// The status of that name; unsupported for any other.
constexpr Status status_named(std::string_view name) {
  for (const Status status : {Status::ok, Status::diverged, Status::newton_failed, Status::solver_failed,
                              Status::step_limit, Status::time_limit, Status::crashed, Status::interrupted})
    if (to_string(status) == name) return status;
  return Status::unsupported;
}

/// What a run cost, counted rather than timed. What a scheme does not do stays 0.
struct Cost {
  long steps = 0;      ///< accepted steps
  long rejected = 0;   ///< steps that failed the error test or their nonlinear solve and were repeated
  long rhs = 0;        ///< evaluations of the rates (right-hand side, residual, or stage angular velocity)
  long moments = 0;    ///< evaluations of the external moment by schemes that need it apart from the rates
  long jacobians = 0;  ///< Jacobian evaluations
  long factorizations = 0;     ///< matrix factorisations (linear solver set-ups)
  long newton_iterations = 0;  ///< nonlinear iterations, also those of a fixed-point iteration
};

}  // namespace gnomon
