#pragma once
// The JSON of a call, checked against the keys and types that scripts depend on.

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/cli/program.hpp"

namespace gnomon::test::cli {

using Json = nlohmann::json;
using Words = std::vector<std::string>;
using Keys = std::set<std::string>;

inline const std::string free_top =
    "name = \"free\"\nmodel = \"rigid_body\"\nt_end = 2.0\n[body]\ninertia = [0.6, 0.8, 1.0]\n"
    "angular_momentum = [1.8, 0.4, -0.9]\n";
inline const std::string symmetric_top =
    "name = \"symmetric\"\nmodel = \"rigid_body\"\nt_end = 1.0\n[body]\ninertia = [2.0, 2.0, 3.0]\n"
    "angular_velocity = [0.0, 1.0, 2.0]\n";

inline Keys keys_of(const Json& json) {
  Keys keys;
  for (const auto& [key, value] : json.items()) keys.insert(key);
  return keys;
}

/// The JSON of a call that has to end with the given code and to print nothing else.
inline Json json_of(Words arguments, int exit_code = 0) {
  const TemporaryFolder folder;
  arguments.insert(arguments.end(), {"--json", "-"});
  const Outcome outcome = run_program(arguments, folder.path());
  INFO(Catch::StringMaker<Words>::convert(arguments) << "\n" << outcome.err);
  REQUIRE(outcome.exit_code == exit_code);
  CHECK(folder.entries() == 0);
  return Json::parse(outcome.out);
}

inline bool is_numbers(const Json& json, std::size_t count) {
  return json.is_array() && json.size() == count &&
         std::all_of(json.begin(), json.end(), [](const Json& entry) { return entry.is_number(); });
}

inline bool is_number_or_null(const Json& json) { return json.is_number() || json.is_null(); }

inline void check_document(const Json& json, const std::string& command) {
  Keys keys{"gnomon", "command", "environment", "scenes", "runs", "orders"};
  if (command == "drift") keys.insert("drifts");
  if (command == "compare") keys.insert("costs");
  CHECK(keys_of(json) == keys);
  CHECK(json["gnomon"].is_string());
  CHECK(json["command"] == command);
  for (const char* key : {"cpu", "compiler", "flags", "eigen", "suitesparse", "git", "date"}) {
    INFO(key);
    REQUIRE(json["environment"].contains(key));
    CHECK(json["environment"][key].is_string());
  }
  CHECK(json["environment"]["sundials"]["version"].is_string());
  CHECK(json["environment"]["sundials"]["optimised"].is_boolean());
}

inline void check_scene(const Json& scene) {
  Keys keys = keys_of(scene);
  for (const char* optional : {"description", "load", "warnings"}) keys.erase(optional);
  CHECK(keys == Keys{"name", "model", "t_end", "body", "reference"});
  CHECK(keys_of(scene["body"]) == Keys{"inertia", "orientation", "angular_momentum"});
  CHECK(is_numbers(scene["body"]["inertia"], 3));
  CHECK(is_numbers(scene["body"]["orientation"], 4));
  CHECK(is_numbers(scene["body"]["angular_momentum"], 3));
  const Json& reference = scene["reference"];
  keys = keys_of(reference);
  keys.erase("message");
  CHECK(keys == Keys{"kind", "methods", "error_bound"});
  CHECK(reference["methods"].is_array());
  if (reference["kind"].is_null()) {
    CHECK(reference["error_bound"].empty());
    return;
  }
  CHECK((reference["kind"] == "analytic" || reference["kind"] == "certified"));
  CHECK(!reference["methods"].empty());
  CHECK(keys_of(reference["error_bound"]) == Keys{"orientation", "momentum"});
  for (const Json& bound : reference["error_bound"]) CHECK((bound > 0.0 && bound < 1e-9));
}

/// `samples`: how many states --samples asked for.
inline void check_run(const Json& run, std::size_t samples = 0) {
  INFO(run.dump(1));
  Keys keys{"scene",   "integrator",  "step",  "requested_step", "tol",        "status",
            "message", "t",           "state", "probes",         "invariants", "error",
            "cost",    "cpu_seconds", "flags", "below_bound",    "options"};
  if (samples > 0) keys.insert("series");
  if (run.contains("own_error_bound")) {
    keys.insert("own_error_bound");
    CHECK(run["integrator"].get<std::string>().starts_with("exact-"));
    for (const Json& bound : run["own_error_bound"]) CHECK(is_number_or_null(bound));
  }
  if (run.contains("pareto")) {
    keys.insert("pareto");
    CHECK(keys_of(run["pareto"]) == Keys{"cpu_seconds", "rhs"});
  }
  CHECK(keys_of(run) == keys);
  for (const char* key : {"scene", "integrator", "status", "message"}) CHECK(run[key].is_string());
  for (const char* key : {"step", "requested_step", "tol"}) CHECK(is_number_or_null(run[key]));
  CHECK(run["step"].is_null() == run["requested_step"].is_null());
  CHECK(run["message"].get<std::string>().empty() == (run["status"] == "ok"));
  CHECK(run["t"].is_number());
  CHECK(run["probes"] == Json::object());
  CHECK(run["flags"].is_array());

  CHECK(keys_of(run["state"]) == Keys{"orientation", "angular_momentum"});
  REQUIRE(is_numbers(run["state"]["orientation"], 4));
  REQUIRE(is_numbers(run["state"]["angular_momentum"], 3));
  double square = 0.0;
  for (const double q : run["state"]["orientation"]) square += q * q;
  CHECK(std::abs(square - 1.0) <= 4e-15);

  CHECK(run["invariants"].contains("orthonormality"));
  for (const auto& [name, invariant] : run["invariants"].items()) {
    CHECK(keys_of(invariant) == Keys{"since", "scale", "initial", "final", "max_drift", "slope"});
    const bool vector = name == "angular_momentum" || name == "momentum_balance";
    for (const char* key : {"initial", "final"})
      CHECK((vector ? is_numbers(invariant[key], 3) : invariant[key].is_number()));
    CHECK(invariant["since"] == 0.0);
    CHECK(invariant["scale"] > 0.0);
    CHECK(invariant["max_drift"] >= 0.0);
    CHECK(is_number_or_null(invariant["slope"]));
  }

  CHECK(run["error"].is_null() == run["below_bound"].is_null());
  if (!run["error"].is_null()) {
    CHECK(keys_of(run["error"]) == Keys{"orientation", "momentum"});
    CHECK(keys_of(run["below_bound"]) == Keys{"orientation", "momentum"});
    for (const Json& error : run["error"]) CHECK(error > 0.0);
    for (const Json& below : run["below_bound"]) CHECK(below.is_boolean());
  }

  CHECK(keys_of(run["cost"]) ==
        Keys{"steps", "rejected", "rhs", "moments", "jacobians", "factorizations", "newton_iterations"});
  for (const Json& count : run["cost"]) CHECK(count.is_number_integer());
  if (const Json& seconds = run["cpu_seconds"]; !seconds.is_null()) {
    CHECK(keys_of(seconds) == Keys{"median", "min", "max", "repetitions", "unstable"});
    CHECK(
        (0.0 < seconds["min"] && seconds["min"] <= seconds["median"] && seconds["median"] <= seconds["max"]));
    CHECK((seconds["repetitions"].is_number_integer() && seconds["repetitions"] >= 5));
  }

  if (samples == 0) return;
  const Json& series = run["series"];
  CHECK(keys_of(series) == Keys{"t", "orientation", "angular_momentum", "invariants"});
  CHECK(is_numbers(series["t"], samples + 1));
  for (const char* key : {"orientation", "angular_momentum"}) CHECK(series[key].size() == samples + 1);
  CHECK(keys_of(series["invariants"]) == keys_of(run["invariants"]));
  for (const Json& values : series["invariants"]) CHECK(values.size() == samples + 1);
  CHECK(series["t"].front() == 0.0);
  CHECK(series["t"].back() == run["t"]);
  CHECK(series["orientation"].back() == run["state"]["orientation"]);
  CHECK(series["angular_momentum"].back() == run["state"]["angular_momentum"]);
}

}  // namespace gnomon::test::cli
