// `gnomon stability` and --vary.
#include "tests/cli/refusal.hpp"

#include "tests/cli/document.hpp"

namespace fs = std::filesystem;
using namespace gnomon::test;
using namespace gnomon::test::cli;

TEST_CASE("cli: stability shows how schemes fail over step and parameter and ends with 0", "[cli][long]") {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program({"stability", "free-flight", "--t-end", "40", "--integrators", "beam-midpoint", "--vary",
                   "beam.EA=1e4,1e8", "--out", "out", "--json", "all.json", "--quiet"},
                  folder.path());
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK(outcome.err.empty());
  const Json json = Json::parse(content_of(folder.path() / "all.json"));
  CHECK(keys_of(json) == Keys{"gnomon", "command", "environment", "scenes", "runs", "orders", "stability"});
  REQUIRE(json["scenes"].size() == 2);
  CHECK(json["scenes"][1]["name"] == "free-flight[beam.EA=1e8]");
  CHECK(json["scenes"][1]["beam"]["EA"] == 1e8);
  REQUIRE(json["stability"].size() == 2);
  std::size_t runs = 0;
  for (const Json& entry : json["stability"]) {
    CHECK(keys_of(entry) == Keys{"scene", "integrator", "vary", "time_scale", "max_drift", "largest_step",
                                 "breaks_at", "breaks_how", "status", "message", "t", "survives_again",
                                 "steps_tried", "tried_down_to", "points"});
    CHECK(entry["integrator"] == "beam-midpoint");
    CHECK(entry["status"] == "newton_failed");
    CHECK(entry["message"].get<std::string>().starts_with("Newton's iteration did not converge in step "));
    // Steps of seconds are run on beyond the end of the scene.
    CHECK(entry["t"] > 40.0);
    CHECK(entry["t"] < 640.0);
    CHECK(entry["steps_tried"] >= 20);
    CHECK(entry["tried_down_to"] <= entry["largest_step"].get<double>() / 16.0);
    CHECK(entry["largest_step"] < entry["breaks_at"]);
    CHECK(entry["breaks_at"] <= 1.2 * entry["largest_step"].get<double>());
    runs += entry["points"].size();
  }
  CHECK(json["runs"].size() == runs);
  CHECK(json["stability"][1]["largest_step"] > 1.0);
  CHECK(json["stability"][0]["largest_step"] > 1.3 * json["stability"][1]["largest_step"].get<double>());
  for (const char* suffix : {".md", ".csv", ".json", ".svg", ".png"})
    CHECK(fs::exists(folder.path() / "out" / (std::string("stability-free-flight") + suffix)));
  CHECK(outcome.out.find("What survives over step and beam.EA, free-flight") != std::string::npos);
}

TEST_CASE("cli: what --vary and stability refuse", "[cli]") {
  const std::string expected = "expected KEY.PATH=V1,V2,.. with every value once, as in beam.EA=1e4,1e6,1e8";
  const auto with = [](const Words& more) {
    Words words{"stability", "s.toml", "--integrators", "rkmk4"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  check_refused({{"s.toml", good}}, with({"--vary", "t_end"}), "--vary: found 't_end', " + expected);
  check_refused({{"s.toml", good}}, with({"--vary", "t_end=1,1.0"}),
                "--vary: found '1.0' twice, " + expected);
  check_refused({{"s.toml", good}}, with({"--vary", "body.inertia=[1,2,3],[1,2]"}),
                "--vary body.inertia=[1,2]: body.inertia: found [1, 2], expected " + inertia_text);
  check_refused({{"s.toml", good}}, with({"--max-drift", "0"}),
                "--max-drift: found '0', expected a positive number");
  check_refused({{"s.toml", good}}, {"stability", "s.toml", "--integrators", "cvode-bdf"},
                "--integrators: found 'cvode-bdf' (adaptive), expected schemes that take equal steps");
  check_refused({{"s.toml", good}}, {"stability"},
                "SCENE: found nothing, expected the name of a shipped scene or a .toml file");
}
