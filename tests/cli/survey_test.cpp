// `gnomon survey`: what all schemes of a model do.
#include "tests/cli/document.hpp"

using namespace gnomon::test;
using namespace gnomon::test::cli;

TEST_CASE("cli: the survey finds what the schemes are known to do", "[cli][long]") {
  const Json json = json_of({"survey", "rigid_body", "--quick", "--no-timing"});
  REQUIRE(json["command"] == "survey");
  const Json& entries = json["survey"]["rigid_body"];
  const auto entry = [&](const std::string& integrator, const std::string& of) {
    for (const Json& each : entries)
      if (each["integrator"] == integrator && each["class"] == of) return each;
    return Json();
  };
  for (const auto& [integrator, of, order] :
       {std::tuple{"munjiza", "free", 2.0}, std::tuple{"munjiza", "space moment", 1.0},
        std::tuple{"munjiza-half-impulse", "space moment", 2.0},
        std::tuple{"munjiza-half-impulse", "gravity", 1.0},
        std::tuple{"munjiza-stage-moments", "gravity", 2.0}, std::tuple{"rkmk4", "gravity", 4.0}}) {
    const Json found = entry(integrator, of);
    INFO(integrator << ", " << of << ": " << found.dump());
    REQUIRE(found.is_object());
    CHECK(std::abs(found["observed_order"].get<double>() - order) <= 0.1);
    CHECK(found["declared_order"] == order);
    CHECK(found["ns_a_step"].is_null());
    CHECK(found["status"] == "ok");
    CHECK(found["rhs"] == 4 * found["steps"].get<long>());
  }
  const Json held = entry("rkmk4", "free")["held"];
  CHECK(std::count(held.begin(), held.end(), "angular_momentum") == 1);
  CHECK(std::count(held.begin(), held.end(), "energy") == 0);
  CHECK(entry("munjiza", "free")["energy"]["verdict"] == "secular");
  CHECK(entry("munjiza", "free")["energy"]["max_drift"] > entry("rkmk4", "free")["energy"]["max_drift"]);
  CHECK(entry("munjiza", "gravity")["moments"] == entry("munjiza", "gravity")["steps"]);
  // Large steps change the energy of the printed scheme; the free body's largest one is no smaller than the
  // top's.
  CHECK(entry("munjiza", "gravity")["off_by_1_percent_at"].is_number());
  CHECK(entry("munjiza", "gravity")["off_how"] != "");
  const char* largest = "largest_step_within_1_percent";
  CHECK(entry("munjiza", "gravity")[largest] < entry("rkmk4", "gravity")[largest]);
  CHECK(entry("munjiza", "gravity")["stepping"] == "fixed step");
  // Those that choose their steps stand beside them.
  const Json adams = entry("cvode-adams", "gravity");
  CHECK(adams["stepping"] == "adaptive");
  CHECK(adams["tol"] == 1e-8);
  CHECK(adams["error"] <= 1e-5);
  CHECK(adams["steps"] > 100);
  CHECK(adams["ns_a_step"].is_null());
  CHECK(entry("exact-heavy-symmetric-top", "gravity")["scene"] == "heavy-symmetric-top");
  CHECK(entry("ida-bdf-index3", "gravity")["status"] == "solver_failed");
}

TEST_CASE("cli: only models that have a survey are surveyed", "[cli]") {
  const TemporaryFolder folder;
  const Outcome outcome = run_program({"survey", "pendulum"}, folder.path());
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.out.empty());
  CHECK(outcome.err.find("found 'pendulum', expected a model with a survey") != std::string::npos);
  CHECK(folder.entries() == 0);
}
