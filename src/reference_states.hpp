#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "src/certify.hpp"
#include "src/model.hpp"
#include "src/ode.hpp"

namespace gnomon {

/// Reference states at some times, each with a bound of its error in every metric of the model.
struct ReferenceStates {
  std::string kind;  ///< "analytic", "certified", or empty: there is none, and message says why
  std::vector<std::string> methods;
  std::vector<double> times;
  std::vector<std::vector<double>> states;  ///< flattened, one a time
  std::vector<std::vector<double>> bounds;  ///< one a time and metric
  std::string message;
};

/// A model whose rates can be evaluated in extended precision.
template <class M>
concept HasExtendedOde = HasOde<M> &&
    requires(const M& model, long double t, const long double* y, long double* rate) {
  model.extended_rhs(t, y, rate);
};

/// A model of independent parts, each a model of its own, of which a number is enough to tell errors by.
template <class M>
concept HasReferenceParts = requires(const M& model, std::size_t i, const std::vector<double>& bounds) {
  { model.reference_parts() } -> std::convertible_to<std::size_t>;
  model.reference_part(i);
  // The state of these parts, and the bound of its errors from the largest of theirs.
  model.join({model.reference_part(i).initial()});
  { model.join_bounds(bounds) } -> std::same_as<std::array<double, M::metrics.size()>>;
};

namespace detail {

/// At a break the data belong to what comes after; a segment that ends there sees the limit from its own
/// side.
template <class Real>
Real one_sided(Real t, double segment_end) {
  return t < Real(segment_end) ? t
                               : Real(std::nextafter(segment_end, -std::numeric_limits<double>::infinity()));
}

/// `accuracy` is what is asked of the scaled states in extended precision; 0: all that it can give.
template <HasOde M, class Real>
ReferenceStates certified_states(const M& model, const std::vector<double>& times, long max_evaluations,
                                 Real accuracy = 0) {
  const auto form = model.ode();
  const std::size_t n = static_cast<std::size_t>(form.size());
  std::vector<double> start(n);
  form.pack(0.0, model.initial(), start.data());
  const std::vector<double> scales = form.scales(), breaks = model.breaks();

  CertifyProblem<Real> problem;
  problem.y0.assign(start.begin(), start.end());
  problem.scale.assign(scales.begin(), scales.end());
  problem.outputs.assign(times.begin(), times.end());
  problem.breaks.assign(breaks.begin(), breaks.end());
  const auto rhs = [&](int segment, Real t, const Real* y, Real* rate) {
    const std::size_t next = static_cast<std::size_t>(segment);
    const Real at = next < breaks.size() ? one_sided(t, breaks[next]) : t;
    if constexpr (std::is_same_v<Real, double>)
      form.rhs(at, y, rate);
    else
      model.extended_rhs(at, y, rate);
  };
  CertifyOptions<Real> options;
  options.max_evaluations = max_evaluations;
  // In double, rounding keeps long or stiff motions from settling any further; a looser bound is had at once.
  if constexpr (std::is_same_v<Real, double>) {
    options.tight = 1e-13;
    options.loose = 1e-11;
    options.target = 1e-10;
    options.steps_ratio = 16;
    options.max_evaluations = std::min(max_evaluations, 4'000'000L);
  }
  if (accuracy > 0) {
    options.tight = accuracy / 100;
    options.loose = 10 * accuracy;
    options.target = accuracy;
  }
  const Certified<Real> solution = certify(rhs, problem, options);

  const auto state_of = [&](double t, const std::vector<Real>& y) {
    const std::vector<double> rounded(y.begin(), y.end());
    return form.unpack(t, rounded.data());
  };
  ReferenceStates reference;
  reference.methods = solution.methods;
  reference.times = times;
  reference.message = solution.message;
  if (!solution.converged) return reference;
  reference.kind = "certified";
  for (std::size_t k = 0; k < times.size(); ++k)
    reference.states.push_back(model.flatten(state_of(times[k], solution.tight[k])));
  reference.bounds.assign(times.size(), std::vector<double>(M::metrics.size()));
  for (std::size_t metric = 0; metric < M::metrics.size(); ++metric) {
    const auto distance = [&](Real t, const std::vector<Real>& a, const std::vector<Real>& b) {
      const double at = static_cast<double>(t);
      return static_cast<Real>(model.distance(state_of(at, a), state_of(at, b))[metric]);
    };
    // The states are rounded to double: a few units in the last place.
    const std::vector<Real> bounds =
        error_bounds(solution, distance, Real(8 * std::numeric_limits<double>::epsilon()));
    for (std::size_t k = 0; k < times.size(); ++k)
      reference.bounds[k][metric] = static_cast<double>(bounds[k]);
  }
  return reference;
}

/// The closed form, where there is one; else `reference` stays as it is.
template <class M>
void exact_states(const M& model, const std::vector<double>& times, ReferenceStates& reference) {
  ReferenceStates closed;
  closed.kind = "analytic";
  closed.methods = {"closed form in extended precision"};
  closed.times = times;
  for (double t : times) {
    std::optional<Exact<M>> exact;
    if constexpr (HasExact<M>)
      exact = model.exact(t);
    else
      exact = model.exact_if_known(t);
    if (!exact) return;
    closed.states.push_back(model.flatten(exact->state));
    closed.bounds.emplace_back(exact->bound.begin(), exact->bound.end());
  }
  reference = std::move(closed);
}

/// Whether `closed` has bounds less than a hundredth as large as some of `reference`, if there is one, and no
/// error beyond them.
template <class M>
bool is_far_better(const M& model, const ReferenceStates& closed, const ReferenceStates& reference) {
  if (reference.kind.empty()) return true;
  bool better = false;
  for (std::size_t k = 0; k < closed.times.size(); ++k) {
    const auto apart = model.distance(model.restore(closed.states[k]), model.restore(reference.states[k]));
    for (std::size_t metric = 0; metric < apart.size(); ++metric) {
      const double own = closed.bounds[k][metric], other = reference.bounds[k][metric];
      if (!(apart[metric] <= own + other)) return false;
      better = better || other > 100.0 * own;
    }
  }
  return better;
}

/// Part by part.
template <HasReferenceParts M>
ReferenceStates joined_states(const M& model, const std::vector<double>& times, long max_evaluations) {
  using Part = decltype(model.reference_part(0));
  ReferenceStates reference;
  std::vector<std::vector<typename Part::State>> states(times.size());
  std::vector<std::vector<double>> bounds(times.size(), std::vector<double>(Part::metrics.size(), 0.0));
  const std::size_t count = model.reference_parts();
  for (std::size_t i = 0; i < count; ++i) {
    const Part part = model.reference_part(i);
    ReferenceStates own = certified_states<Part, long double>(part, times, max_evaluations, 1e-15L);
    if (own.kind.empty()) {
      reference.message = "part " + std::to_string(i + 1) + ": " + own.message;
      return reference;
    }
    for (std::size_t k = 0; k < times.size(); ++k) {
      states[k].push_back(part.restore(own.states[k]));
      for (std::size_t metric = 0; metric < bounds[k].size(); ++metric)
        bounds[k][metric] = std::max(bounds[k][metric], own.bounds[k][metric]);
    }
    if (i > 0) continue;
    reference.methods = std::move(own.methods);
    for (std::string& method : reference.methods)
      method += ", the first " + std::to_string(count) + " parts each by itself";
  }
  reference.kind = "certified";
  reference.times = times;
  for (std::size_t k = 0; k < times.size(); ++k) {
    reference.states.push_back(model.flatten(model.join(states[k])));
    const auto joined = model.join_bounds(bounds[k]);
    reference.bounds.emplace_back(joined.begin(), joined.end());
  }
  return reference;
}

}  // namespace detail

/// The closed form where the model has one, else that of its parts, else the certified solution of its ODE
/// form, in extended precision where the model's rates allow it. A model that has a closed form for some data
/// is solved, too, by methods that check one another; its closed form stands in where these do not agree or
/// their bound is a hundred times as large, as near a separatrix, where rounding grows to any size. `times`
/// ascend.
template <Model M>
ReferenceStates reference_states(const M& model, const std::vector<double>& times,
                                 long max_evaluations = 50'000'000) {
  if constexpr (HasExact<M>) {
    ReferenceStates reference;
    detail::exact_states(model, times, reference);
    return reference;
  } else if constexpr (HasReferenceParts<M>) {
    return detail::joined_states(model, times, max_evaluations);
  } else if constexpr (HasExtendedOde<M>) {
    ReferenceStates reference = detail::certified_states<M, long double>(model, times, max_evaluations);
    if constexpr (HasExactForSome<M>) {
      ReferenceStates closed;
      detail::exact_states(model, times, closed);
      if (!closed.kind.empty() && detail::is_far_better(model, closed, reference)) return closed;
    }
    return reference;
  } else if constexpr (HasOde<M>) {
    return detail::certified_states<M, double>(model, times, max_evaluations);
  } else {
    ReferenceStates none;
    none.message = "the model has neither a closed form nor an ODE form";
    return none;
  }
}

}  // namespace gnomon
