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

TEST_CASE("cli: a reference beside its scene is made anew when the scene changes", "[cli]") {
  const TemporaryFolder folder;
  const auto scene = [](const char* moment) {
    return "name = \"mine\"\nmodel = \"rigid_body\"\nt_end = 1.0\n[body]\ninertia = [0.6, 0.8, 1.0]\n"
           "angular_momentum = [1.8, 0.4, -0.9]\n[load]\nkind = \"space_moment\"\nmoment = [0.1, 0.2, " +
           std::string(moment) + "]\n";
  };
  const fs::path file = folder.path() / "mine.reference.txt";
  const auto say = [&](const Words& more = {}) {
    Words words{"reference", "mine.toml"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run_program(words, folder.path());
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    return outcome.out;
  };
  write_text(folder.path() / "mine.toml", scene("0.3123"));
  CHECK(say({"--fresh"}).find("file: mine.reference.txt (computed in ") != std::string::npos);
  const std::string first = content_of(file);
  CHECK(say().find("file: mine.reference.txt (read)") != std::string::npos);
  CHECK(content_of(file) == first);
  const auto error = [&] {
    const Json json = Json::parse(run_program({"run", "mine.toml", "--integrator", "rkmk4", "--step", "0.01",
                                               "--no-timing", "--json", "-"},
                                              folder.path())
                                      .out);
    return json["runs"][0]["error"]["momentum"].get<double>();
  };
  CHECK(error() < 1e-8);
  write_text(folder.path() / "mine.toml", scene("0.4123"));
  CHECK(error() < 1e-8);  // the old one is not taken
  CHECK(content_of(file) == first);
  CHECK(say().find("file: mine.reference.txt") != std::string::npos);
  const std::string second = content_of(file);
  CHECK(second != first);
  CHECK(second.find("\nstate ") != std::string::npos);
  write_text(file, "nonsense\n");
  CHECK(say().find("file: mine.reference.txt") != std::string::npos);
  CHECK(content_of(file) == second);
  // Not of a changed scene.
  CHECK(say({"--t-end", "0.5"}).find("mine.reference.txt") == std::string::npos);
  CHECK(content_of(file) == second);
}
