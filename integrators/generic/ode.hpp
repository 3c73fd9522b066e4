#pragma once
// What the generic integrators of y' = f(t, y) share: the right-hand side, the outcome, compensated addition.

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace gnomon::generic {

/// Right-hand side of y' = f(t, y): f(t, y, dydt) writes dydt. It says that it cannot be evaluated by writing
/// NaN.
template <class F, class Real>
concept Rhs = requires(F& f, Real t, const Real* y, Real* dydt) {
  f(t, y, dydt);
};

/// Why an integration ended.
enum class Status { success, invalid_argument, not_finite, step_too_small, no_convergence, evaluation_limit };

/// What an integration did. On failure y holds the state at t, the last time that was reached.
template <class Real>
struct Outcome {
  bool ok = false;
  std::string message;                       ///< empty on success
  Real t{};                                  ///< time reached; exactly t1 on success
  long steps = 0;                            ///< accepted steps
  long evaluations = 0;                      ///< calls of f
  Status status = Status::invalid_argument;  ///< `ok` is status == success
  long rejected = 0;                         ///< rejected steps (adaptive methods)
  long rounding_limited =
      0;             ///< accepted steps whose tolerance was below what rounding allows (adaptive methods)
  Real next_step{};  ///< step size that the method would try next (adaptive methods)
};

namespace detail {

/// "what (t = 1.25)"
template <class Real>
std::string at_time(const char* what, Real t) {
  char text[64];
  std::snprintf(text, sizeof text, " (t = %.12Lg)", static_cast<long double>(t));
  return std::string(what) + text;
}

template <class Real>
void finish(Outcome<Real>& out, Status status, Real t, std::string message = {}) {
  out.status = status;
  out.ok = status == Status::success;
  out.t = t;
  out.message = std::move(message);
}

template <class Real>
bool all_finite(const Real* x, std::size_t n) {
  using std::isfinite;
  for (std::size_t i = 0; i < n; ++i)
    if (!isfinite(x[i])) return false;
  return true;
}

/// Empty if the arguments that every integrator has are usable, else what is wrong with them.
template <class Real>
std::string check_arguments(const std::vector<Real>& y, Real t0, Real t1, const std::vector<Real>& scale) {
  using std::isfinite;
  if (!isfinite(t0) || !isfinite(t1)) return "the time interval is not finite";
  if (scale.size() != y.size()) return "scale and state differ in size";
  if (!all_finite(y.data(), y.size())) return "the initial state is not finite";
  for (const Real& s : scale)
    if (!isfinite(s) || !(s > 0)) return "a scale is not positive and finite";
  return {};
}

/// value + residue += increment with the rounding error kept in `residue` (Kahan's summation with Knuth's
/// two-sum).
template <class Real>
void add_compensated(Real& value, Real& residue, Real increment) {
  const Real addend = residue + increment;
  const Real sum = value + addend;
  const Real part = sum - value;
  residue = (value - (sum - part)) + (addend - part);
  value = sum;
}

}  // namespace detail
}  // namespace gnomon::generic
