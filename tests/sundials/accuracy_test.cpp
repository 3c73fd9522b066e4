#include <algorithm>
#include <cmath>
#include <map>

#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/silence.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

constexpr double tolerances[] = {1e-5, 1e-7, 1e-9, 1e-10, 1e-11};
constexpr std::size_t count = std::size(tolerances), tightest = count - 1;

/// One solver on one scene: its end states at all tolerances and its errors.
struct Ladder {
  std::vector<double> state[count];
  std::vector<double> error[count];
  /// What the solver's own convergence certifies at the tightest tolerance,
  /// without any reference: twice the larger of what the last tenfold
  /// tightening changed, and a quarter of what the one before did. (The error
  /// falls at least by 4 with such a step, and what one step changes may be
  /// small by chance.)
  std::vector<double> bound;
};

Ladder climb(const Catalogue& catalogue, std::string_view scheme, const Scene& scene,
             const std::vector<double>& reference) {
  Ladder ladder;
  for (std::size_t k = 0; k < count; ++k) {
    RunSpec spec;
    spec.t_end = scene.t_end;
    spec.tol = tolerances[k];
    spec.record = k % 2 == 0;  // driven step by step, or to the end at once
    const RunResult result = run_scheme(catalogue, scheme, *scene.model, spec);
    INFO(result.message);
    REQUIRE(result.status == Status::ok);
    CHECK(result.t == scene.t_end);
    CHECK(result.message.empty());
    ladder.state[k] = result.state;
    ladder.error[k] = scene.model->distance(result.state, reference);
  }
  const auto last = scene.model->distance(ladder.state[tightest], ladder.state[tightest - 1]);
  const auto before = scene.model->distance(ladder.state[tightest - 1], ladder.state[tightest - 2]);
  for (std::size_t m = 0; m < last.size(); ++m)
    ladder.bound.push_back(2.0 * std::max(last[m], 0.25 * before[m]));
  return ladder;
}

}  // namespace

TEST_CASE("sundials: errors shrink with the tolerance and the solvers agree", "[sundials][long]") {
  const Catalogue catalogue = full_catalogue();
  const StderrCapture capture;
  int scenes = 0;
  for (const ShippedScene& shipped : shipped_scenes(catalogue)) {
    Scene scene = load_scene(catalogue, shipped.name);
    if (scene.model_name != "rigid_body") continue;
    if (scene.t_end > 20.0) scene = load_scene(catalogue, shipped.name, {20.0, {}});
    ++scenes;
    const auto chosen = solvers(catalogue, *scene.model);
    // Most heavy tops can also be integrated with the pivot as a constraint.
    REQUIRE(chosen.size() == (catalogue.pair("ida-bdf-constraints", *scene.model) ? 8 : 7));
    const ReferenceStates reference = scene.model->reference({scene.t_end});
    REQUIRE(!reference.kind.empty());
    std::map<std::string_view, Ladder> ladders;
    for (const SchemeInfo& solver : chosen) {
      INFO(solver.name << " on " << shipped.name);
      const Ladder& ladder = ladders[solver.name] =
          climb(catalogue, solver.name, scene, reference.states.front());
      for (std::size_t m = 0; m < ladder.bound.size(); ++m) {
        INFO("metric " << m << ": errors " << ladder.error[0][m] << " " << ladder.error[1][m] << " "
                       << ladder.error[2][m] << " " << ladder.error[4][m] << ", bound " << ladder.bound[m]);
        // A hundredth of the tolerance brings at least a half (less only where a loose one was met by chance)
        // down to the level of rounding, all of them together a thousandth.
        CHECK(ladder.error[1][m] <= 0.7 * ladder.error[0][m] + 1e-15);
        CHECK(ladder.error[2][m] <= 0.5 * ladder.error[1][m] + 1e-15);
        CHECK(ladder.error[4][m] <= 0.5 * ladder.error[2][m] + 1e-15);
        CHECK(ladder.error[4][m] <= 1e-3 * ladder.error[0][m]);
        // The certified bound holds against the reference, and says something.
        CHECK(ladder.error[tightest][m] <= ladder.bound[m] + reference.bounds.front()[m]);
        CHECK(ladder.bound[m] <= 1e-2 * ladder.error[0][m]);
      }
    }
    // At the tightest tolerance any two differ by no more than both certify. At
    // a loose one they differ by more, so the comparison is not blind.
    bool apart = false;
    for (const auto& [name, a] : ladders)
      for (const auto& [other, b] : ladders) {
        INFO(name << " and " << other << " on " << shipped.name);
        const auto tight = scene.model->distance(a.state[tightest], b.state[tightest]);
        const auto loose = scene.model->distance(a.state[1], b.state[1]);
        for (std::size_t m = 0; m < tight.size(); ++m) {
          CHECK(tight[m] <= a.bound[m] + b.bound[m] + 1e-14);
          apart = apart || loose[m] > a.bound[m] + b.bound[m];
        }
      }
    CHECK(apart);
  }
  CHECK(scenes >= 11);
  CHECK(capture.text() == "");
}

TEST_CASE("sundials: what a run counts", "[sundials]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "asymmetric-heavy-top");
  for (const SchemeInfo& solver : solvers(catalogue, *scene.model)) {
    RunSpec spec;
    spec.t_end = scene.t_end;
    spec.tol = 1e-6;
    spec.samples = 5;
    const RunResult result = run_scheme(catalogue, solver.name, *scene.model, spec);
    INFO(solver.name);
    REQUIRE(result.status == Status::ok);
    CHECK(!result.step);
    CHECK(result.cost.steps >= 10);
    CHECK(result.cost.rhs >= result.cost.steps);
    CHECK(result.cost.moments == 0);
    const bool is_explicit = solver.name.substr(0, 10) == "arkode-erk";
    CHECK((result.cost.newton_iterations > 0) == !is_explicit);
    CHECK((result.cost.jacobians > 0) == !is_explicit);
    CHECK((result.cost.factorizations >= result.cost.jacobians) == true);
    // Samples are states of the solver at exactly these times, not interpolated
    // ones.
    REQUIRE(result.sample_times == std::vector<double>{0.0, 2.0, 4.0, 6.0, 8.0, 10.0});
    CHECK(result.samples.back() == result.state);
    const ReferenceStates reference = scene.model->reference({2.0, 4.0, 6.0, 8.0, 10.0});
    for (std::size_t k = 0; k < 5; ++k)
      CHECK(scene.model->distance(result.samples[k + 1], reference.states[k])[0] <= 1e-3);
    // Invariants are looked at at the solver's own steps, the start and the end
    // among them.
    REQUIRE(result.invariants.t.size() >= 10);
    CHECK(result.invariants.t.front() == 0.0);
    CHECK(result.invariants.t.back() == scene.t_end);
    CHECK(std::is_sorted(result.invariants.t.begin(), result.invariants.t.end()));
  }
}
