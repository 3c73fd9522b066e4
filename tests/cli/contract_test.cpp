// The JSON of the commands and what the options mean.
#include <map>

#include "src/scene.hpp"
#include "tests/cli/document.hpp"
#include "tests/support/scenes.hpp"

namespace fs = std::filesystem;
using namespace gnomon::test;
using namespace gnomon::test::cli;

TEST_CASE("cli: the JSON of a run has the documented keys and types", "[cli]") {
  struct Case {
    std::string scene, integrator, option, value;
  };
  for (const Case& each :
       {Case{"asymmetric-free-top", "rkmk4", "--step", "0.1"},
        Case{"symmetric-free-top", "cvode-adams", "--tol", "1e-6"},
        Case{"kovalevskaya", "munjiza", "--step", "0.02"}, Case{"space-moment", "ida-bdf", "--tol", "1e-5"},
        Case{"body-moment", "munjiza-stage-moments", "--step", "0.05"}}) {
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
  // In doubles 0.3/0.1 and 0.7/0.1 fall just below a whole number and 2.1/0.3 just above.
  for (const Case& each :
       {Case{"0.3", "0.1", 3}, Case{"0.7", "0.1", 7}, Case{"2.1", "0.3", 7}, Case{"1", "0.3", 4},
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
  std::map<std::string, int> runs;
  for (const Json& run : json["runs"]) {
    check_run(run);
    ++runs[run["integrator"]];
  }
  CHECK(runs.size() == 3);
  CHECK(runs["munjiza"] >= 8);
  CHECK(runs["rkmk4"] == runs["munjiza"]);
  CHECK(runs["cvode-bdf"] >= 8);
  // Adaptive integrators have no order to observe.
  REQUIRE(json["orders"].size() == 4);
  for (const Json& order : json["orders"]) {
    INFO(order.dump(1));
    CHECK(keys_of(order) == Keys{"scene", "integrator", "metric", "observed", "interval", "expected",
                                 "points", "verdict", "finding", "dropped", "floor", "floor_kind"});
    CHECK(order["finding"] == "as declared");
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

TEST_CASE("cli: a loose Newton tolerance is no floor, as each step has a correction at least", "[cli]") {
  const Json json = json_of({"converge", "soft-beam", "--integrators", "beam-generalized-alpha", "--t-end",
                             "0.5", "--newton-tol", "1e-2", "--no-timing", "--quiet"});
  REQUIRE(json["orders"].size() == 4);
  for (const Json& order : json["orders"]) {
    INFO(order.dump(1));
    CHECK(order["floor"].is_null());
    CHECK(order["floor_kind"].is_null());
    CHECK(std::abs(order["observed"].get<double>() - 2.0) <= 0.1);
  }
}

TEST_CASE("cli: no order is given where there are fewer than four points", "[cli]") {
  const Json json = json_of(
      {"converge", "asymmetric-free-top", "--integrators", "rkmk4", "--steps", "0.1,0.05,0.025", "--quiet"});
  REQUIRE(json["orders"].size() == 2);
  for (const Json& order : json["orders"]) {
    CHECK(order["observed"].is_null());
    CHECK(order["finding"] == "none");
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
                                 "oscillation", "slope", "slope_error", "growth", "verdict",
                                 "undecided_because", "h_scaling", "h_scaling_of"});
    CHECK(json["runs"][0]["invariants"].contains(drift["invariant"].get<std::string>()));
    CHECK(drift["max_drift"] >= 0.0);
    CHECK(drift["h_scaling"].is_null());  // one step
    CHECK(drift["h_scaling_of"].is_null());
  }
}

TEST_CASE("cli: drift shows errors before the end, those of the same run that ends there", "[cli]") {
  const Json json = json_of({"drift", "asymmetric-heavy-top", "--integrators", "rkmk4,cvode-adams", "--step",
                             "0.02", "--tol", "1e-7", "--t-end", "4", "--error-at", "2,1", "--quiet"});
  check_document(json, "drift");
  for (const Json& run : json["runs"]) CHECK(run["error"].is_null());
  for (const Json& drift : json["drifts"]) {
    REQUIRE(drift["error_before"].size() == 2);
    const bool fixed = drift["integrator"] == "rkmk4";
    for (std::size_t k = 0; k < 2; ++k) {
      const Json& before = drift["error_before"][k];
      CHECK(keys_of(before) == Keys{"t", "reference", "error_bound", "error", "below_bound"});
      CHECK(before["t"] == (k == 0 ? 1.0 : 2.0));
      CHECK(before["reference"] == "certified");
      CHECK(before["error_bound"]["orientation"] <= 1e-12);
      CHECK(before["below_bound"]["orientation"] == false);
      const Json own = json_of({"run", "asymmetric-heavy-top", "--integrator", drift["integrator"],
                                fixed ? "--step" : "--tol", fixed ? "0.02" : "1e-7", "--t-end",
                                k == 0 ? "1" : "2", "--quiet"});
      CHECK(before["error"]["orientation"] == own["runs"][0]["error"]["orientation"]);
      if (drift["invariant"] != "energy") break;
    }
  }
}

TEST_CASE("cli: drift shows the errors of a run before it failed, and where they are below the bound",
          "[cli]") {
  const Json failing = json_of({"drift", "spaghetti-free-flight", "--integrators", "beam-trapezoidal",
                                "--step", "0.5", "--t-end", "20", "--error-at", "2,15", "--quiet"},
                               1);
  CHECK(failing["runs"][0]["status"] == "newton_failed");
  CHECK(failing["runs"][0]["t"] == 11.5);
  const Json& before = failing["drifts"][0]["error_before"];
  REQUIRE(before.size() == 2);
  CHECK(before[0]["error"]["displacement"] >= 1e-3);
  CHECK(before[1]["reference"] == "certified");
  CHECK(before[1]["error"].is_null());

  const Json exact = json_of(
      {"drift", "asymmetric-free-top", "--integrators", "exact-free-top", "--error-at", "2,10", "--quiet"});
  const Json& early = exact["drifts"][0]["error_before"];
  REQUIRE(early.size() == 1);  // the other one is the end
  CHECK(early[0]["reference"] == "analytic");
  CHECK(early[0]["below_bound"]["orientation"] ==
        (early[0]["error"]["orientation"] == early[0]["error_bound"]["orientation"]));
  CHECK(early[0]["error"]["orientation"] >= early[0]["error_bound"]["orientation"]);
  CHECK(exact["runs"][0]["error"]["orientation"].is_number());
}

TEST_CASE("cli: bounded energy drift of lie-verlet on a heavy top falls as h^2", "[cli]") {
  const Json json = json_of({"drift", "off-axis-heavy-top", "--integrators", "lie-verlet", "--steps",
                             "0.02,0.01,0.005", "--t-end", "50", "--quiet", "--no-reference"});
  int energies = 0;
  for (const Json& drift : json["drifts"]) {
    if (drift["invariant"] != "energy") continue;
    ++energies;
    INFO(drift.dump(1));
    CHECK(drift["h_scaling_of"] == "max_drift");
    REQUIRE(drift["h_scaling"].is_number());
    CHECK(std::abs(drift["h_scaling"].get<double>() - 2.0) <= 0.1);
  }
  CHECK(energies == 3);
}

TEST_CASE("cli: drift at several steps shows how each run ended", "[cli]") {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program({"drift", "free-flight", "--integrators", "beam-midpoint,beam-energy-momentum", "--steps",
                   "0.5,10", "--t-end", "40", "--no-reference", "--quiet", "--csv", "runs.csv", "--json",
                   "all.json", "--out", "out"},
                  folder.path());
  INFO(outcome.err);
  // A run that was asked for by name failed.
  CHECK(outcome.exit_code == 1);
  const std::string csv = content_of(folder.path() / "runs.csv");
  CHECK(csv.starts_with("integrator,setting,energy_max_drift,energy_verdict,linear_momentum_max_drift,"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + 4);
  CHECK(csv.find("beam-midpoint,step 10,") != std::string::npos);
  const Json json = Json::parse(content_of(folder.path() / "all.json"));
  REQUIRE(json["runs"].size() == 4);
  CHECK(json["runs"][0]["status"] == "ok");
  CHECK(json["runs"][1]["status"] == "newton_failed");
  CHECK(json["runs"][1]["t"] < 40.0);
  CHECK(json["runs"][3]["status"] == "ok");
  CHECK(json["runs"][3]["requested_step"] == 10.0);
  CHECK(json["drifts"].size() == 4 * 3);
  CHECK(json["drifts"][3]["verdict"] == "failed");
  CHECK(content_of(folder.path() / "out" / "drift-free-flight.md").find("Runs by step") != std::string::npos);
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

TEST_CASE("cli: the options of a run are recorded where its integrator uses them", "[cli]") {
  const auto options = [](const Words& arguments) {
    Words words{"run"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    for (const char* word : {"--t-end", "0.1", "--no-reference", "--no-timing"}) words.emplace_back(word);
    return json_of(words)["runs"][0]["options"];
  };
  const Json none = options({"space-moment", "--integrator", "rkmk4", "--step", "0.05"});
  CHECK(keys_of(none) == Keys{"newton_tol", "spectral_radius", "modified_newton", "linear_solver"});
  for (const Json& each : none) CHECK(each.is_null());
  for (const Json& each : options({"soft-beam", "--integrator", "beam-verlet", "--step", "0.001"}))
    CHECK(each.is_null());
  // Scripts give it to all implicit schemes.
  CHECK(options({"space-moment", "--integrator", "implicit-midpoint", "--step", "0.05", "--newton-tol",
                 "1e-9"})["newton_tol"]
            .is_null());
  const Json midpoint = options({"soft-beam", "--integrator", "beam-midpoint", "--step", "0.05",
                                 "--newton-tol", "1e-9", "--linear-solver", "klu"});
  CHECK(midpoint["newton_tol"] == 1e-9);
  CHECK(midpoint["spectral_radius"].is_null());
  CHECK(midpoint["modified_newton"] == false);
  CHECK(midpoint["linear_solver"] == "klu");
  const Json hht = options({"soft-beam", "--integrator", "beam-hht", "--step", "0.05", "--modified-newton",
                            "--spectral-radius", "0.7"});
  CHECK(hht["newton_tol"] == 1e-10);
  CHECK(hht["spectral_radius"] == 0.7);
  CHECK(hht["modified_newton"] == true);
  CHECK(hht["linear_solver"].is_null());
}

TEST_CASE("cli: list names the loads that scenes may have", "[cli]") {
  const Json models = json_of({"list", "models"})["models"];
  const auto summary = [&](const std::string& name) -> std::string {
    for (const Json& each : models)
      if (each["name"] == name) return each["summary"];
    return "";
  };
  CHECK(summary("rigid_body")
            .ends_with("; loads: none, gravity, space_moment, body_moment, attitude_potential"));
  CHECK(summary("rigid_body_ensemble").ends_with("; loads: none, space_moment, gravity"));
}
