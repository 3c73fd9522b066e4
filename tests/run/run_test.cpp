#include "src/run.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/run/tiny.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

using Advancing = LineScheme<Advance>;

RunSpec steps_of(double t_end, double step) {
  RunSpec spec;
  spec.t_end = t_end;
  spec.step = step;
  return spec;
}

template <class S = Advancing>
RunResult go(const RunSpec& spec, const Line& model = {}) {
  return run_fixed<Line, S>(model, spec);
}

// What n steps make of the start, one after the other.
double after(long n, double h) {
  double x = 1.0;
  for (long k = 0; k < n; ++k) x += h;
  return x;
}

bool has_flag(const RunResult& result, std::string_view word) {
  return std::any_of(result.flags.begin(), result.flags.end(),
                     [&](const std::string& flag) { return flag.find(word) != std::string::npos; });
}

}  // namespace

TEST_CASE("run: the number of steps and the end", "[run]") {
  struct Case {
    double t_end, step;
    long count;
  };
  // N = ceil(T/H - 1e-9): a step that fits up to rounding is taken, a longer one is shortened.
  for (const Case& c :
       {Case{1.0, 0.1, 10}, Case{1.0, 0.3, 4}, Case{10.0, 0.01, 1000}, Case{1.0, 1.0 / 3.0, 3},
        Case{1.0, 2.0, 1}, Case{1.0, 0.1 * (1.0 - 5e-11), 10}, Case{1.0, 0.1 * (1.0 - 1e-6), 11},
        Case{1e4, 0.07, 142858}, Case{0.7, 0.1, 7}, Case{1.0, 1.0 / 49.0, 49}}) {
    const RunResult result = go(steps_of(c.t_end, c.step));
    INFO("T = " << c.t_end << ", H = " << c.step);
    CHECK(result.status == Status::ok);
    CHECK(result.message.empty());
    CHECK(result.t == c.t_end);
    CHECK(result.cost.steps == c.count);
    CHECK(result.cost.rhs == 2 * c.count);
    REQUIRE(result.step);
    CHECK(*result.step == c.t_end / static_cast<double>(c.count));
    CHECK(result.state == std::vector<double>{after(c.count, *result.step)});
    CHECK(result.flags.empty());
    CHECK(result.cpu_seconds >= 0.0);
  }
}

TEST_CASE("run: steps get their own times", "[run]") {
  // The journal is part of the state, so march can be asked for it.
  const Line model;
  Journal journal = Advancing::start(model, model.initial());
  long n = 0;
  CHECK(detail::march<Line, Advancing>(model, journal, n, 1000, 0.1) == Status::ok);
  CHECK(n == 1000);
  CHECK(journal.steps == 1000);
  CHECK(journal.times_fit);
  CHECK(journal.last_t == 999 * 0.1);
  CHECK(journal.last_h == 0.1);
}

TEST_CASE("run: the result does not depend on what is looked at", "[run]") {
  RunSpec spec = steps_of(30.0, 1e-3);
  const RunResult plain = go(spec);
  for (int watch : {1, 7, 5000}) {
    spec.watch = watch;
    spec.samples = watch / 3;
    CHECK(go(spec).state == plain.state);
  }
  spec.record = false;
  spec.samples = 0;
  const RunResult unseen = go(spec);
  CHECK(unseen.state == plain.state);
  CHECK(unseen.invariants.t.empty());
  CHECK(unseen.sample_times.empty());
  CHECK(unseen.cost.steps == 30000);
}

TEST_CASE("run: the limit of steps", "[run]") {
  RunSpec spec = steps_of(10.0, 0.01);
  for (long limit : {1L, 63L, 64L, 65L, 999L}) {
    spec.max_steps = limit;
    const RunResult result = go(spec);
    INFO("limit " << limit);
    CHECK(result.status == Status::step_limit);
    CHECK(result.message == "reached --max-steps " + std::to_string(limit));
    CHECK(result.cost.steps == limit);
    CHECK(result.t == static_cast<double>(limit) * 0.01);
    CHECK(result.state == std::vector<double>{after(limit, 0.01)});
  }
  for (long limit : {1000L, 1001L}) {
    spec.max_steps = limit;
    CHECK(go(spec).status == Status::ok);
    CHECK(go(spec).t == 10.0);
  }
  spec.max_steps = 0;
  const RunResult none = go(spec);
  CHECK(none.status == Status::step_limit);
  CHECK(none.t == 0.0);
  CHECK(none.state == std::vector<double>{1.0});
}

TEST_CASE("run: the limit of time", "[run]") {
  for (bool record : {true, false}) {
    RunSpec spec = steps_of(1e6, 1e-3);
    spec.time_limit = 0.0;
    spec.record = record;
    const RunResult result = go(spec);
    CHECK(result.status == Status::time_limit);
    CHECK(result.message == "reached --time-limit 0 s");
    CHECK(result.cost.steps >= 1);
    CHECK(result.cost.steps < 1'000'000);
    CHECK(result.t == static_cast<double>(result.cost.steps) * 1e-3);
    CHECK(result.state == std::vector<double>{after(result.cost.steps, 1e-3)});
  }
  // A longer one ends the run when it is over, not much later.
  RunSpec spec = steps_of(1e9, 1e-3);
  spec.time_limit = 0.05;
  spec.max_steps = 1'000'000'000'000;
  const double begin = wall_seconds();
  CHECK(go(spec).status == Status::time_limit);
  CHECK(wall_seconds() - begin >= 0.05);
  CHECK(wall_seconds() - begin <= 5.0);
}

TEST_CASE("run: an interruption", "[run]") {
  std::atomic<bool> stop{true};
  RunSpec spec = steps_of(1e6, 1e-3);
  spec.stop = &stop;
  const RunResult result = go(spec);
  CHECK(result.status == Status::interrupted);
  CHECK(result.message == "interrupted");
  CHECK(result.cost.steps < 1'000'000);
  CHECK(result.t == static_cast<double>(result.cost.steps) * 1e-3);
  CHECK(result.state == std::vector<double>{after(result.cost.steps, 1e-3)});
  stop = false;
  spec.t_end = 1.0;
  CHECK(go(spec).status == Status::ok);
}

namespace {

template <class S>
void check_last_good_state(long bad_step, Status expected, std::string_view words) {
  const double h = 0.25;
  for (int watch : {1, 400}) {
    RunSpec spec = steps_of(0.25 * 2000, h);
    spec.watch = watch;
    const RunResult result = go<S>(spec);
    INFO("step " << bad_step << ", watched " << watch << ": " << result.message);
    CHECK(result.status == expected);
    CHECK(result.message.find(words) != std::string::npos);
    CHECK(result.message.find("in step " + std::to_string(bad_step) + " ") != std::string::npos);
    CHECK(result.t == static_cast<double>(bad_step - 1) * h);
    CHECK(result.cost.steps == bad_step - 1);
    CHECK(result.state == std::vector<double>{after(bad_step - 1, h)});
    for (double value : result.invariants.values) CHECK(std::isfinite(value));
    for (double t : result.invariants.t) CHECK(t <= result.t);
  }
}

}  // namespace

TEST_CASE("run: a state that is no longer finite", "[run]") {
  constexpr Status diverged = Status::diverged;
  check_last_good_state<LineScheme<Spoil<1, 0>>>(1, diverged, "finite");
  check_last_good_state<LineScheme<Spoil<1, 1>>>(1, diverged, "finite");
  check_last_good_state<LineScheme<Spoil<2, 1>>>(2, diverged, "finite");
  check_last_good_state<LineScheme<Spoil<64, 0>>>(64, diverged, "finite");
  check_last_good_state<LineScheme<Spoil<65, 1>>>(65, diverged, "finite");
  check_last_good_state<LineScheme<Spoil<777, 0>>>(777, diverged, "finite");
  check_last_good_state<LineScheme<Spoil<2000, 1>>>(2000, diverged, "finite");
  // Growth instead of a sudden end: 2^1023 is the last power of two.
  const RunResult grown = go<LineScheme<Double>>(steps_of(500.0, 0.25));
  CHECK(grown.status == diverged);
  CHECK(grown.t == 1023 * 0.25);
  CHECK(grown.state == std::vector<double>{std::ldexp(1.0, 1023)});
}

TEST_CASE("run: a step that says why it failed", "[run]") {
  check_last_good_state<LineScheme<Fail<1, Status::newton_failed>>>(1, Status::newton_failed, "Newton");
  check_last_good_state<LineScheme<Fail<64, Status::newton_failed>>>(64, Status::newton_failed, "Newton");
  check_last_good_state<LineScheme<Fail<500, Status::newton_failed>>>(500, Status::newton_failed, "Newton");
  check_last_good_state<LineScheme<Fail<1500, Status::diverged>>>(1500, Status::diverged, "beyond any scale");
}

TEST_CASE("run: samples", "[run]") {
  RunSpec spec = steps_of(8.0, 0.125);
  spec.samples = 4;
  const RunResult result = go(spec);
  REQUIRE(result.sample_times == std::vector<double>{0.0, 2.0, 4.0, 6.0, 8.0});
  REQUIRE(result.samples.size() == 5);
  for (std::size_t k = 0; k < 5; ++k)
    CHECK(result.samples[k] == std::vector<double>{1.0 + result.sample_times[k]});
  CHECK(result.samples.back() == result.state);
  // A sample is the state of the step nearest to its time, with the step's own time.
  spec = steps_of(1.0, 0.25);
  spec.samples = 3;
  CHECK(go(spec).sample_times == std::vector<double>{0.0, 0.25, 0.75, 1.0});
  // More samples than steps: each step once.
  spec.samples = 100;
  CHECK(go(spec).sample_times == std::vector<double>{0.0, 0.25, 0.5, 0.75, 1.0});
  spec.samples = 0;
  CHECK(go(spec).samples.empty());
  // Samples do not hang on the record of invariants.
  spec.samples = 2;
  spec.record = false;
  CHECK(go(spec).sample_times == std::vector<double>{0.0, 0.5, 1.0});
}

TEST_CASE("run: the end is t_end whatever N times the rounded step is", "[run]") {
  int rounded = 0;
  for (long count : {10L, 49L, 98L, 103L, 107L, 161L}) {
    RunSpec spec = steps_of(1.0, 1.0 / static_cast<double>(count));
    spec.samples = 2;
    const RunResult result = go(spec);
    REQUIRE(result.cost.steps == count);
    if (static_cast<double>(count) * *result.step != 1.0) ++rounded;
    INFO(count << " steps");
    CHECK(result.t == 1.0);
    CHECK(result.sample_times.back() == 1.0);
    CHECK(result.invariants.t.back() == 1.0);
  }
  CHECK(rounded >= 2);
}

TEST_CASE("run: invariants along the way", "[run]") {
  Line model;
  model.infos = {{"lag", 1, 0.0, 1.0}, {"late", 1, 2.5, 1.0}};
  RunSpec spec = steps_of(10.0, 0.125);
  spec.watch = 20;
  const RunResult result = go(spec, model);
  const Trace& trace = result.invariants;
  REQUIRE(trace.values.size() == 2 * trace.t.size());
  CHECK(trace.t.front() == 0.0);
  CHECK(trace.t.back() == 10.0);
  CHECK(std::adjacent_find(trace.t.begin(), trace.t.end(), std::greater_equal<>()) == trace.t.end());
  // The start, twenty times and the one from which on the second is constant; times on one step fall
  // together.
  CHECK(trace.t.size() <= 22);
  CHECK(trace.t.size() >= 18);
  CHECK(std::count(trace.t.begin(), trace.t.end(), 2.5) == 1);
  for (double value : trace.values) CHECK(value == 1.0);  // x - t, exact for this step
  // Not in equal distances.
  double shortest = 10.0, longest = 0.0;
  for (std::size_t k = 1; k < trace.t.size(); ++k) {
    shortest = std::min(shortest, trace.t[k] - trace.t[k - 1]);
    longest = std::max(longest, trace.t[k] - trace.t[k - 1]);
  }
  CHECK(longest >= 1.5 * shortest);
}

TEST_CASE("run: a break that the steps miss", "[run]") {
  Line model;
  const auto flagged = [&](double t_end, double step, std::vector<double> breaks) {
    model.break_times = std::move(breaks);
    const RunResult result = go(steps_of(t_end, step), model);
    CHECK(result.status == Status::ok);
    return has_flag(result, "break");
  };
  CHECK(!flagged(10.0, 0.1, {}));
  CHECK(!flagged(10.0, 0.1, {2.5}));
  CHECK(flagged(10.0, 0.4, {2.5}));
  CHECK(flagged(10.0, 0.3, {2.5}));  // the step becomes 10/34
  CHECK(!flagged(10.0, 0.1, {0.3, 0.7, 9.9}));
  CHECK(flagged(10.0, 0.1, {0.3, 0.75}));
  CHECK(!flagged(1e4, 1e-2, {2.5, 777.77}));
  CHECK(flagged(1e4, 1e-2, {2.505}));
  // Those at the ends, or behind the end, are no breaks of this run.
  CHECK(!flagged(10.0, 0.3, {0.0}));
  CHECK(!flagged(10.0, 0.3, {10.0}));
  CHECK(!flagged(10.0, 0.3, {12.34}));
}

namespace {

struct Formula {
  static constexpr SchemeInfo info{.name = "formula",
                                   .family = "test",
                                   .summary = "",
                                   .citation = "",
                                   .form = "closed form",
                                   .stepping = Stepping::closed_form};
  static Line::State at(const Line&, double t) { return {1.0 + t}; }
};
struct BadFormula : Formula {
  static Line::State at(const Line&, double t) {
    return {t < 4.0 ? 1.0 + t : std::numeric_limits<double>::quiet_NaN()};
  }
};

}  // namespace

TEST_CASE("run: a closed form", "[run]") {
  RunSpec spec;
  spec.t_end = 5.0;
  spec.samples = 5;
  spec.watch = 10;
  const RunResult result = run<Line, Formula>(Line{}, spec);
  CHECK(result.status == Status::ok);
  CHECK(result.t == 5.0);
  CHECK(!result.step);
  CHECK(result.state == std::vector<double>{6.0});
  CHECK(result.sample_times == std::vector<double>{0.0, 1.0, 2.0, 3.0, 4.0, 5.0});
  CHECK(result.samples[2] == std::vector<double>{3.0});
  CHECK(result.invariants.t.size() == 11);
  CHECK(result.invariants.t.back() == 5.0);
  const RunResult bad = run<Line, BadFormula>(Line{}, spec);
  CHECK(bad.status == Status::diverged);
  CHECK(!bad.message.empty());
}

TEST_CASE("run: every status has its name", "[run]") {
  for (Status status : {Status::ok, Status::diverged, Status::newton_failed, Status::solver_failed,
                        Status::step_limit, Status::time_limit, Status::interrupted, Status::unsupported})
    for (Status other : {Status::ok, Status::diverged, Status::newton_failed, Status::solver_failed,
                         Status::step_limit, Status::time_limit, Status::interrupted, Status::unsupported})
      CHECK((to_string(status) == to_string(other)) == (status == other));
}
