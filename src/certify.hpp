#pragma once
// Certified solutions of smooth initial value problems: two methods with nothing in common but the right-hand
// side.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "integrators/generic/extrapolation.hpp"
#include "integrators/generic/gauss.hpp"
#include "src/certify_bound.hpp"

namespace gnomon {

/// An initial value problem y' = f(segment, t, y), y(t0) = y0. `segment` is the number of breaks at or before
/// the beginning of the piece that is being integrated: at a break f is asked for the limit from the
/// segment's own side.
template <class Real>
struct CertifyProblem {
  Real t0{};
  std::vector<Real> y0;
  std::vector<Real> outputs;  ///< ascending, none before t0
  std::vector<Real> breaks;   ///< ascending; times at which f jumps or is not smooth
  std::vector<Real> scale;    ///< positive size of each component, in its own unit
};

template <class Real>
struct CertifyOptions {
  Real tight = std::numeric_limits<Real>::epsilon();         ///< tolerance of A, relative to the scales
  Real loose = 1000 * std::numeric_limits<Real>::epsilon();  ///< the tolerance it is compared with
  int stages = 8;                                            ///< of B; its order is twice as much; at least 2
  long first_steps = 0;  ///< steps over the whole time of the first run of B; 0: from the steps of A
  long steps_ratio = 2;  ///< then: steps of A to those of the first run of B
  Real target = 0;       ///< doubling ends at this scaled distance between B fine and B coarse; what is below
                         ///< it counts as agreement
  long max_evaluations = 100'000'000;  ///< for each of A tight, A loose and all runs of B together
};

/// States at the output times, states[k] at outputs[k]; ends before an output time that was not reached.
template <class Real>
using Trajectory = std::vector<std::vector<Real>>;

template <class Real>
struct Certified {
  std::vector<Real> times;
  Trajectory<Real> tight;            ///< A, extrapolation at the tight tolerance: the reference solution
  Trajectory<Real> loose;            ///< A at the loose tolerance
  Trajectory<Real> fine;             ///< B, Gauss collocation with 2N steps
  Trajectory<Real> coarse;           ///< B with N steps
  std::vector<std::string> methods;  ///< what produced the four, in this order, with parameters
  long steps = 0;                    ///< steps of B fine
  long evaluations = 0;              ///< of all runs
  double seconds = 0;                ///< wall-clock time of all runs
  /// Largest distances over all output times, in units of the scales (maximum norm).
  Distances<Real> distances{};
  Real loose_distance{};      ///< the same between A loose and B fine: must exceed distances.methods
  Real step_contraction = 1;  ///< distances.steps by its value one doubling before; 1 if not known
  bool converged = false;     ///< every run ended well, both methods converge, and to the same solution
  std::string message;        ///< why not; empty if converged
};

namespace detail {

/// A piece of the time axis without a break or an output time inside.
template <class Real>
struct Leg {
  Real begin, end;
  int segment;
  bool output;  ///< an output time is at its end
};

template <class Real>
std::string check_problem(const CertifyProblem<Real>& p, const CertifyOptions<Real>& o) {
  using std::isfinite;
  if (p.y0.size() != p.scale.size()) return "scale and state differ in size";
  if (p.outputs.empty()) return "there is no output time";
  Real last = p.t0;
  for (const Real& t : p.outputs) {
    if (!isfinite(t) || t < last || (t == last && &t != p.outputs.data()))
      return "output times must ascend from t0";
    last = t;
  }
  for (std::size_t i = 0; i < p.breaks.size(); ++i)
    if (!isfinite(p.breaks[i]) || (i > 0 && !(p.breaks[i - 1] < p.breaks[i]))) return "breaks must ascend";
  if (o.stages < 2 || o.stages > 32) return "the number of stages is not in 2..32";
  if (!(o.tight > 0) || !(o.loose > o.tight)) return "tolerances must be positive, the loose one larger";
  if (o.first_steps < 0) return "the number of steps is negative";
  return {};
}

template <class Real>
std::vector<Leg<Real>> legs_of(const CertifyProblem<Real>& p) {
  std::vector<Leg<Real>> legs;
  Real t = p.t0;
  std::size_t segment = 0;
  const auto pass_breaks = [&] {
    while (segment < p.breaks.size() && p.breaks[segment] <= t) ++segment;
  };
  for (const Real& output : p.outputs) {
    for (pass_breaks(); segment < p.breaks.size() && p.breaks[segment] < output; pass_breaks()) {
      legs.push_back({t, p.breaks[segment], static_cast<int>(segment), false});
      t = p.breaks[segment];
    }
    legs.push_back({t, output, static_cast<int>(segment), true});
    t = output;
  }
  return legs;
}

/// Goes through all legs; `advance(leg, y)` integrates one and returns its Outcome, which becomes part of the
/// total.
template <class Real, class Advance>
generic::Outcome<Real> run_legs(const CertifyProblem<Real>& p, const std::vector<Leg<Real>>& legs,
                                Advance&& advance, Trajectory<Real>& states) {
  generic::Outcome<Real> total;
  total.ok = true;
  std::vector<Real> y = p.y0;
  states.clear();
  for (const Leg<Real>& leg : legs) {
    const generic::Outcome<Real> one = advance(leg, y, total);
    total.steps += one.steps;
    total.evaluations += one.evaluations;
    total.next_step = one.next_step;
    total.status = one.status;
    total.t = one.t;
    if (!one.ok) {
      total.ok = false;
      total.message = one.message;
      break;
    }
    if (leg.output) states.push_back(y);
  }
  return total;
}

/// Largest distance over all output times in the maximum norm scaled by `scale`; infinite if a state is
/// missing.
template <class Real>
Real scaled_distance(const Trajectory<Real>& a, const Trajectory<Real>& b, const CertifyProblem<Real>& p) {
  using std::abs;
  const Real infinity = std::numeric_limits<Real>::infinity();
  if (a.size() != p.outputs.size() || b.size() != p.outputs.size()) return infinity;
  Real largest = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    for (std::size_t i = 0; i < p.scale.size(); ++i) {
      const Real d = abs(a[k][i] - b[k][i]) / p.scale[i];
      if (!(d <= largest)) largest = d;
    }
  return largest;
}

template <class Real>
std::string number(Real x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3Lg", static_cast<long double>(x));
  return text;
}

template <class Real>
std::string extrapolation_name(Real tolerance) {
  return "Gragg-Bulirsch-Stoer extrapolation, at most " + std::to_string(generic::extrapolation_rows) +
         " rows, tolerance " + number(tolerance);
}

inline std::string gauss_name(int stages, long steps) {
  return "Gauss collocation, order " + std::to_string(2 * stages) + ", " + std::to_string(steps) + " steps";
}

}  // namespace detail

/// Solves the problem with method A (extrapolation, at two tolerances, right-hand side f_a) and method B
/// (Gauss collocation with N and 2N steps, right-hand side f_b), N by doubling until the distance of the two
/// is at the target, or stops to shrink, or the next run would exceed the budget of evaluations. Every f is
/// called as f(int segment, Real t, const Real* y, Real* dydt). Two right-hand sides allow two independently
/// coded versions of the same equations; else use certify(f, ...). Failures are reported in the result,
/// whatever there is of states is kept.
template <class Real, class FA, class FB>
Certified<Real> certify(FA& f_a, FB& f_b, const CertifyProblem<Real>& problem,
                        const CertifyOptions<Real>& options) {
  using detail::number;
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const Real infinity = std::numeric_limits<Real>::infinity();
  const Real eps = std::numeric_limits<Real>::epsilon();
  Certified<Real> result;
  result.times = problem.outputs;
  result.distances = {infinity, infinity, infinity};
  result.loose_distance = infinity;
  result.message = detail::check_problem(problem, options);
  if (!result.message.empty()) return result;
  const auto complain = [&](const std::string& text) {
    result.message += (result.message.empty() ? "" : "; ") + text;
  };
  const std::vector<detail::Leg<Real>> legs = detail::legs_of(problem);

  // Method A.
  const auto extrapolate = [&](Real tolerance, Trajectory<Real>& states) {
    const auto advance = [&](const detail::Leg<Real>& leg, std::vector<Real>& y,
                             const generic::Outcome<Real>& total) {
      auto rhs = [&](Real t, const Real* x, Real* dxdt) { f_a(leg.segment, t, x, dxdt); };
      return generic::integrate_extrapolation(rhs, y, leg.begin, leg.end, problem.scale, tolerance,
                                              options.max_evaluations - total.evaluations, total.next_step);
    };
    const auto outcome = detail::run_legs(problem, legs, advance, states);
    result.evaluations += outcome.evaluations;
    if (!outcome.ok) complain("extrapolation, tolerance " + number(tolerance) + ": " + outcome.message);
    return outcome;
  };
  const auto tight = extrapolate(options.tight, result.tight);
  if (!tight.ok) {  // nothing to certify
    result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return result;
  }
  extrapolate(options.loose, result.loose);
  result.distances.tolerances = detail::scaled_distance(result.tight, result.loose, problem);

  // Method B.
  const generic::GaussTableau<Real> tableau = generic::gauss_tableau<Real>(options.stages);
  const Real length = problem.outputs.back() - problem.t0;
  const long first = options.first_steps > 0 ? options.first_steps
                                             : std::max(tight.steps / std::max(options.steps_ratio, 1L), 1L);
  long spent = 0;
  const auto collocate = [&](long factor, Trajectory<Real>& states) {
    const auto advance = [&](const detail::Leg<Real>& leg, std::vector<Real>& y,
                             const generic::Outcome<Real>& total) {
      auto rhs = [&](Real t, const Real* x, Real* dxdt) { f_b(leg.segment, t, x, dxdt); };
      const Real share = length > 0 ? (leg.end - leg.begin) / length : Real(0);
      const long steps = std::max(static_cast<long>(Real(first) * share + Real(0.5)), 1L) * factor;
      return generic::integrate_gauss(rhs, y, leg.begin, leg.end, steps, problem.scale,
                                      options.max_evaluations - spent - total.evaluations, tableau);
    };
    const auto outcome = detail::run_legs(problem, legs, advance, states);
    spent += outcome.evaluations;
    return outcome;
  };
  bool settled = false;  // the target is met, or the distance has stopped shrinking where it may
  int slow = 0;
  long coarse_steps = 0;
  for (long factor = 1;; factor *= 2) {
    Trajectory<Real> states;
    const long before = spent;
    const auto outcome = collocate(factor, states);
    const long cost = spent - before;
    if (!outcome.ok && outcome.status != generic::Status::no_convergence) {
      complain("Gauss collocation: " + outcome.message);
      break;
    }
    if (outcome.ok) {
      result.coarse = std::exchange(result.fine, std::move(states));
      coarse_steps = std::exchange(result.steps, outcome.steps);
      const Real previous = result.distances.steps;
      const Real distance = detail::scaled_distance(result.fine, result.coarse, problem);
      result.distances.steps = distance;
      result.step_contraction = distance < previous && previous < infinity ? distance / previous : Real(1);
      if (distance <= std::max<Real>(options.target, eps / 4)) settled = true;
      // Smooth problems gain a factor of 2^order >= 16 until rounding ends it. What rounding may do at the
      // end is judged by method A: errors that the problem amplifies are amplified there, too.
      const bool stalls = previous < infinity && distance > previous / 4 && distance < Real(0.01);
      slow = stalls ? slow + 1 : 0;
      const Real noise = std::max<Real>(result.distances.tolerances, 1000 * eps);
      if (stalls && distance <= noise && result.distances.tolerances < infinity) settled = true;
      if (settled) break;
      if (slow >= 2) {
        complain("Gauss collocation: doubling the steps has stopped to help at a distance of " +
                 number(distance));
        break;
      }
    }
    if (result.fine.empty() && factor >= 1024) {
      complain("Gauss collocation: " + outcome.message);
      break;
    }
    if (spent + 2 * cost > options.max_evaluations) {
      complain("Gauss collocation: the evaluations are used up at a distance of " +
               number(result.distances.steps));
      break;
    }
  }
  result.evaluations += spent;

  result.distances.methods = detail::scaled_distance(result.tight, result.fine, problem);
  result.loose_distance = detail::scaled_distance(result.loose, result.fine, problem);
  const Distances<Real>& d = result.distances;
  if (d.methods < infinity) {
    if (d.methods > 100 * (d.tolerances + d.steps) + 1000 * eps)
      complain("the two methods converge to different solutions, " + number(d.methods) + " apart");
    else if (d.methods > result.loose_distance && d.methods > std::max<Real>(64 * eps, options.target))
      complain("a tighter tolerance does not bring extrapolation nearer to collocation");
  }
  result.converged = settled && result.message.empty();
  result.methods = {detail::extrapolation_name(options.tight), detail::extrapolation_name(options.loose),
                    detail::gauss_name(options.stages, result.steps),
                    detail::gauss_name(options.stages, coarse_steps)};
  result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return result;
}

/// The same with one right-hand side for both methods.
template <class Real, class F>
Certified<Real> certify(F& f, const CertifyProblem<Real>& problem, const CertifyOptions<Real>& options = {}) {
  return certify(f, f, problem, options);
}

/// Distances in the caller's own metric at every output time; distance(state, state), or distance(t, state,
/// state) where it depends on the time, returns a Real. States that are missing or not finite give an
/// infinite distance and are not shown to the metric.
template <class Real, class Metric>
std::vector<Distances<Real>> measure_distances(const Certified<Real>& solution, Metric&& distance) {
  const auto at = [&](const Trajectory<Real>& a, const Trajectory<Real>& b, std::size_t k) -> Real {
    const bool usable = k < a.size() && k < b.size() &&
                        generic::detail::all_finite(a[k].data(), a[k].size()) &&
                        generic::detail::all_finite(b[k].data(), b[k].size());
    if (!usable) return std::numeric_limits<Real>::infinity();
    if constexpr (std::is_invocable_v<Metric&, Real, const std::vector<Real>&, const std::vector<Real>&>)
      return Real(distance(solution.times[k], a[k], b[k]));
    else
      return Real(distance(a[k], b[k]));
  };
  std::vector<Distances<Real>> all(solution.times.size());
  for (std::size_t k = 0; k < all.size(); ++k)
    all[k] = {at(solution.tight, solution.fine, k), at(solution.tight, solution.loose, k),
              at(solution.fine, solution.coarse, k)};
  return all;
}

/// Bounds on the error of solution.tight in the caller's metric, one for each output time; see error_bounds
/// above.
template <class Real, class Metric>
std::vector<Real> error_bounds(const Certified<Real>& solution, Metric&& distance, Real floor) {
  return error_bounds(measure_distances(solution, distance), solution.step_contraction, floor);
}

}  // namespace gnomon
