// `gnomon reference`.
#include <filesystem>

#include "tests/cli/document.hpp"

namespace fs = std::filesystem;
using namespace gnomon::test;
using namespace gnomon::test::cli;

TEST_CASE("cli: reference shows what errors are measured against, and from where it has it", "[cli]") {
  // Computed, then read, then computed again.
  const Words words{"reference", "asymmetric-heavy-top", "--t-end", "0.4375"};
  const Json first = json_of({"reference", "asymmetric-heavy-top", "--t-end", "0.4375", "--fresh"}),
             second = json_of(words);
  for (const Json& json : {first, second}) {
    CHECK(keys_of(json) == Keys{"gnomon", "command", "environment", "scenes", "runs", "orders"});
    REQUIRE(json["scenes"].size() == 1);
    const Json& reference = json["scenes"][0]["reference"];
    CHECK(keys_of(reference) == Keys{"kind", "methods", "error_bound", "t", "file", "from_file", "seconds",
                                     "state", "probes", "decimals"});
    CHECK(reference["kind"] == "certified");
    CHECK(reference["methods"].size() >= 2);
    CHECK(reference["t"] == 0.4375);
    CHECK(is_numbers(reference["state"]["orientation"], 4));
    CHECK(fs::exists(reference["file"].get<std::string>()));
    for (const char* metric : {"orientation", "momentum"}) {
      const double bound = reference["error_bound"][metric];
      const int decimals = reference["decimals"][metric];
      CHECK((bound > 0.0 && bound < 1e-13));
      CHECK(bound <= 0.5 * std::pow(10.0, -decimals));
      CHECK(bound > 0.5 * std::pow(10.0, -decimals - 1));
    }
  }
  CHECK(first["scenes"][0]["reference"]["from_file"] == false);
  CHECK(second["scenes"][0]["reference"]["from_file"] == true);
  CHECK(first["scenes"][0]["reference"]["state"] == second["scenes"][0]["reference"]["state"]);
  // A solver at a tight tolerance comes near it.
  const Json run = json_of({"run", "asymmetric-heavy-top", "--integrator", "arkode-erk8", "--tol", "1e-12",
                            "--t-end", "0.4375", "--no-timing"})["runs"][0];
  for (int k = 0; k < 4; ++k)
    CHECK(std::abs(run["state"]["orientation"][k].get<double>() -
                   second["scenes"][0]["reference"]["state"]["orientation"][k].get<double>()) <= 1e-10);

  const Json exact = json_of({"reference", "asymmetric-free-top"})["scenes"][0]["reference"];
  CHECK(exact["kind"] == "analytic");
  CHECK(exact["file"].is_null());
  CHECK(exact["from_file"] == false);
}

TEST_CASE("cli: reference prints its state and its bounds", "[cli]") {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(
      {"reference", "asymmetric-free-top", "symmetric-free-top", "--csv", "bounds.csv"}, folder.path());
  INFO(outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.out.find("asymmetric-free-top: analytic\n") != std::string::npos);
  CHECK(outcome.out.find("state at the end\n  orientation ") != std::string::npos);
  CHECK(content_of(folder.path() / "bounds.csv").starts_with("metric,unit,bound,decimals\norientation,rad,"));
}
