// `gnomon bench` and `gnomon report`: a study that is killed and goes on, and its tables from the store
// alone.
#include <algorithm>
#include <random>

#include "tests/cli/document.hpp"

namespace fs = std::filesystem;
using namespace gnomon::test;
using namespace gnomon::test::cli;

namespace {

constexpr const char* small_study = R"(
converge = ["asymmetric-free-top", "asymmetric-heavy-top"]
quick_converge = ["asymmetric-free-top"]
integrators = ["munjiza", "rkmk4"]
[[drift]]
scene = "symmetric-free-top"
t_end = 50.0
quick_t_end = 20.0
step  = 0.05
tol   = 1e-6
error_times = [5.0, 10.0, 30.0]
integrators = ["munjiza", "cvode-adams"]
)";
constexpr std::size_t small_runs = 2 * 17 + 3 * 2;

struct StudyFolder {
  TemporaryFolder folder;
  fs::path out = folder.path() / "out";
  explicit StudyFolder(const std::string& study = small_study) {
    write_text(folder.path() / "mine.toml", study);
  }
  Words words(const Words& more = {}) const {
    Words all{"bench", "--study", "mine.toml", "--quick", "--out", "out"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Outcome bench(const Words& more = {}) const { return run_program(words(more), folder.path()); }
  std::string file(const std::string& name) const { return content_of(out / name); }
  std::vector<std::string> lines() const {
    std::vector<std::string> list;
    std::istringstream text(file("runs.jsonl"));
    for (std::string line; std::getline(text, line);) list.push_back(line);
    return list;
  }
  std::map<std::string, std::string> files(const Words& names) const {
    std::map<std::string, std::string> contents;
    for (const std::string& name : names) contents[name] = file(name);
    return contents;
  }
  /// Keys of the runs, sorted.
  Words keys() const {
    Words all;
    for (const std::string& line : lines()) {
      const Json record = Json::parse(line);
      if (record["kind"] == "run") all.push_back(record["key"]);
    }
    std::sort(all.begin(), all.end());
    return all;
  }
};

bool says(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

/// Nothing but the store is left; the report makes the same files again and leaves the store alone.
void check_report(const StudyFolder& study, const Words& names) {
  const auto before = study.files(names);
  for (const fs::directory_entry& each : fs::directory_iterator(study.out))
    if (each.path().filename() != "runs.jsonl") fs::remove(each.path());
  const std::string store = study.file("runs.jsonl");
  const Outcome report = run_program({"report", "out"}, study.folder.path());
  INFO(report.err);
  CHECK(report.exit_code == 0);
  CHECK(report.err.empty());
  CHECK(study.file("runs.jsonl") == store);
  for (const std::string& name : names) {
    INFO(name);
    CHECK(study.file(name) == before.at(name));
  }
}

const Words table_files{"converge-asymmetric-free-top.md",
                        "converge-asymmetric-free-top.csv",
                        "mine-orders.md",
                        "drift-symmetric-free-top.md",
                        "drift-symmetric-free-top.csv",
                        "converge-asymmetric-free-top.json",
                        "drift-symmetric-free-top.json",
                        "report.html",
                        "README.md"};

}  // namespace

TEST_CASE("bench: a study of one's own is measured once, and reported from the store alone", "[cli][store]") {
  const StudyFolder study;
  const Outcome first = study.bench();
  INFO(first.err);
  REQUIRE(first.exit_code == 0);
  const Words keys = study.keys();
  CHECK(keys.size() == small_runs);
  CHECK(std::adjacent_find(keys.begin(), keys.end()) == keys.end());
  for (const std::string& name : table_files) CHECK(fs::exists(study.out / name));
  // The errors that the plan asks for, up to the end of the quick study.
  const std::string drifts = study.file("drift-symmetric-free-top.csv");
  CHECK(says(drifts.substr(0, drifts.find('\n')), "verdict,error_at_5_s,error_at_10_s,status"));
  CHECK(says(study.file("drift-symmetric-free-top.md"), "--error-at 5,10 "));
  for (const std::string& line : study.lines()) CHECK(Json::accept(line));

  const std::string store = study.file("runs.jsonl");
  check_report(study, table_files);

  // A second call measures nothing; --fresh measures all.
  const Outcome second = study.bench();
  CHECK(second.exit_code == 0);
  CHECK(says(second.err, "known already"));
  CHECK(study.keys() == keys);
  const auto lines = static_cast<std::size_t>(std::count(store.begin(), store.end(), '\n'));
  CHECK(study.lines().size() == lines + 1);  // one more session
  const Outcome fresh = study.bench({"--fresh"});
  CHECK(says(fresh.err, "put aside in runs.previous.jsonl"));
  CHECK(study.keys() == keys);
  CHECK(says(study.file("runs.previous.jsonl"), store));
  CHECK_FALSE(says(study.file("runs.jsonl"), store));
}

TEST_CASE("bench: errors in space of equilibria, and their report from the store alone", "[cli][store]") {
  const StudyFolder study(
      "[[refine]]\nlabel = \"tip\"\nscene = \"elastica\"\nrow_key = \"beam.order\"\nrow_values = [1, 2]\n"
      "key = \"beam.elements\"\nvalues = [4, 8, 16, 32]\nprobe = \"end\"\ncomponents = [\"x\", \"z\"]\n"
      "reference = [\"beam.order=4\", \"beam.elements=24\"]\ncoarser = [\"beam.order=4\", "
      "\"beam.elements=16\"]\norders = [2, 4]\n");
  const Outcome first = study.bench();
  INFO(first.err);
  REQUIRE(first.exit_code == 0);
  const Json document = Json::parse(study.file("refine-tip.json"))["static_refine"];
  REQUIRE(document["orders"].size() == 2);
  CHECK(std::abs(document["orders"][0]["observed"].get<double>() - 2.0) <= 0.1);
  CHECK(document["errors"].size() == 8);
  check_report(study,
               {"refine-tip.md", "refine-tip.csv", "refine-tip.json", "refine-tip.tex", "report.html"});
}

TEST_CASE("bench: a study whose file has been moved or changed is reported as it was made", "[cli][store]") {
  const std::string drift =
      "[[drift]]\nlabel = \"mine-own\"\nscene = \"symmetric-free-top\"\nt_end = 5.0\nquick_t_end = 5.0\n"
      "step = 0.05\nintegrators = [\"munjiza\"]\n";
  const StudyFolder study("# \xc3\xa4 \"quoted\"\\\n" + drift);
  REQUIRE(study.bench().exit_code == 0);
  const fs::path file = study.folder.path() / "mine.toml";
  fs::remove(file);
  const Words files{"drift-mine-own.md", "drift-mine-own.csv", "README.md", "report.html"};
  check_report(study, files);
  // What stands there meanwhile is another study, and none that could be made.
  write_text(file, "[[drift]]\n");
  check_report(study, files);
  CHECK(study.bench().exit_code == 2);
  write_text(file, drift + "[[drift]]\nlabel = \"another\"\n" + drift.substr(drift.find("scene")));
  check_report(study, files);
  REQUIRE(study.bench().exit_code == 0);
  CHECK(fs::exists(study.out / "drift-another.md"));
  fs::remove(file);
  check_report(study, {"drift-another.md", "drift-mine-own.csv"});
}

TEST_CASE("bench: the scorecard comes first, from the store alone too", "[cli][store][long]") {
  const StudyFolder study(
      "quick_scorecard = [\"asymmetric-free-top\", \"space-moment\"]\n"
      "quick_converge = [\"space-moment\"]\nintegrators = [\"munjiza\", \"rkmk4\"]\n");
  const Outcome first = study.bench({"--jobs", "2"});
  INFO(first.err);
  REQUIRE(first.exit_code == 0);
  Words files{"report.html", "README.md"};
  for (const char* stem : {"mine-scorecard", "scorecard-asymmetric-free-top", "scorecard-space-moment"})
    for (const char* ending : {".md", ".csv", ".tex", ".json"}) files.push_back(std::string(stem) + ending);
  auto before = study.files(files);
  CHECK(says(before["mine-scorecard.md"], "| munjiza "));
  const Json json = Json::parse(before["mine-scorecard.json"]);
  CHECK(json["scorecard"].size() == 4);
  // On the page and in the index before anything else.
  const std::string& page = before["report.html"];
  CHECK(page.find("<h3>Scorecard, mine</h3>") < page.find("<h3>How the runs ended</h3>"));
  CHECK(says(page, "<table class=\"sortable\">"));
  CHECK(before["README.md"].find("## Scorecard") < before["README.md"].find("## Order of convergence"));

  check_report(study, files);
  // Nothing is measured twice, whatever the number of runs at a time.
  const Words keys = study.keys();
  const Outcome again = study.bench({"--jobs", "1"});
  CHECK(again.exit_code == 0);
  CHECK(study.keys() == keys);
}

TEST_CASE("bench: a study without times is reported without them", "[cli][store]") {
  const StudyFolder study(
      "quick_compare = [\"asymmetric-free-top\"]\nintegrators = [\"munjiza\"]\n"
      "[[speed]]\nscene = \"asymmetric-free-top\"\nstep = 0.01\nsteps = 10\n");
  const Outcome first = study.bench({"--no-timing"});
  INFO(first.err);
  REQUIRE(first.exit_code == 0);
  CHECK_FALSE(fs::exists(study.out / "mine-speed.md"));
  CHECK(says(study.file("README.md"), "--no-timing"));
  check_report(study, {"compare-asymmetric-free-top.md", "report.html", "README.md"});
}

TEST_CASE("bench: a study killed again and again is finished by the next calls", "[cli][store]") {
  const StudyFolder whole, killed;
  REQUIRE(whole.bench().exit_code == 0);
  std::mt19937 random(7);
  std::size_t last = 0;
  for (std::size_t attempt = 1; attempt <= 4; ++attempt) {
    {
      Call call(killed.words({"--quiet"}), killed.folder.path());
      const std::size_t wanted = 7 * attempt + random() % 3;
      for (int wait = 0; wait < 20000; ++wait) {
        if (fs::exists(killed.out / "runs.jsonl") && killed.lines().size() >= wanted) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      // The end of the scope is a kill -9.
    }
    const std::vector<std::string> lines = killed.lines();
    CHECK(lines.size() >= std::max<std::size_t>(last, 7 * attempt));
    for (std::size_t k = 0; k + 1 < lines.size(); ++k) CHECK(Json::accept(lines[k]));
    last = lines.size() - 1;
    // A line that a kill has cut off.
    std::ofstream(killed.out / "runs.jsonl", std::ios::app) << "{\"key\":\"12";
  }
  const Outcome end = killed.bench();
  INFO(end.err);
  CHECK(end.exit_code == 0);
  CHECK(says(end.err, "the last line is cut off and ignored"));
  CHECK(killed.keys() == whole.keys());
  for (const char* name :
       {"converge-asymmetric-free-top.csv", "mine-orders.csv", "drift-symmetric-free-top.csv"})
    CHECK(killed.file(name) == whole.file(name));
}

TEST_CASE("bench: an interruption keeps what is finished", "[cli][store]") {
  const StudyFolder study(
      "[[drift]]\nscene = \"asymmetric-free-top\"\nt_end = 1.0\nquick_t_end = 20.0\nstep = 0.05\ntol = 1e-6\n"
      "integrators = [\"munjiza\"]\n"
      "[[drift]]\nscene = \"symmetric-free-top\"\nt_end = 1.0\nquick_t_end = 1e9\nstep = 0.001\ntol = 1e-6\n"
      "integrators = [\"munjiza\"]\n");
  Call call(study.words(), study.folder.path());
  for (int wait = 0; wait < 20000; ++wait) {
    if (fs::exists(study.out / "drift-asymmetric-free-top.md")) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  call.interrupt();
  const Outcome outcome = call.wait();
  INFO(outcome.err);
  CHECK(outcome.exit_code == 3);
  CHECK(says(outcome.err, "interrupted; what was measured is kept in out/runs.jsonl"));
  CHECK(study.keys().size() == 1);
  CHECK_FALSE(fs::exists(study.out / "drift-symmetric-free-top.md"));

  // What is not in the store is said, and the rest reported.
  const Outcome report = run_program({"report", "out"}, study.folder.path());
  CHECK(report.exit_code == 0);
  CHECK(says(report.err, "gnomon: drift-symmetric-free-top: its measurements are not in the store"));
  CHECK(says(study.file("report.html"), "drift-asymmetric-free-top"));
}

TEST_CASE("bench: a store without a session, or none, is refused", "[cli][store]") {
  const TemporaryFolder folder;
  const auto refusal = [&](const Words& words) {
    const Outcome outcome = run_program(words, folder.path());
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.out.empty());
    return outcome.err;
  };
  CHECK(refusal({"report"}) ==
        "gnomon: report: found 0 folders, expected one that `gnomon bench` has written\n");
  CHECK(refusal({"report", "none"}) ==
        "gnomon: none: found no runs.jsonl, expected a folder that `gnomon bench` has written\n");
  write_text(folder.path() / "runs.jsonl", "{\"key\":\"1\",\"kind\":\"run\"}\n");
  CHECK(refusal({"report", "."}) ==
        "gnomon: ./runs.jsonl: found no session of `gnomon bench`, expected one\n");
  write_text(folder.path() / "runs.jsonl", "{\"key\":\"1\",\"kind\":\"session\",\"code\":7}\n");
  CHECK(says(refusal({"report", "."}), "found a session of another version of gnomon"));
  CHECK(says(refusal({"bench", "--study", "none.toml", "--out", "new"}), "none.toml"));
  CHECK(folder.entries() == 1);
}

TEST_CASE("bench: a part over one parameter has a column for each value", "[cli][store]") {
  const StudyFolder study(R"(
[[vary]]
label  = "spin"
scene  = "asymmetric-free-top"
key    = "body.angular_momentum"
values = [[1.8, 0.4, -0.9], [1.8, 0.4, 0.0]]
steps  = [0.05]
integrators = ["rkmk4", "exact-free-top"]
[[vary]]
label  = "largest"
what   = "stability"
scene  = "free-flight"
t_end  = 4.0
key    = "beam.EA"
values = [1e4, 1e6]
integrators = ["beam-verlet"]
[[vary]]
label  = "later"
scene  = "asymmetric-free-top"
key    = "body.angular_momentum"
values = [[1.8, 0.4, -0.9]]
full_only = true
)");
  const Outcome outcome = study.bench();
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  const std::string errors = study.file("vary-spin.csv");
  CHECK(
      errors.starts_with("integrator,setting,\"error_at_[1.8, 0.4, -0.9]\",\"error_at_[1.8, 0.4, 0.0]\"\n"
                         "bound of the reference,,"));
  const Json spin = Json::parse(study.file("vary-spin.json"));
  REQUIRE(spin["runs"].size() == 4);
  for (const Json& run : spin["runs"])
    if (run["integrator"] == "rkmk4") {
      CHECK(run["error"]["orientation"].get<double>() > 1e-7);
      CHECK(says(errors, run["error"]["orientation"].dump().substr(0, 12)));
    }
  CHECK(says(study.file("vary-spin.md"), "x in body.angular_momentum = [1.8, 0.4, x]"));
  const Json largest = Json::parse(study.file("vary-largest.json"))["stability"];
  REQUIRE(largest.size() == 2);
  // Ten times the wave speed, a tenth of the step.
  const double ratio = largest[0]["largest_step"].get<double>() / largest[1]["largest_step"].get<double>();
  CHECK(ratio > 8.0);
  CHECK(ratio < 13.0);
  CHECK(!says(study.file("README.md"), "later"));
  CHECK(!fs::exists(study.out / "vary-later.csv"));
  const Outcome again = run_program({"report", "out"}, study.folder.path());
  CHECK(again.exit_code == 0);
  CHECK(study.file("vary-spin.csv") == errors);
}
