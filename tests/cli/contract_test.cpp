// What scripts depend on: exit codes, files and the JSON of the commands.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "src/scene.hpp"
#include "tests/catch.hpp"
#include "tests/cli/program.hpp"
#include "tests/support/scenes.hpp"

namespace {

namespace fs = std::filesystem;
using namespace gnomon::test;
using Json = nlohmann::json;
using Words = std::vector<std::string>;
using Keys = std::set<std::string>;

const std::string free_top =
    "name = \"free\"\nmodel = \"rigid_body\"\nt_end = 2.0\n[body]\ninertia = [0.6, 0.8, 1.0]\n"
    "angular_momentum = [1.8, 0.4, -0.9]\n";
const std::string symmetric_top =
    "name = \"symmetric\"\nmodel = \"rigid_body\"\nt_end = 1.0\n[body]\ninertia = [2.0, 2.0, 3.0]\n"
    "angular_velocity = [0.0, 1.0, 2.0]\n";

Keys keys_of(const Json& json) {
  Keys keys;
  for (const auto& [key, value] : json.items()) keys.insert(key);
  return keys;
}

/// The JSON of a call that has to end with the given code and to print nothing else.
Json json_of(Words arguments, int exit_code = 0) {
  const TemporaryFolder folder;
  arguments.insert(arguments.end(), {"--json", "-"});
  const Outcome outcome = run_program(arguments, folder.path());
  INFO(Catch::StringMaker<Words>::convert(arguments) << "\n" << outcome.err);
  REQUIRE(outcome.exit_code == exit_code);
  CHECK(folder.entries() == 0);
  return Json::parse(outcome.out);
}

bool is_numbers(const Json& json, std::size_t count) {
  return json.is_array() && json.size() == count &&
         std::all_of(json.begin(), json.end(), [](const Json& entry) { return entry.is_number(); });
}

bool is_number_or_null(const Json& json) { return json.is_number() || json.is_null(); }

void check_document(const Json& json, const std::string& command) {
  Keys keys{"gnomon", "command", "environment", "scenes", "runs", "orders"};
  if (command == "drift") keys.insert("drifts");
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

void check_scene(const Json& scene) {
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
void check_run(const Json& run, std::size_t samples = 0) {
  INFO(run.dump(1));
  Keys keys{"scene",   "integrator",  "step",  "requested_step", "tol",        "status",
            "message", "t",           "state", "probes",         "invariants", "error",
            "cost",    "cpu_seconds", "flags", "below_bound"};
  if (samples > 0) keys.insert("series");
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

}  // namespace

TEST_CASE("cli: the JSON of a run has the documented keys and types", "[cli]") {
  struct Case {
    std::string scene, integrator, option, value;
  };
  for (const Case& each :
       {Case{"asymmetric-free-top", "rkmk4", "--step", "0.1"},
        Case{"symmetric-free-top", "cvode-adams", "--tol", "1e-6"},
        Case{"kovalevskaya", "munjiza", "--step", "0.02"}, Case{"space-moment", "ida-bdf", "--tol", "1e-5"},
        Case{"body-moment", "munjiza-stage-moments", "--step", "0.1"}}) {
    const Json json = json_of({"run", each.scene, "--integrator", each.integrator, each.option, each.value,
                               "--samples", "4", "--no-timing", "--no-reference"});
    check_document(json, "run");
    REQUIRE(json["scenes"].size() == 1);
    check_scene(json["scenes"][0]);
    CHECK(json["scenes"][0]["name"] == each.scene);
    CHECK(json["scenes"][0]["reference"]["kind"].is_null());
    REQUIRE(json["runs"].size() == 1);
    const Json& run = json["runs"][0];
    check_run(run, 4);
    CHECK(run["scene"] == each.scene);
    CHECK(run["integrator"] == each.integrator);
    CHECK(run["status"] == "ok");
    CHECK(run["error"].is_null());
    CHECK(run["cpu_seconds"].is_null());
    CHECK(run[each.option == "--step" ? "requested_step" : "tol"] == std::stod(each.value));
    CHECK(run[each.option == "--step" ? "tol" : "step"].is_null());
    CHECK(run["t"] == json["scenes"][0]["t_end"]);
    for (std::size_t k = 0; k <= 4; ++k) {
      const double expected = run["t"].get<double>() * static_cast<double>(k) / 4.0;
      CHECK(std::abs(run["series"]["t"][k].get<double>() - expected) <= 1e-9);
    }
    CHECK(json["orders"] == Json::array());
  }
}

TEST_CASE("cli: errors come with the bound of their reference, times with their spread", "[cli]") {
  const Json analytic = json_of({"run", "asymmetric-free-top", "--integrator", "rkmk4", "--step", "0.1"});
  check_scene(analytic["scenes"][0]);
  CHECK(analytic["scenes"][0]["reference"]["kind"] == "analytic");
  check_run(analytic["runs"][0]);
  CHECK(analytic["runs"][0]["cpu_seconds"].is_object());
  const double error = analytic["runs"][0]["error"]["orientation"];
  CHECK((error > 1e-6 && error < 1e-2));
  CHECK(analytic["runs"][0]["below_bound"]["orientation"] == false);

  const Json certified = json_of({"run", "asymmetric-heavy-top", "--integrator", "rkmk4", "--step", "0.1",
                                  "--t-end", "0.5", "--no-timing"});
  check_scene(certified["scenes"][0]);
  CHECK(certified["scenes"][0]["reference"]["kind"] == "certified");
  check_run(certified["runs"][0]);
  CHECK(certified["runs"][0]["error"].is_object());
  CHECK(certified["runs"][0]["cpu_seconds"].is_null());

  // The closed form is its own reference: an error that cannot be told from the bound is the bound.
  const Json exact = json_of({"run", "asymmetric-free-top", "--integrator", "exact-free-top", "--no-timing"});
  const Json& run = exact["runs"][0];
  check_run(run);
  CHECK(run["step"].is_null());
  CHECK(run["tol"].is_null());
  for (const char* metric : {"orientation", "momentum"}) {
    CHECK(run["error"][metric] < 1e-13);
    if (run["below_bound"][metric])
      CHECK(run["error"][metric] == exact["scenes"][0]["reference"]["error_bound"][metric]);
  }
}

TEST_CASE("cli: numbers of the JSON are those of the library to the last bit", "[cli]") {
  const Json json = json_of({"run", "asymmetric-heavy-top", "--integrator", "rkmk4", "--step", "0.03",
                             "--no-reference", "--no-timing"});
  const gnomon::Catalogue catalogue = full_catalogue();
  const gnomon::Scene scene = gnomon::load_scene(catalogue, "asymmetric-heavy-top");
  gnomon::RunSpec spec;
  spec.t_end = scene.t_end;
  spec.step = 0.03;
  const gnomon::RunResult result = run_scheme(catalogue, "rkmk4", *scene.model, spec);
  const Json& run = json["runs"][0];
  CHECK(run["step"].get<double>() == result.step.value());
  for (const gnomon::Named& component : scene.model->observe(result.state))
    CHECK(run["state"][component.name].get<std::vector<double>>() == component.values);
  CHECK(run["cost"]["rhs"].get<long>() == result.cost.rhs);
}

TEST_CASE("cli: --step H takes ceil(T/H - 1e-9) equal steps", "[cli]") {
  struct Case {
    const char *t_end, *step;
    long count;
  };
  // In doubles 0.3/0.1, 0.7/0.1 fall just below a whole number and 1.1/0.1 just above.
  for (const Case& each :
       {Case{"0.3", "0.1", 3}, Case{"0.7", "0.1", 7}, Case{"1.1", "0.1", 11}, Case{"1", "0.3", 4},
        Case{"1", "3", 1}, Case{"1", "+0.25", 4}, Case{"1", "0.2499", 5}}) {
    INFO(each.t_end << " " << each.step);
    const Json json = json_of({"run", "asymmetric-free-top", "--integrator", "munjiza", "--t-end", each.t_end,
                               "--step", each.step, "--no-reference", "--no-timing"});
    const Json& run = json["runs"][0];
    CHECK(run["cost"]["steps"] == each.count);
    CHECK(run["step"].get<double>() == std::stod(each.t_end) / static_cast<double>(each.count));
    CHECK(run["requested_step"].get<double>() == std::stod(each.step));
    CHECK(run["t"].get<double>() == std::stod(each.t_end));
  }
}

TEST_CASE("cli: --set and --t-end change the scene that is run", "[cli]") {
  const Words plain{"run", "asymmetric-heavy-top", "--integrator", "rkmk4", "--step",
                    "0.1", "--no-reference",       "--no-timing"};
  Words changed = plain;
  changed.insert(changed.end(), {"--set", "load.weight=2.5", "--set", "body.orientation=[0, 1, 0, 0]",
                                 "--t-end", "3", "--set=name=\"other\"", "--set", "t_end=7"});
  const Json before = json_of(plain), after = json_of(changed);
  CHECK(before["scenes"][0]["load"]["weight"] == 1.0);
  const Json& scene = after["scenes"][0];
  CHECK(scene["load"]["weight"] == 2.5);
  CHECK(scene["body"]["orientation"] == Json({0.0, 1.0, 0.0, 0.0}));
  CHECK(scene["body"]["inertia"] == before["scenes"][0]["body"]["inertia"]);
  CHECK(scene["t_end"] == 3.0);
  CHECK(scene["name"] == "other");
  CHECK(after["runs"][0]["scene"] == "other");
  CHECK(after["runs"][0]["t"] == 3.0);
  // The body stands upside down under another weight: T + V at the start is less by 1.0 m (1 N + 2.5 N).
  const auto energy = [](const Json& json) {
    return json["runs"][0]["invariants"]["energy"]["initial"].get<double>();
  };
  CHECK(std::abs(energy(before) - energy(after) - 3.5) <= 1e-14);
}

TEST_CASE("cli: scenes are found by paths relative to the working folder", "[cli]") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "scenes");
  fs::create_directories(folder.path() / "work");
  write_text(folder.path() / "scenes" / "s.toml", free_top);
  for (const auto& [from, path] : {std::pair{"work", "../scenes/s.toml"},
                                   {".", "scenes/s.toml"},
                                   {"scenes", "./s.toml"},
                                   {"scenes", "s.toml"}}) {
    const Outcome outcome = run_program(
        {"run", path, "--integrator", "rkmk4", "--step", "0.1", "--no-timing", "--json", "out.json"},
        folder.path() / from);
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    CHECK(Json::parse(content_of(folder.path() / from / "out.json"))["runs"][0]["scene"] == "free");
  }
}

TEST_CASE("cli: converge reports observed orders in its JSON", "[cli]") {
  const Json json = json_of(
      {"converge", "asymmetric-free-top", "--integrators", "munjiza,rkmk4,cvode-bdf", "--quick", "--quiet"});
  check_document(json, "converge");
  check_scene(json["scenes"][0]);
  CHECK(json["runs"].size() == 13 + 13 + 10);
  for (const Json& run : json["runs"]) check_run(run);
  // Adaptive integrators have no order to observe.
  REQUIRE(json["orders"].size() == 4);
  for (const Json& order : json["orders"]) {
    INFO(order.dump(1));
    CHECK(keys_of(order) == Keys{"scene", "integrator", "metric", "observed", "interval", "expected",
                                 "points", "verdict", "dropped"});
    CHECK(order["scene"] == "asymmetric-free-top");
    CHECK((order["metric"] == "orientation" || order["metric"] == "momentum"));
    const double expected = order["integrator"] == "munjiza" ? 2.0 : 4.0;
    CHECK(order["expected"] == expected);
    REQUIRE(is_numbers(order["interval"], 2));
    CHECK(order["interval"][0] <= order["observed"]);
    CHECK(order["observed"] <= order["interval"][1]);
    CHECK(std::abs(order["observed"].get<double>() - expected) <= 0.1);
    CHECK(order["points"] >= 4);
    for (const Json& point : order["dropped"]) CHECK(keys_of(point) == Keys{"step", "error", "reason"});
  }
}

TEST_CASE("cli: no order is given where there are fewer than four points", "[cli]") {
  const Json json = json_of(
      {"converge", "asymmetric-free-top", "--integrators", "rkmk4", "--steps", "0.1,0.05,0.025", "--quiet"});
  REQUIRE(json["orders"].size() == 2);
  for (const Json& order : json["orders"]) {
    CHECK(order["observed"].is_null());
    CHECK(order["interval"].is_null());
  }
}

TEST_CASE("cli: drift reports every invariant of every run in its JSON", "[cli]") {
  const Json json = json_of({"drift", "asymmetric-free-top", "--integrators", "munjiza,cvode-adams", "--step",
                             "0.05", "--tol", "1e-7", "--t-end", "20", "--quiet", "--no-reference"});
  check_document(json, "drift");
  REQUIRE(json["runs"].size() == 2);
  for (const Json& run : json["runs"]) check_run(run);
  CHECK(json["runs"][0]["requested_step"] == 0.05);
  CHECK(json["runs"][1]["tol"] == 1e-7);
  REQUIRE(json["drifts"].size() == 2 * json["runs"][0]["invariants"].size());
  for (const Json& drift : json["drifts"]) {
    CHECK(keys_of(drift) == Keys{"scene", "integrator", "step", "tol", "invariant", "max_drift",
                                 "oscillation", "slope", "slope_error", "growth", "verdict"});
    CHECK(json["runs"][0]["invariants"].contains(drift["invariant"].get<std::string>()));
    CHECK(drift["max_drift"] >= 0.0);
  }
}

TEST_CASE("cli: list and doctor print nothing but JSON with --json -", "[cli]") {
  const Json list = json_of({"list"});
  CHECK(keys_of(list) == Keys{"gnomon", "command", "scenes", "models", "integrators"});
  CHECK(list["scenes"].size() >= 10);
  const Keys integrator{"name",
                        "family",
                        "form",
                        "stepping",
                        "orders",
                        "stages",
                        "reversible",
                        "conserves_energy",
                        "conserves_momentum",
                        "negative_control",
                        "models",
                        "summary",
                        "citation"};
  for (const Json& each : list["integrators"]) CHECK(keys_of(each) == integrator);
  const Json doctor = json_of({"doctor"});
  CHECK(keys_of(doctor) == Keys{"gnomon", "command", "environment", "findings"});
  CHECK(doctor["findings"].size() >= 3);
}

TEST_CASE("cli: compare writes its tables and figures of every scene and leaves nothing else", "[cli]") {
  const TemporaryFolder folder;
  write_text(folder.path() / "a.toml", free_top);
  write_text(folder.path() / "b.toml", symmetric_top);
  const Outcome outcome = run_program(
      {"compare", "a.toml", "b.toml", "--integrators", "rkmk4,cvode-adams", "--steps", "0.1,0.05", "--tols",
       "1e-4,1e-6", "--out", "new/results", "--json", "all.json", "--csv", "all.csv", "--quiet"},
      folder.path());
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK(outcome.err.empty());
  CHECK(folder.entries() == 5);
  Keys found, expected;
  for (const auto& entry : fs::directory_iterator(folder.path() / "new" / "results"))
    found.insert(entry.path().filename().string());
  for (const std::string scene : {"free", "symmetric"})
    for (const char* suffix : {".md", ".csv", ".json", ".svg", ".png"})
      expected.insert("compare-" + scene + suffix);
  CHECK(found == expected);
  for (const std::string& name : found) {
    CHECK(outcome.out.find("wrote new/results/" + name + "\n") != std::string::npos);
    const std::string content = content_of(folder.path() / "new" / "results" / name);
    INFO(name);
    if (name.ends_with(".md")) CHECK(content.find("| rkmk4 ") != std::string::npos);
    if (name.ends_with(".csv")) CHECK(content.starts_with("integrator,step_s,tol,"));
    if (name.ends_with(".csv")) CHECK(std::count(content.begin(), content.end(), '\n') == 1 + 4);
    if (name.ends_with(".svg")) CHECK(content.find("<svg") != std::string::npos);
    if (name.ends_with(".png")) CHECK(content.starts_with("\x89PNG\r\n"));
    if (!name.ends_with(".json")) continue;
    const Json json = Json::parse(content);
    check_document(json, "compare");
    CHECK(json["scenes"].size() == 1);
    CHECK(json["runs"].size() == 4);
    for (const Json& run : json["runs"]) {
      check_run(run);
      CHECK(run["cpu_seconds"].is_object());
    }
  }
  const Json all = Json::parse(content_of(folder.path() / "all.json"));
  check_document(all, "compare");
  CHECK(all["scenes"].size() == 2);
  CHECK(all["runs"].size() == 8);
}

TEST_CASE("cli: a run that was asked for by name and failed gives exit code 1 and is recorded", "[cli]") {
  struct Case {
    Words arguments;
    std::string status;
  };
  for (const Case& each :
       {Case{{"run", "asymmetric-free-top", "--integrator", "rkmk4", "--step", "0.01", "--max-steps", "10"},
             "step_limit"},
        Case{
            {"run", "asymmetric-free-top", "--integrator", "cvode-bdf", "--tol", "1e-9", "--max-steps", "10"},
            "step_limit"},
        Case{{"run", "asymmetric-free-top", "--integrator", "ida-bdf-index2", "--tol", "1e-9", "--max-steps",
              "2000"},
             "step_limit"},
        Case{
            {"run", "asymmetric-free-top", "--integrator", "rkmk4", "--step", "1e-8", "--time-limit", "0.05"},
            "time_limit"},
        Case{{"run", "fast-heavy-top", "--integrator", "rkmk4", "--step", "1"}, "diverged"}}) {
    const Json json = json_of(each.arguments, 1);
    const Json& run = json["runs"][0];
    check_run(run);
    CHECK(run["status"] == each.status);
    CHECK(run["error"].is_null());
    CHECK(run["cpu_seconds"].is_null());
    CHECK(run["t"] < json["scenes"][0]["t_end"]);
  }
}

TEST_CASE("cli: failures count where integrators are named and are rows where they are not", "[cli]") {
  const Words plain{"converge",  "asymmetric-free-top", "--steps", "0.1,0.01",       "--tols",
                    "1e-3,1e-9", "--max-steps",         "150",     "--no-reference", "--quiet"};
  Words named = plain;
  named.insert(named.end(), {"--integrators", "rkmk4"});
  named.erase(named.begin() + 4, named.begin() + 6);
  const Json by_name = json_of(named, 1);
  REQUIRE(by_name["runs"].size() == 2);
  CHECK(by_name["runs"][0]["status"] == "ok");
  CHECK(by_name["runs"][1]["status"] == "step_limit");
  const Json by_default = json_of(plain, 0);
  int failed = 0;
  for (const Json& run : by_default["runs"]) {
    check_run(run);
    failed += run["status"] != "ok";
  }
  CHECK(failed >= 4);

  const TemporaryFolder folder;
  const Outcome outcome = run_program(named, folder.path());
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.err ==
        "gnomon: asymmetric-free-top / rkmk4, step 0.01: step_limit: reached --max-steps 150\n");
}

TEST_CASE("cli: an interrupted command gives exit code 3 and keeps what was finished", "[cli]") {
  for (const std::string command : {"converge", "compare"}) {
    const TemporaryFolder folder;
    Call call(
        {command, "asymmetric-free-top", "asymmetric-heavy-top", "--integrators", "rkmk4", "--steps",
         "0.1,1e-8", "--max-steps", "10000000000", "--no-reference", "--json", "out.json", "--out", "out"},
        folder.path());
    // The first run takes microseconds and the second one minutes.
    call.await_error_output("rkmk4  step 0.1\n");
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    call.interrupt();
    const Outcome outcome = call.wait();
    INFO(command << "\n" << outcome.err);
    CHECK(outcome.exit_code == 3);
    CHECK(outcome.err.ends_with("gnomon: interrupted; what was finished is kept\n"));
    CHECK(folder.entries() == 2);
    for (const fs::path& file :
         {folder.path() / "out.json", folder.path() / "out" / (command + "-asymmetric-free-top.json")}) {
      const Json json = Json::parse(content_of(file));
      check_document(json, command);
      REQUIRE(json["runs"].size() == 2);
      check_run(json["runs"][0]);
      CHECK(json["runs"][0]["status"] == "ok");
      CHECK(json["runs"][0]["t"] == 10.0);
      CHECK(json["runs"][1]["status"] == "interrupted");
      CHECK(json["runs"][1]["t"] < 10.0);
    }
  }
}

TEST_CASE("cli: --json FILE replaces the file as a whole and leaves no other", "[cli]") {
  const TemporaryFolder folder;
  write_text(folder.path() / "out.json", std::string(1'000'000, 'x'));
  const Outcome outcome = run_program({"run", "asymmetric-free-top", "--integrator", "rkmk4", "--step", "0.1",
                                       "--no-timing", "--samples", "10", "--json", "out.json", "--csv", "-"},
                                      folder.path());
  REQUIRE(outcome.exit_code == 0);
  CHECK(folder.entries() == 1);
  check_run(Json::parse(content_of(folder.path() / "out.json"))["runs"][0], 10);
  // With --csv - standard output holds the series and nothing else.
  CHECK(outcome.out.starts_with("t_s,orientation_0,"));
  CHECK(std::count(outcome.out.begin(), outcome.out.end(), '\n') == 1 + 11);
}
