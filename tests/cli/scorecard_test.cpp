// `gnomon scorecard`.
#include "tests/cli/document.hpp"

namespace fs = std::filesystem;
using namespace gnomon::test;
using namespace gnomon::test::cli;

TEST_CASE("cli: the scorecard says in one line what a scheme is known to do", "[cli]") {
  const Json json = json_of({"scorecard", "asymmetric-free-top", "--integrators",
                             "munjiza,rkmk4,dmv10,cvode-adams", "--no-timing", "--quiet"});
  CHECK(keys_of(json) == Keys{"gnomon", "command", "environment", "scenes", "runs", "orders", "scorecard"});
  REQUIRE(json["scorecard"].size() == 4);
  for (const Json& score : json["scorecard"]) {
    INFO(score.dump(1));
    CHECK(keys_of(score) == Keys{"scene", "integrator", "observed_order", "declared_order", "order_finding",
                                 "costs", "energy", "largest_step", "breaks_at", "breaks_how",
                                 "survives_again_up_to", "steps_tried", "tried_down_to", "runs", "failed",
                                 "first_failure"});
    CHECK(score["scene"] == "asymmetric-free-top");
    REQUIRE(score["costs"].size() == 3);
    for (const Json& cost : score["costs"]) CHECK(cost["cpu_seconds"].is_null());
    CHECK(score["failed"] == 0);
    CHECK(score["runs"] >= 8);
  }
  const Json &munjiza = json["scorecard"][0], &rkmk4 = json["scorecard"][1], &dmv10 = json["scorecard"][2],
             &adams = json["scorecard"][3];
  CHECK(std::abs(munjiza["observed_order"].get<double>() - 2.0) <= 0.1);
  CHECK(std::abs(rkmk4["observed_order"].get<double>() - 4.0) <= 0.1);
  CHECK(adams["observed_order"].is_null());
  CHECK(adams["largest_step"].is_null());
  CHECK(munjiza["energy"]["verdict"] == "secular");
  CHECK(dmv10["energy"]["verdict"] == "roundoff");
  CHECK(adams["energy"]["verdict"] == "secular");
  // A scheme of order 2 pays more for six digits than one of order 4, and does not reach nine here.
  CHECK(munjiza["costs"][1]["rhs"] > 20.0 * rkmk4["costs"][1]["rhs"].get<double>());
  CHECK(munjiza["costs"][2]["rhs"].is_null());
  CHECK(rkmk4["costs"][1]["rhs"] < 1e5);
  CHECK(rkmk4["costs"][1]["rhs"] > rkmk4["costs"][0]["rhs"]);
  CHECK(rkmk4["largest_step"] > 0.1);
}

TEST_CASE("cli: several scenes make one scorecard before their own", "[cli]") {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(
      {"scorecard", "asymmetric-free-top", "space-moment", "--integrators", "munjiza,rkmk4", "--no-timing",
       "--quick", "--jobs", "2", "--quiet", "--out", "cards", "--csv", "cards.csv"},
      folder.path());
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  for (const char* ending : {"md", "csv", "tex", "json"})
    CHECK(fs::exists(folder.path() / "cards" / (std::string("scorecard.") + ending)));
  const std::string csv = content_of(folder.path() / "cards" / "scorecard.csv");
  CHECK(
      csv.starts_with("integrator,order,cost_at_1e-03,cost_at_1e-06,cost_at_1e-09,energy,energy_drift,"
                      "largest_step,how,failed\nmunjiza,0.9"));
  CHECK(csv.find("\nrkmk4,") != std::string::npos);
  // Orders 2 without a moment and 1 with one; the cheapest of two costs one times the least.
  CHECK(outcome.out.find(" to 1.99") != std::string::npos);
  CHECK(csv.find("\nrkmk4,3.9") != std::string::npos);
  CHECK(csv.find(",1,1,1,secular,") != std::string::npos);
  const std::string all = content_of(folder.path() / "cards.csv");
  CHECK(all.starts_with(csv));
  CHECK(all.find("integrator,order,cpu_us_at_1e-03") != std::string::npos);
}
