#pragma once
// Gauss-Legendre collocation with constant step, its stage equations solved by fixed-point iteration.
//
// E. Hairer, S. P. Norsett & G. Wanner, Solving Ordinary Differential Equations I, 2nd ed., section II.7;
// iteration to rounding and compensated summation as in E. Hairer, R. I. McLachlan & A. Razakarivony, BIT
// Numer. Math. 48 (2008) 231.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "integrators/generic/gauss_tableau.hpp"
#include "integrators/generic/ode.hpp"

namespace gnomon::generic {

/// Greatest number of sweeps of the fixed-point iteration of a step.
inline constexpr int gauss_sweeps = 100;

namespace detail {

/// One step of the method and the work space for it.
template <class Real, class F>
class GaussStepper {
 public:
  enum class Result { done, not_finite, no_convergence, evaluation_limit };

  GaussStepper(F& f, std::vector<Real>& y, const std::vector<Real>& scale, const GaussTableau<Real>& tableau,
               long max_evaluations)
      : f_(f),
        y_(y),
        scale_(scale),
        g_(tableau),
        max_evaluations_(max_evaluations),
        n_(y.size()),
        s_(static_cast<std::size_t>(tableau.stages)),
        store_((3 * s_ + 2) * n_, Real(0)) {
    slopes_ = store_.data();
    guess_ = slopes_ + s_ * n_;
    offsets_ = guess_ + s_ * n_;
    residue_ = offsets_ + s_ * n_;
    argument_ = residue_ + n_;
  }

  /// Steps from t to t + h.
  Result step(Real t, Real h) {
    Result result = Result::no_convergence;
    if (warm_) {
      extrapolate();
      result = iterate(t, h);
    }
    // Without a previous step, or where its polynomial misleads, start from the slope at the beginning of the
    // step.
    if (result == Result::not_finite || result == Result::no_convergence) {
      if (evaluations_ >= max_evaluations_) return Result::evaluation_limit;
      ++evaluations_;
      f_(t, static_cast<const Real*>(y_.data()), slopes_);
      if (!all_finite(slopes_, n_)) return Result::not_finite;
      for (std::size_t i = 1; i < s_; ++i) std::copy(slopes_, slopes_ + n_, slopes_ + i * n_);
      result = iterate(t, h);
      if (result == Result::not_finite) result = Result::no_convergence;
    }
    if (result != Result::done) return result;
    // Differences to one of the slopes: the weights' rounding, by which they miss the sum 1, then acts on
    // differences of the size of h only and not, in every step alike, on the slopes.
    const Real* middle = slopes_ + (s_ / 2) * n_;
    for (std::size_t c = 0; c < n_; ++c) {
      Real sum = 0;
      for (std::size_t i = 0; i < s_; ++i) sum += g_.b[i] * (slopes_[i * n_ + c] - middle[c]);
      add_compensated(y_[c], residue_[c], h * (middle[c] + sum));
    }
    warm_ = true;
    return all_finite(y_.data(), n_) ? Result::done : Result::not_finite;
  }

  long evaluations() const { return evaluations_; }

 private:
  /// Slopes at this step's nodes by the previous step's collocation polynomial.
  void extrapolate() {
    for (std::size_t i = 0; i < s_; ++i)
      for (std::size_t c = 0; c < n_; ++c) {
        Real sum = 0;
        for (std::size_t j = 0; j < s_; ++j) sum += g_.extrapolate[i * s_ + j] * slopes_[j * n_ + c];
        guess_[i * n_ + c] = sum;
      }
    std::swap(slopes_, guess_);
  }

  /// Sweeps over the stages, each using the newest slopes, until the offsets y_i - y change by rounding only.
  Result iterate(Real t, Real h) {
    using std::abs;
    using std::isfinite;
    const Real eps = std::numeric_limits<Real>::epsilon();
    std::fill(offsets_, offsets_ + s_ * n_, Real(0));
    Real previous = std::numeric_limits<Real>::max();
    for (int sweep = 0; sweep < gauss_sweeps; ++sweep) {
      if (evaluations_ + static_cast<long>(s_) > max_evaluations_) return Result::evaluation_limit;
      Real change = 0;
      bool finite = true;
      for (std::size_t i = 0; i < s_; ++i) {
        for (std::size_t c = 0; c < n_; ++c) {
          Real sum = 0;
          for (std::size_t j = 0; j < s_; ++j) sum += g_.a[i * s_ + j] * slopes_[j * n_ + c];
          const Real offset = h * sum;
          const Real moved = abs(offset - offsets_[i * n_ + c]) / std::max<Real>(scale_[c], abs(y_[c]));
          if (!isfinite(moved)) finite = false;
          if (moved > change) change = moved;
          offsets_[i * n_ + c] = offset;
          argument_[c] = y_[c] + (residue_[c] + offset);
        }
        f_(t + g_.c[i] * h, static_cast<const Real*>(argument_), slopes_ + i * n_);
      }
      evaluations_ += static_cast<long>(s_);
      if (!finite || !all_finite(slopes_, s_ * n_)) return Result::not_finite;
      // The first sweep's change is no measure: it is taken from zero offsets, not from the guess.
      if (sweep > 0 && change <= eps / 64) return Result::done;
      if (sweep > 1) {
        // What is left after this sweep is about change * rate / (1 - rate); or rounding has stopped the
        // progress.
        const Real rate = change / previous;
        if (rate < Real(0.9) && change * rate / (Real(1) - rate) <= eps / 64) return Result::done;
        if (rate >= Real(1) && change <= 64 * eps) return Result::done;
      }
      previous = change;
    }
    return Result::no_convergence;
  }

  F& f_;
  std::vector<Real>& y_;
  const std::vector<Real>& scale_;
  const GaussTableau<Real>& g_;
  long max_evaluations_;
  long evaluations_ = 0;
  std::size_t n_, s_;
  std::vector<Real> store_;
  Real *slopes_ = nullptr, *guess_ = nullptr, *offsets_ = nullptr, *residue_ = nullptr, *argument_ = nullptr;
  bool warm_ = false;
};

}  // namespace detail

/// Integrates y' = f(t, y) from t0 to t1 (either direction) by `steps` equal steps of the method `tableau`
/// (order 2 stages; see gauss_tableau). scale: positive size of each component, in its own unit; the stage
/// equations are solved to the rounding of max(scale_i, |y_i|). max_evaluations: limit on calls of f. Nothing
/// is allocated after the start. A step whose iteration does not converge ends the integration with
/// Status::no_convergence: use more steps.
template <class Real, class F>
requires Rhs<F, Real> Outcome<Real> integrate_gauss(F& f, std::vector<Real>& y, Real t0, Real t1, long steps,
                                                    const std::vector<Real>& scale, long max_evaluations,
                                                    const GaussTableau<Real>& tableau) {
  Outcome<Real> out;
  std::string problem = detail::check_arguments(y, t0, t1, scale);
  if (problem.empty() && steps < 1) problem = "the number of steps is not positive";
  if (problem.empty() && tableau.stages < 1) problem = "the number of stages is not in 1..32";
  if (!problem.empty()) {
    detail::finish(out, Status::invalid_argument, t0, problem);
    return out;
  }
  using Stepper = detail::GaussStepper<Real, F>;
  Stepper stepper(f, y, scale, tableau, max_evaluations);
  const Real length = t1 - t0;
  Real t = t0;
  for (long n = 1; n <= steps && t0 != t1; ++n) {
    // Differences of rounded times: the steps add up to t1 - t0 exactly.
    const Real t_next = n == steps ? t1 : t0 + length * (Real(n) / Real(steps));
    const auto result = stepper.step(t, t_next - t);
    out.evaluations = stepper.evaluations();
    const auto stop = [&](Status status, const char* what) {
      detail::finish(out, status, t, detail::at_time(what, t));
      return out;
    };
    if (result == Stepper::Result::evaluation_limit)
      return stop(Status::evaluation_limit, "evaluation limit");
    if (result == Stepper::Result::not_finite)
      return stop(Status::not_finite, "the right-hand side or the state is not finite");
    if (result == Stepper::Result::no_convergence)
      return stop(Status::no_convergence, "the stage equations did not converge");
    t = t_next;
    ++out.steps;
  }
  detail::finish(out, Status::success, t1);
  return out;
}

/// The same with the eight-stage method of order 16.
template <class Real, class F>
requires Rhs<F, Real> Outcome<Real> integrate_gauss(F& f, std::vector<Real>& y, Real t0, Real t1, long steps,
                                                    const std::vector<Real>& scale, long max_evaluations) {
  return integrate_gauss(f, y, t0, t1, steps, scale, max_evaluations, gauss_tableau<Real>(8));
}

}  // namespace gnomon::generic
