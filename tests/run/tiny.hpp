#pragma once
// The smallest model and schemes that the run driver takes: x' = 1 from x = 1.

#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include "src/run.hpp"

namespace gnomon::test {

struct Line {
  struct State {
    double x;
  };
  static constexpr std::string_view model_name = "line";
  static constexpr std::string_view variant = "";
  static constexpr std::array<MetricInfo, 1> metrics{MetricInfo{"x", "m", 1.0}};

  std::vector<double> break_times{};
  std::vector<InvariantInfo> infos{{"lag", 1, 0.0, 1.0}};

  State initial() const { return {1.0}; }
  std::vector<double> flatten(const State& state) const { return {state.x}; }
  State restore(const std::vector<double>& flat) const { return {flat[0]}; }
  std::vector<Named> observe(const State& state) const { return {{"x", {state.x}}}; }
  std::vector<InvariantInfo> invariant_info() const { return infos; }
  void invariants(double t, const State& state, double* out) const {
    for (std::size_t k = 0; k < infos.size(); ++k) *out++ = state.x - t;
  }
  std::array<double, 1> distance(const State& a, const State& b) const { return {std::abs(a.x - b.x)}; }
  std::vector<double> breaks() const { return break_times; }
  std::string_view load_class() const { return "none"; }
  double time_scale() const { return 1.0; }
};

/// What the schemes below carry along: how often they were called, and with what.
struct Journal {
  double x = 0.0;
  long steps = 0;
  double last_t = -1.0, last_h = 0.0;
  bool times_fit = true;  ///< step n was called with t = n h
};

template <class Act>
struct LineScheme {
  static constexpr SchemeInfo info{
      .name = "line", .family = "test", .summary = "", .citation = "", .form = "line"};
  template <class M>
  using State = Journal;
  static Journal start(const Line&, const Line::State& state) { return {.x = state.x}; }
  static Line::State view(const Line&, const Journal& state) { return {state.x}; }
  static Cost cost(const Line&, const Journal&, long steps) { return {.steps = steps, .rhs = 2 * steps}; }
  static Status step(const Line&, Journal& state, double t, double h) {
    state.times_fit = state.times_fit && t == static_cast<double>(state.steps) * h;
    state.last_t = t;
    state.last_h = h;
    ++state.steps;
    return Act::act(state, h);
  }
};

/// Adds the step.
struct Advance {
  static Status act(Journal& state, double h) {
    state.x += h;
    return Status::ok;
  }
};

/// Adds the step; from step `count` on the state is `bad`.
template <long count, int kind>
struct Spoil {
  static Status act(Journal& state, double h) {
    constexpr double bad[] = {std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::quiet_NaN()};
    state.x = state.steps >= count ? bad[kind] : state.x + h;
    return Status::ok;
  }
};

/// Doubles the state: over the largest double after 1024 steps.
struct Double {
  static Status act(Journal& state, double) {
    state.x *= 2.0;
    return Status::ok;
  }
};

/// Adds the step; step `count` fails and leaves a worthless state.
template <long count, Status status>
struct Fail {
  static Status act(Journal& state, double h) {
    state.x += h;
    if (state.steps < count) return Status::ok;
    state.x = -7.0;
    return status;
  }
};

}  // namespace gnomon::test
