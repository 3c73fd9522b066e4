// The solvers on beams: through forms with nothing but the beam in common they have to agree.

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/silence.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

constexpr double beam_tolerances[] = {1e-3, 1e-4, 1e-5, 1e-6};
constexpr std::size_t beam_count = std::size(beam_tolerances), tightest_beam = beam_count - 1;

struct BeamLadder {
  std::vector<double> state[beam_count];
  /// Twice the larger of what the last tenfold tightening changed, and half of what the one before did.
  std::vector<double> bound;
};

BeamLadder climb_beam(const Catalogue& catalogue, std::string_view scheme, const Scene& scene) {
  BeamLadder ladder;
  for (std::size_t k = 0; k < beam_count; ++k) {
    RunSpec spec;
    spec.t_end = scene.t_end;
    spec.tol = beam_tolerances[k];
    spec.record = k == 0;
    const RunResult result = run_scheme(catalogue, scheme, *scene.model, spec);
    INFO(scheme << " on " << scene.name << ", tolerance " << beam_tolerances[k] << ": " << result.message);
    REQUIRE(result.status == Status::ok);
    ladder.state[k] = result.state;
  }
  const auto change = [&](std::size_t k) {
    return scene.model->distance(ladder.state[k], ladder.state[k - 1]);
  };
  const auto last = change(tightest_beam), before = change(tightest_beam - 1);
  for (std::size_t m = 0; m < last.size(); ++m)
    ladder.bound.push_back(2.0 * std::max(last[m], 0.5 * before[m]));
  return ladder;
}

/// All implicit solvers agree within what their own convergence certifies.
void check_agreement(const Scene& scene, bool with_reference) {
  const Catalogue catalogue = full_catalogue();
  const StderrCapture capture;
  std::map<std::string_view, BeamLadder> ladders;
  for (std::string_view name :
       {"cvode-bdf", "cvode-bdf-gmres", "cvode-adams", "ida-bdf", "ida-bdf-constraints", "arkode-dirk"})
    if (catalogue.pair(name, *scene.model)) ladders[name] = climb_beam(catalogue, name, scene);
  CHECK(ladders.size() >= 5);
  ReferenceStates reference;
  if (with_reference) {
    reference = scene.model->reference({scene.t_end});
    REQUIRE(reference.kind == "certified");
  }
  bool apart = false;
  for (const auto& [name, a] : ladders) {
    if (with_reference) {
      const auto error = scene.model->distance(a.state[tightest_beam], reference.states[0]);
      for (std::size_t m = 0; m < error.size(); ++m) {
        INFO(name << " on " << scene.name << ", metric " << m << ": " << error[m] << " of " << a.bound[m]);
        CHECK(error[m] <= a.bound[m] + reference.bounds[0][m]);
      }
    }
    for (const auto& [other, b] : ladders) {
      const auto tight = scene.model->distance(a.state[tightest_beam], b.state[tightest_beam]);
      const auto loose = scene.model->distance(a.state[0], b.state[0]);
      for (std::size_t m = 0; m < tight.size(); ++m) {
        INFO(name << " and " << other << " on " << scene.name << ", metric " << m << ": " << tight[m]
                  << " of " << a.bound[m] << " and " << b.bound[m]);
        CHECK(tight[m] <= a.bound[m] + b.bound[m] + 1e-14);
        apart = apart || loose[m] > a.bound[m] + b.bound[m];
      }
    }
  }
  CHECK(apart);  // at a loose tolerance, so the comparison is not blind
  CHECK(capture.text() == "");
}

}  // namespace

TEST_CASE("sundials: the solvers agree on soft and short beams", "[sundials][planar_beam]") {
  const Catalogue catalogue = full_catalogue();
  for (const char* name : {"soft-beam", "cantilever-two-big-steps"})
    check_agreement(load_scene(catalogue, name), true);
}

TEST_CASE("sundials: the solvers agree on flying beams", "[sundials][planar_beam][long]") {
  const Catalogue catalogue = full_catalogue();
  for (const char* name : {"flying-beam", "flying-spaghetti"})
    check_agreement(load_scene(catalogue, name), false);
}

TEST_CASE("sundials: the solvers agree on turning beams", "[sundials][planar_beam]") {
  const Catalogue catalogue = full_catalogue();
  check_agreement(load_scene(catalogue, "curved-free"), false);
  check_agreement(load_scene(catalogue, "spinning-rod", {0.5, {}}), false);
}

TEST_CASE("sundials: the solvers agree on supported beams", "[sundials][planar_beam][long]") {
  const Catalogue catalogue = full_catalogue();
  check_agreement(load_scene(catalogue, "curved-cantilever"), false);
  check_agreement(load_scene(catalogue, "axial-wave"), false);
  // Only the first fall: BDF takes half a million steps to its end.
  check_agreement(load_scene(catalogue, "slender-pendulum", {0.02, {}}), false);
}

TEST_CASE("sundials: the solvers agree on moved and sprung ends, a follower and damping",
          "[sundials][planar_beam]") {
  const Catalogue catalogue = full_catalogue();
  const SceneChanges changes{
      {},
      {"supports={start = {kind = \"moved\", x = {kind = \"half-sine\", to = 0.2, over = 0.5}, z = {kind = "
       "\"spin-up\", rate = 0.5, over = 1.5}, spring = 0.7}, end = {kind = \"sliding\", along = \"x\"}}",
       "beam.damping=0.8",
       "loads=[{at = \"end\", force = [0.3, 0.8], follower = true, profile = {kind = \"table\", t = [0, 1, "
       "1.2], "
       "value = [1, -0.5, 0.4]}}]"}};
  check_agreement(load_scene(catalogue, "soft-beam", changes), true);
}

TEST_CASE("sundials: samples at a jump are the limits from the left", "[sundials][planar_beam]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "robot-arm", {6.0, {}});
  const auto values = [&](const std::vector<double>& state, std::string_view name) {
    for (const Named& named : scene.model->observe(state))
      if (named.name == name) return named.values;
    throw std::logic_error("no such values");
  };
  for (const SchemeInfo& solver : solvers(catalogue, *scene.model)) {
    INFO(solver.name);
    RunSpec spec;
    spec.t_end = scene.t_end;
    spec.tol = 1e-5;
    spec.samples = 6;
    const RunResult result = run_scheme(catalogue, solver.name, *scene.model, spec);
    REQUIRE(result.status == Status::ok);
    REQUIRE(result.sample_times == std::vector<double>{0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0});
    // At rest at 0; turning at its rate until 5, though it has jumped to it at 0 and stops there.
    for (const char* name : {"u", "v"})
      for (double value : values(result.samples[0], name)) CHECK(value == 0.0);
    for (std::size_t k = 1; k < 7; ++k) {
      const std::vector<double> u = values(result.samples[k], "u"), v = values(result.samples[k], "v");
      CHECK(std::abs(u[2] + 0.3 * std::min(static_cast<double>(k), 5.0)) <= 1e-4);
      CHECK(std::abs(v[2] + (k <= 5 ? 0.3 : 0.0)) <= 1e-4);
      CHECK(std::abs(u[0]) + std::abs(u[1]) <= 1e-4);
    }
  }
}

TEST_CASE("sundials: the solvers agree on an arm across the jump of its motion",
          "[sundials][planar_beam][long]") {
  const Catalogue catalogue = full_catalogue();
  for (double t_end : {5.0, 9.0}) check_agreement(load_scene(catalogue, "robot-arm", {t_end, {}}), false);
}
