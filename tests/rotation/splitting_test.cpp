// Splittings into kicks and free drifts: their coefficients, what they cost and how their energy behaves.

#include "integrators/rotation/splittings.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "src/study/study.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;

TEST_CASE("schemes: coefficients of the splittings", "[rotation][splitting]") {
  const auto check = [](std::string_view name, const auto& splitting) {
    INFO(name);
    const auto sum_and_symmetry = [](const auto& fractions) {
      double sum = 0.0;
      for (double c : fractions) sum += c;
      CHECK(std::abs(sum - 1.0) <= 1e-15);
      CHECK(std::equal(fractions.begin(), fractions.end(), fractions.rbegin()));
    };
    sum_and_symmetry(splitting.kicks);
    sum_and_symmetry(splitting.drifts);
  };
  check("strang", rotation::strang);
  check("yoshida4", rotation::yoshida4);
  check("suzuki4", rotation::suzuki4);
  check("blanes-moan4", rotation::blanes_moan4);
  check("blanes-moan-rkn4", rotation::blanes_moan_rkn4);
  check("blanes-moan-rkn6", rotation::blanes_moan_rkn6);
  check("kahan-li6", rotation::kahan_li6);
  check("mclachlan8", rotation::mclachlan8);
  check("kahan-li8", rotation::kahan_li8);

  // Order conditions of symmetric compositions of Strang steps: the sums of the odd powers are 0.
  const auto powers = [](const auto& splitting, int power) {
    double sum = 0.0;
    for (double c : splitting.drifts) sum += std::pow(c, power);
    return std::abs(sum);
  };
  for (int p : {3, 5, 7}) {
    INFO("power " << p);
    if (p < 5) CHECK(powers(rotation::yoshida4, p) <= 7e-15);
    if (p < 5) CHECK(powers(rotation::suzuki4, p) <= 2e-15);
    if (p < 7) CHECK(powers(rotation::kahan_li6, p) <= 2e-15);
    CHECK(powers(rotation::mclachlan8, p) <= 2e-15);
    CHECK(powers(rotation::kahan_li8, p) <= 2e-15);
  }
  CHECK(powers(rotation::yoshida4, 5) >= 1e-3);
  CHECK(powers(rotation::kahan_li6, 7) >= 1e-3);
}

TEST_CASE("schemes: moments that a splitting takes", "[rotation][splitting]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "asymmetric-heavy-top");
  RunSpec spec;
  spec.t_end = 1.0;
  spec.step = 0.1;
  spec.record = false;
  const std::pair<const char*, long> a_step[] = {
      {"strang", 1},           {"yoshida4", 3},  {"suzuki4", 5},           {"blanes-moan4", 6},
      {"blanes-moan-rkn4", 6}, {"kahan-li6", 9}, {"blanes-moan-rkn6", 14}, {"mclachlan8", 15},
      {"kahan-li8", 17}};
  for (const auto& [name, moments] : a_step) {
    for (const char* drift : {"-exact-drift", "-dmv10"}) {
      const std::string scheme = std::string(name) == "strang" && std::string(drift) == "-dmv10"
                                     ? "dmv10"
                                     : std::string(name) + drift;
      INFO(scheme);
      // The last moment of a step is the first of the next, where the step starts with one.
      const bool starts_with_one = std::string(name) != "blanes-moan-rkn6";
      CHECK(run_scheme(catalogue, scheme, *scene.model, spec).cost.moments ==
            10 * moments + (starts_with_one ? 1 : 0));
    }
  }
}

TEST_CASE("schemes: energy over many steps is bounded or not", "[rotation][drift][long]") {
  const Catalogue catalogue = full_catalogue();
  const auto verdict = [&](const char* scene_name, const char* scheme) {
    SceneChanges longer;
    longer.t_end = 2000.0;
    const Scene scene = load_scene(catalogue, scene_name, longer);
    RunSpec spec;
    spec.t_end = 2000.0;
    spec.step = 0.05;
    spec.watch = 1000;
    const RunResult result = run_scheme(catalogue, scheme, *scene.model, spec);
    REQUIRE(result.status == Status::ok);
    for (const InvariantSummary& seen : summarise_invariants(*scene.model, result.invariants))
      if (seen.info.name == std::string_view("energy"))
        return measure_drift(seen.times, seen.drift, 0.0).verdict;
    throw std::logic_error("no energy");
  };
  // Those that keep the energy of a free body to rounding are looked at elsewhere.
  for (const char* scheme : {"lie-verlet", "liemid-ea"}) {
    INFO(scheme);
    CHECK(verdict("asymmetric-free-top", scheme) == DriftVerdict::bounded);
  }
  for (const char* scheme : {"cf4", "crouch-grossman3", "rk4-quaternion"}) {
    INFO(scheme);
    CHECK(verdict("asymmetric-free-top", scheme) == DriftVerdict::secular);
    CHECK(verdict("asymmetric-heavy-top", scheme) == DriftVerdict::secular);
  }
  for (const char* scheme : {"strang-exact-drift", "blanes-moan-rkn4-exact-drift", "kahan-li6-dmv10", "dmv2",
                             "lie-verlet", "liemid-ea", "simo-wong-c1", "implicit-midpoint"}) {
    INFO(scheme);
    CHECK(verdict("asymmetric-heavy-top", scheme) == DriftVerdict::bounded);
  }
}
