// Exit codes and the files that a command leaves.
#include "tests/cli/document.hpp"

namespace fs = std::filesystem;
using namespace gnomon::test;
using namespace gnomon::test::cli;

TEST_CASE("cli: compare writes its tables and figures of every scene and leaves nothing else", "[cli]") {
  const TemporaryFolder folder;
  write_text(folder.path() / "a.toml", free_top);
  write_text(folder.path() / "b.toml", symmetric_top);
  const Outcome outcome =
      run_program({"compare", "a.toml", "b.toml", "--integrators", "rkmk4,cvode-adams", "--steps", "0.1,0.05",
                   "--tols", "1e-4,1e-6", "--out", "new/results", "--json", "all.json", "--csv", "all.csv",
                   "--latex", "all.tex", "--quiet"},
                  folder.path());
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK(outcome.err.empty());
  CHECK(folder.entries() == 6);
  CHECK(content_of(folder.path() / "all.tex").find("\\begin{tabular}") != std::string::npos);
  Keys found, expected;
  for (const auto& entry : fs::directory_iterator(folder.path() / "new" / "results"))
    found.insert(entry.path().filename().string());
  for (const std::string scene : {"free", "symmetric"})
    for (const char* suffix : {".md", ".csv", ".tex", ".json", ".svg", ".png", ".pdf"})
      expected.insert("compare-" + scene + suffix);
  CHECK(found == expected);
  for (const std::string& name : found) {
    CHECK(outcome.out.find("wrote new/results/" + name + "\n") != std::string::npos);
    const std::string content = content_of(folder.path() / "new" / "results" / name);
    INFO(name);
    if (name.ends_with(".md")) CHECK(content.find("| rkmk4 ") != std::string::npos);
    if (name.ends_with(".tex")) CHECK(content.find("\\toprule") != std::string::npos);
    if (name.ends_with(".pdf")) CHECK(content.starts_with("%PDF-"));
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
  CHECK(all["costs"].size() == 2 * 2 * 11);
  for (const Json& cost : all["costs"]) {
    CHECK(keys_of(cost) == Keys{"scene", "integrator", "metric", "error", "cpu_seconds", "rhs", "upper_bound",
                                "few_settings"});
    CHECK(cost["cpu_seconds"].is_null() == cost["rhs"].is_null());
  }
  // Errors of two settings are known: what lies between them costs something between, what is looser no more
  // than the first, what is tighter is not reached.
  const auto error = [&](std::size_t k) { return all["runs"][k]["error"]["orientation"].get<double>(); };
  CHECK(error(0) > error(1));
  for (const Json& cost : all["costs"]) {
    if (cost["scene"] != "free" || cost["integrator"] != "rkmk4") continue;
    const double level = cost["error"];
    INFO(cost.dump());
    CHECK(cost["rhs"].is_null() == (level < error(1)));
    if (cost["rhs"].is_null()) continue;
    CHECK(cost["upper_bound"]["rhs"] == (level >= error(0)));
    CHECK(cost["rhs"] >= all["runs"][0]["cost"]["rhs"]);
    CHECK(cost["rhs"] <= all["runs"][1]["cost"]["rhs"]);
  }
  // The front of each scene: every run off it is beaten by one on it.
  for (const Json& run : all["runs"]) {
    bool beaten = false;
    for (const Json& other : all["runs"])
      beaten = beaten || (other["scene"] == run["scene"] && other["pareto"]["rhs"] == true &&
                          other["error"]["orientation"] <= run["error"]["orientation"] &&
                          other["cost"]["rhs"] < run["cost"]["rhs"]);
    CHECK(run["pareto"]["rhs"] == !beaten);
  }
}

TEST_CASE("cli: compare over one parameter shows what errors cost at its values", "[cli]") {
  const TemporaryFolder folder;
  write_text(folder.path() / "a.toml", free_top);
  const Outcome outcome =
      run_program({"compare", "a.toml", "--integrators", "rkmk4", "--steps", "0.1,0.05,0.025,0.0125",
                   "--vary", "body.angular_momentum=[1.8, 0.4, -0.9],[3.6,0.8,-1.8]", "--no-timing", "--out",
                   "out", "--json", "all.json", "--quiet"},
                  folder.path());
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  const Json json = Json::parse(content_of(folder.path() / "all.json"));
  REQUIRE(json["scenes"].size() == 2);
  CHECK(json["scenes"][1]["name"] == "free[body.angular_momentum=[3.6,0.8,-1.8]]");
  CHECK(json["scenes"][1]["body"]["angular_momentum"] == Json({3.6, 0.8, -1.8}));
  CHECK(json["runs"][4]["scene"] == json["scenes"][1]["name"]);
  // At twice the speed the same step is 16 times as wrong, to the leading order.
  const double ratio = json["runs"][7]["error"]["orientation"].get<double>() /
                       json["runs"][3]["error"]["orientation"].get<double>();
  CHECK(ratio > 16.0);
  CHECK(ratio < 64.0);
  const std::string table = content_of(folder.path() / "out" / "compare-free-by-body.angular_momentum.md");
  CHECK(table.find("| [1.8, 0.4, -0.9] | (rates) | [3.6,0.8,-1.8] | (rates) |") != std::string::npos);
  CHECK(fs::exists(folder.path() / "out" / "compare-free-by-body.angular_momentum.svg"));
  CHECK(fs::exists(folder.path() / "out" / "compare-free-body.angular_momentum=-3.6-0.8--1.8.csv"));
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
        Case{{"run", "asymmetric-free-top", "--integrator", "ida-bdf-index2", "--tol", "1e-6"},
             "solver_failed"},
        Case{
            {"run", "asymmetric-free-top", "--integrator", "rkmk4", "--step", "1e-8", "--time-limit", "0.05"},
            "time_limit"}}) {
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

TEST_CASE("cli: CSV on standard output leaves its flags to standard error", "[cli]") {
  const TemporaryFolder folder;
  write_text(folder.path() / "a.toml", free_top);
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"run",     "a.toml", "--integrator",   "rkmk4",       "--step", "3",
                                   "--t-end", "10",     "--no-reference", "--no-timing", "--csv",  "-"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words, folder.path());
  };
  const Outcome fewer = run({"--samples", "7"});
  CHECK(fewer.exit_code == 0);
  CHECK(std::count(fewer.out.begin(), fewer.out.end(), '\n') == 1 + 5);
  CHECK(fewer.err ==
        "gnomon: flag: samples are taken at the nearest steps\n"
        "gnomon: found 5 states to keep in 4 steps, asked for were 8\n");
  CHECK(run({"--samples", "7", "--quiet"}).err.empty());
  CHECK(run({"--samples", "3"}).err == "gnomon: flag: samples are taken at the nearest steps\n");
  CHECK(run({"--samples", "4"}).err.empty());
}
