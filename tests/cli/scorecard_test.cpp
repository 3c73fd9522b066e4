// `gnomon scorecard`.
#include "tests/cli/document.hpp"

using namespace gnomon::test;
using namespace gnomon::test::cli;

TEST_CASE("cli: the scorecard says in one line what a scheme is known to do", "[cli]") {
  const Json json = json_of({"scorecard", "asymmetric-free-top", "--integrators",
                             "munjiza,rkmk4,dmv10,cvode-adams", "--no-timing", "--quiet"});
  CHECK(keys_of(json) == Keys{"gnomon", "command", "environment", "scenes", "runs", "orders", "scorecard"});
  REQUIRE(json["scorecard"].size() == 4);
  for (const Json& score : json["scorecard"]) {
    INFO(score.dump(1));
    CHECK(keys_of(score) == Keys{"scene", "integrator", "observed_order", "declared_order", "costs", "energy",
                                 "largest_step", "breaks_at", "breaks_how", "runs", "failed",
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
  CHECK(munjiza["costs"][1]["rhs"].is_null());
  CHECK(rkmk4["costs"][1]["rhs"] < 1e5);
  CHECK(rkmk4["costs"][1]["rhs"] > rkmk4["costs"][0]["rhs"]);
  CHECK(rkmk4["largest_step"] > 0.1);
}
