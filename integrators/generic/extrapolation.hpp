#pragma once
// Extrapolation of the explicit midpoint rule (Gragg, Bulirsch, Stoer) with control of order and step size.
//
// W. B. Gragg, SIAM J. Numer. Anal. 2 (1965) 384; R. Bulirsch & J. Stoer, Numer. Math. 8 (1966) 1; the
// control follows P. Deuflhard, Numer. Math. 41 (1983) 399, and the code ODEX of E. Hairer, S. P. Norsett &
// G. Wanner, Solving Ordinary Differential Equations I, 2nd ed., section II.9.
//
// A step H is done with n_j = 2, 4, 6, 8, 12, 16, 24, ... substeps (Bulirsch's sequence, doubled). For even
// n_j the error of the last value has an expansion in even powers of H / n_j, so no smoothing step is needed.
// Increments, not states, are extrapolated and the state is summed with compensation: rounding then scales
// with the increment of a step.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "integrators/generic/ode.hpp"

namespace gnomon::generic {

/// Greatest number of rows of the extrapolation table, hence order 20 at most. The extrapolated value is a
/// sum of the rows' first values with weights whose moduli add up to less than 10 for any number of rows of
/// Bulirsch's sequence; with n_j = 2 j it would be 550 for ten rows, and rounding would be magnified as much.
inline constexpr int extrapolation_rows = 10;

/// An estimated error below this multiple of the machine epsilon times |y| is accepted whatever the
/// tolerance.
inline constexpr double extrapolation_rounding = 0.5;

namespace detail {

/// Number of substeps of row 1, 2, ...: 2, 4, 6, 8, 12, 16, 24, 32, ...
constexpr int substeps(int row) {
  if (row == 1) return 2;
  return row % 2 == 0 ? 4 << (row / 2 - 1) : 6 << (row / 2 - 1);
}

/// Evaluations of f for the rows 1..row; the one at the start of the step is shared.
constexpr int row_cost(int row) {
  int cost = 1;
  for (int j = 1; j <= row; ++j) cost += substeps(j) - 1;
  return cost;
}

/// Work space and last row of the extrapolation table of one step.
template <class Real, class F>
class ExtrapolationTable {
 public:
  ExtrapolationTable(F& f, std::vector<Real>& y, const std::vector<Real>& scale, Real tol)
      : f_(f), y_(y), scale_(scale), tol_(tol), n_(y.size()), store_((extrapolation_rows + 6) * n_, Real(0)) {
    Real* p = store_.data() + extrapolation_rows * n_;
    for (Real** part : {&residue_, &slope0_, &slope_, &even_, &odd_, &argument_}) {
      *part = p;
      p += n_;
    }
  }

  /// Evaluates f at the start of a step; false if it is not finite.
  bool begin(Real t) {
    t_ = t;
    f_(t, static_cast<const Real*>(y_.data()), slope0_);
    return all_finite(slope0_, n_);
  }

  /// Adds row `row` for the step H, which makes substeps(row) - 1 calls of f; false if something is not
  /// finite.
  bool add_row(int row, Real H) {
    midpoint(substeps(row), H);
    if (!all_finite(even_, n_) || !all_finite(odd_, n_)) return false;
    // Aitken-Neville, from the right: column c of row r overwrites column c of row r - 1 (stored at r - c).
    Real* fresh = column(row);
    std::copy(even_, even_ + n_, fresh);
    for (int c = row - 1; c >= 1; --c) {
      const Real ratio = Real(substeps(row)) / Real(substeps(c));
      const Real factor = ratio * ratio - Real(1);
      Real* old = column(c);
      const Real* right = column(c + 1);
      for (std::size_t i = 0; i < n_; ++i) old[i] = right[i] + (right[i] - old[i]) / factor;
    }
    return true;
  }

  /// Estimated error of the last row, in units of what is allowed; needs two rows.
  double error() {
    using std::abs;
    const Real eps = std::numeric_limits<Real>::epsilon();
    const Real* best = column(1);
    const Real* lower = column(2);
    Real worst = 0;
    rounding_limited_ = false;
    for (std::size_t i = 0; i < n_; ++i) {
      Real allowed = tol_ * scale_[i];
      const Real rounding =
          Real(extrapolation_rounding) * eps * std::max<Real>(abs(y_[i]), abs(y_[i] + best[i]));
      if (allowed < rounding) {
        allowed = rounding;
        rounding_limited_ = true;
      }
      worst = std::max<Real>(worst, abs(best[i] - lower[i]) / allowed);
    }
    return static_cast<double>(worst);
  }

  bool rounding_limited() const { return rounding_limited_; }

  /// Adds the extrapolated increment to the state.
  void accept() {
    for (std::size_t i = 0; i < n_; ++i) add_compensated(y_[i], residue_[i], column(1)[i]);
  }

  /// Largest |f_i| / scale_i at the start of the step [1 / time].
  Real rate() const {
    using std::abs;
    Real largest = 0;
    for (std::size_t i = 0; i < n_; ++i) largest = std::max<Real>(largest, abs(slope0_[i]) / scale_[i]);
    return largest;
  }

 private:
  Real* column(int c) { return store_.data() + static_cast<std::size_t>(c - 1) * n_; }

  /// Explicit midpoint rule with Euler start; leaves the increment after m and m - 1 substeps in even_ and
  /// odd_.
  void midpoint(int m, Real H) {
    const Real h = H / Real(m);
    for (std::size_t i = 0; i < n_; ++i) {
      even_[i] = 0;
      odd_[i] = h * slope0_[i];
    }
    for (int k = 1; k < m; ++k) {
      Real* now = k % 2 == 1 ? odd_ : even_;
      Real* next = k % 2 == 1 ? even_ : odd_;
      for (std::size_t i = 0; i < n_; ++i) argument_[i] = y_[i] + (residue_[i] + now[i]);
      f_(t_ + Real(k) * h, static_cast<const Real*>(argument_), slope_);
      for (std::size_t i = 0; i < n_; ++i) next[i] += Real(2) * h * slope_[i];
    }
  }

  F& f_;
  std::vector<Real>& y_;
  const std::vector<Real>& scale_;
  Real tol_;
  std::size_t n_;
  std::vector<Real> store_;
  Real *residue_ = nullptr, *slope0_ = nullptr, *slope_ = nullptr, *even_ = nullptr, *odd_ = nullptr,
       *argument_ = nullptr;
  Real t_{};
  bool rounding_limited_ = false;
};

/// Order and step size of the next step from the errors of the rows of this one (Hairer, Norsett & Wanner,
/// II.9). Step sizes are multiples of the present one.
class ExtrapolationControl {
 public:
  explicit ExtrapolationControl(double tol)
      : target_(static_cast<int>(std::clamp(1.5 - 0.6 * std::log10(tol), 2.0, extrapolation_rows - 1.0))) {}

  int target() const { return target_; }

  /// Records the error of row `row` >= 2.
  void record(int row, double error) {
    const double exponent = 1.0 / (2 * row - 1);
    const double least = std::pow(0.02, exponent);
    const double shrink = std::clamp(std::pow(error / 0.65, exponent) / 0.94, least, 4 / least);
    factor_[row] = 1 / shrink;
    work_[row] = row_cost(row) * shrink;
  }

  /// True if the error after the rows up to `row` cannot be expected to become acceptable at row target + 1.
  bool hopeless(int row, double error) const {
    const auto square = [](double x) { return x * x; };
    const double next = substeps(target_ + 1) / 2.0;
    if (row == target_ - 1) return error > square(next * substeps(target_) / 2.0);
    if (row == target_) return error > square(next);
    return row > target_;
  }

  /// After an accepted step that used `row` rows; the factor of the step size.
  double accepted(int row) {
    int best = row;
    if (row == 2) {
      best = after_rejection_ ? 2 : 3;
    } else if (row <= target_) {
      if (work_[row - 1] < 0.8 * work_[row])
        best = row - 1;
      else if (work_[row] < 0.9 * work_[row - 1])
        best = row + 1;
    } else {
      best = row - 1;
      if (row > 3 && work_[row - 2] < 0.8 * work_[row - 1]) best = row - 2;
      if (work_[row] < 0.9 * work_[best]) best = row;
    }
    best = std::min(best, extrapolation_rows - 1);
    double factor = 1;
    if (after_rejection_) {
      best = std::min(best, row);
      factor = std::min(1.0, factor_[best]);
    } else {
      factor = best <= row ? factor_[best] : factor_[row] * row_cost(best) / row_cost(row);
    }
    after_rejection_ = false;
    target_ = best;
    return factor;
  }

  /// After a step rejected at `row` >= 2; the factor of the step size, always below 1.
  double rejected(int row) {
    after_rejection_ = true;
    target_ = std::min({target_, row, extrapolation_rows - 1});
    if (target_ > 2 && work_[target_ - 1] < 0.8 * work_[target_]) --target_;
    return std::min(0.9, factor_[target_]);
  }

  /// After a step that broke down; the caller cuts the step size.
  void broken() { after_rejection_ = true; }

 private:
  int target_;
  bool after_rejection_ = false;
  double factor_[extrapolation_rows + 1] = {};
  double work_[extrapolation_rows + 1] = {};
};

}  // namespace detail

/// Integrates y' = f(t, y) from t0 to t1 (either direction) with local error control: the estimated error of
/// a step is at most tol * scale_i in every component, or half an epsilon of |y_i| where that is more. The
/// state that is kept is one order better than the one whose error is estimated. scale: positive size of each
/// component, in its own unit. max_evaluations: limit on calls of f. first_step: size of the first trial
/// step, 0 for an automatic choice. Nothing is allocated after the start. A state or right-hand side that is
/// not finite shortens the step, at most 40 times in a row, and is then reported.
template <class Real, class F>
requires Rhs<F, Real> Outcome<Real> integrate_extrapolation(F& f, std::vector<Real>& y, Real t0, Real t1,
                                                            const std::vector<Real>& scale, Real tol,
                                                            long max_evaluations, Real first_step = Real(0)) {
  using std::abs;
  using std::isfinite;
  Outcome<Real> out;
  std::string problem = detail::check_arguments(y, t0, t1, scale);
  if (problem.empty() && (!isfinite(tol) || !(tol > 0))) problem = "the tolerance is not positive and finite";
  if (problem.empty() && !isfinite(first_step)) problem = "the first step is not finite";
  if (!problem.empty()) {
    detail::finish(out, Status::invalid_argument, t0, problem);
    return out;
  }
  const Real eps = std::numeric_limits<Real>::epsilon();
  const Real direction = t1 < t0 ? Real(-1) : Real(1);
  const auto stop = [&](Status status, Real t, const char* what) {
    detail::finish(out, status, t, detail::at_time(what, t));
    return out;
  };

  detail::ExtrapolationTable<Real, F> table(f, y, scale, tol);
  detail::ExtrapolationControl control(static_cast<double>(tol));
  Real t = t0;
  Real size = abs(first_step);  // |H|, as proposed
  bool first = true;
  bool fresh = true;  // f has not been evaluated at t
  int breakdowns = 0;
  while (t != t1) {
    if (fresh) {
      if (out.evaluations >= max_evaluations) return stop(Status::evaluation_limit, t, "evaluation limit");
      ++out.evaluations;
      if (!table.begin(t)) return stop(Status::not_finite, t, "the right-hand side is not finite");
      fresh = false;
    }
    const Real remaining = abs(t1 - t);
    if (size == 0) {
      const Real rate = table.rate();
      size = rate * remaining > Real(1) ? Real(0.1) / rate : Real(0.1) * remaining;
    }
    const bool last = size >= remaining;
    Real H = last ? remaining : std::min<Real>(size, remaining / 2);
    const Real t_next = last ? t1 : t + direction * H;
    H = t_next - t;
    if (!last && abs(H) <= 4 * eps * std::max<Real>(abs(t), abs(t_next)))
      return stop(Status::step_too_small, t,
                  "the step size has reached the spacing of floating-point numbers");

    int row = 1;
    bool accepted = false;
    bool broken = false;
    double previous = std::numeric_limits<double>::infinity();
    for (;; ++row) {
      if (out.evaluations + detail::substeps(row) - 1 > max_evaluations)
        return stop(Status::evaluation_limit, t, "evaluation limit");
      out.evaluations += detail::substeps(row) - 1;
      broken = !table.add_row(row, H);
      if (broken) break;
      if (row > 1) {
        const double error = table.error();
        broken = !std::isfinite(error) || error >= previous;  // the table does not converge
        if (broken) break;
        previous = std::max(4 * error, 1.0);
        control.record(row, error);
        accepted = error <= 1 && (first || last || row >= control.target() - 1);
        if (accepted || control.hopeless(row, error)) break;
      }
    }
    if (broken) {
      if (++breakdowns > 40)
        return stop(Status::not_finite, t, "no step that stays finite and converges was found");
      ++out.rejected;
      control.broken();
      size = abs(H) / 4;
      continue;
    }
    breakdowns = 0;
    if (!accepted) {
      ++out.rejected;
      size = abs(H) * Real(control.rejected(row));
      continue;
    }
    table.accept();
    if (!detail::all_finite(y.data(), y.size()))
      return stop(Status::not_finite, t_next, "the state is not finite");
    ++out.steps;
    if (table.rounding_limited()) ++out.rounding_limited;
    t = t_next;
    fresh = true;
    first = false;
    const Real proposed = abs(H) * Real(control.accepted(row));
    size = last ? std::max<Real>(size, proposed) : proposed;
  }
  out.next_step = size;
  detail::finish(out, Status::success, t1);
  return out;
}

}  // namespace gnomon::generic
