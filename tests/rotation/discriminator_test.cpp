// A heavy top without any symmetry tells symplectic schemes from merely symmetric ones.

#include <algorithm>

#include "src/study/study.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

Drift energy_drift(const Catalogue& catalogue, const std::string& scheme,
                   const std::string& name = "off-axis-heavy-top", double t_end = 1e4) {
  const Scene scene = load_scene(catalogue, name, {t_end, {}});
  RunSpec spec;
  spec.t_end = scene.t_end;
  spec.step = 0.25;
  spec.watch = 2048;
  const RunResult result = run_scheme(catalogue, scheme, *scene.model, spec);
  INFO(scheme);
  REQUIRE(result.status == Status::ok);
  for (const InvariantSummary& invariant : summarise_invariants(*scene.model, result.invariants))
    if (invariant.info.name == "energy") return measure_drift(invariant.times, invariant.drift, 0.0);
  return {};
}

}  // namespace

TEST_CASE("schemes: symplectic ones keep the energy of a top without symmetry, merely symmetric ones do not",
          "[rotation][long]") {
  const Catalogue catalogue = full_catalogue();
  for (const char* scheme : {"strang-exact-drift", "lie-verlet", "no-squish"}) {
    const Drift drift = energy_drift(catalogue, scheme);
    INFO(scheme << ": slope " << drift.slope << " +- " << drift.slope_error << ", growth " << drift.growth);
    CHECK(drift.verdict == DriftVerdict::bounded);
    CHECK(std::abs(drift.slope) <= 1e-6);
    CHECK(drift.growth <= 0.1);
    CHECK(drift.max_abs <= 0.2);
    CHECK(drift.max_abs >= 1e-3);  // it is seen at all
  }
  for (const char* scheme : {"liemid-ea", "implicit-midpoint", "simo-wong-c1"}) {
    const Drift drift = energy_drift(catalogue, scheme);
    INFO(scheme << ": slope " << drift.slope << " +- " << drift.slope_error << ", growth " << drift.growth);
    CHECK(drift.verdict == DriftVerdict::secular);
    CHECK(std::abs(drift.slope) >= 3e-6);
  }
  // Steady over a longer run. The two others wander, and their exponents depend on the step.
  const Drift steady = energy_drift(catalogue, "liemid-ea", "off-axis-heavy-top", 4e4);
  INFO("slope " << steady.slope << " +- " << steady.slope_error << ", growth " << steady.growth);
  CHECK(steady.verdict == DriftVerdict::secular);
  CHECK(steady.growth > 0.5);
  CHECK(std::abs(steady.slope - 5.1e-6) <= 1e-6);
}

// The published counterexample, with its step and length.
TEST_CASE("schemes: the Lie-Newmark method loses the energy of a body in a static potential", "[rotation]") {
  const Catalogue catalogue = full_catalogue();
  const Drift verlet = energy_drift(catalogue, "lie-verlet", "lie-newmark");
  CHECK(verlet.verdict == DriftVerdict::bounded);
  CHECK(verlet.max_abs <= 0.05);
  const Drift newmark = energy_drift(catalogue, "lie-newmark", "lie-newmark");
  CHECK(newmark.verdict == DriftVerdict::secular);
  CHECK(newmark.max_abs >= 2.0 * verlet.max_abs);
}
