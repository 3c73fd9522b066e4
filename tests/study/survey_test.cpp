// The survey's part about schemes that choose their steps, negative controls and closed forms.
#include <atomic>
#include <cmath>
#include <set>
#include <sstream>

#include "src/study/keeper.hpp"
#include "src/study/survey_solvers.hpp"
#include "tests/catch.hpp"
#include "tests/output/temporary_folder.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;

namespace {

const SurveyPlan gravity_class{"gravity", "asymmetric-heavy-top", 0.02, 20.0, "heavy-symmetric-top"};
const SurveyPlan free_class{"free", "asymmetric-free-top", 0.05, 50.0};

struct SolverSurvey {
  Catalogue catalogue = test::full_catalogue();
  ReferenceStore references{""};
  std::atomic<bool> stop{false};

  std::vector<SolverClass> make(const std::vector<SurveyPlan>& plans, Keeper* keeper, bool timing) {
    Runner runner(catalogue, references, stop);
    runner.keep_in(keeper);
    std::ostringstream sink;
    output::Progress progress(1, output::ProgressMode::silent, sink);
    StudyOptions options;
    options.quick = true;
    std::vector<SolverClass> classes;
    for (const SurveyPlan& plan : plans) classes.push_back(survey_solvers(runner, plan, options, progress));
    if (timing) time_solvers(runner, classes, options);
    return classes;
  }
};

const SolverEntry& solver(const SolverClass& of, std::string_view name) {
  for (const SolverEntry& entry : of.entries)
    if (entry.scheme->name == name) return entry;
  throw std::runtime_error("no " + std::string(name));
}

std::string shown(const std::vector<SolverClass>& classes) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  add_solvers(classes, json);
  return to_text(solver_cost_table("rigid_body", classes)) +
         to_text(solver_stability_table("rigid_body", classes)) + json.dump();
}

}  // namespace

TEST_CASE("survey: every scheme that chooses its steps and every closed form has a row", "[study][survey]") {
  SolverSurvey survey;
  const auto classes = survey.make({free_class, gravity_class}, nullptr, false);
  const auto [free, gravity] = std::tie(classes[0], classes[1]);
  std::set<std::string_view> expected, found;
  for (const SchemeInfo& scheme : survey.catalogue.schemes)
    for (const char* name : {"asymmetric-free-top", "asymmetric-heavy-top", "heavy-symmetric-top"})
      if (scheme.stepping != Stepping::fixed &&
          survey.catalogue.pair(scheme.name, *load_scene(survey.catalogue, name).model))
        expected.insert(scheme.name);
  for (const SolverClass& of : classes)
    for (const SolverEntry& entry : of.entries) found.insert(entry.scheme->name);
  CHECK(found == expected);
  CHECK(found.size() >= 13);

  for (const SolverClass& of : classes)
    for (const SolverEntry& entry : of.entries) {
      INFO(of.plan.label << ", " << entry.scheme->name);
      if (entry.scheme->control) {
        CHECK(entry.status == Status::solver_failed);
        CHECK_FALSE(entry.run.result.message.empty());
        CHECK((entry.held.empty() && !entry.energy && !entry.loosest));
        continue;
      }
      REQUIRE(entry.status == Status::ok);
      REQUIRE(entry.run.error.size() == 2);
      REQUIRE(entry.energy);
      if (entry.scheme->stepping == Stepping::closed_form) {
        CHECK(entry.run.error[0] <= 1e-12);
        CHECK(entry.energy->verdict == DriftVerdict::roundoff);
        CHECK_FALSE((entry.loosest || entry.off_at));
        continue;
      }
      // A tolerance of 1e-8 is kept, more or less, and is no roundoff.
      CHECK(entry.run.error[0] <= 1e-5);
      CHECK(entry.run.error[0] >= 1e-12);
      CHECK(std::isnan(entry.own_bound));
      CHECK(std::count(entry.held.begin(), entry.held.end(), "energy") == 0);
      CHECK(entry.energy->max_abs >= 1e-12);
      CHECK(entry.energy->max_abs <= 1e-5);
      CHECK(entry.run.result.cost.steps > 0);
      CHECK(entry.loosest.value_or(0.0) >= 1e-6);
      if (entry.off_at) {
        CHECK(*entry.off_at > 9.0 * *entry.loosest);
        CHECK_FALSE(entry.off_how.empty());
      }
    }
  // The closed form of the free body alone bounds its error.
  CHECK(solver(free, "exact-free-top").run.error[0] <= solver(free, "exact-free-top").own_bound);
  CHECK(solver(free, "exact-free-top").own_bound <= 1e-12);
  // Some tolerance is too loose for all but few of them.
  CHECK(solver(gravity, "cvode-bdf").off_at);
  CHECK(solver(gravity, "ida-bdf-constraints").off_at);
  CHECK(solver(gravity, "exact-heavy-symmetric-top").scene == "heavy-symmetric-top");
  CHECK(solver(free, "exact-free-top").scene == "asymmetric-free-top");
  CHECK(solver(free, "exact-free-top").held.size() == 4);
  CHECK(solver(gravity, "cvode-adams").run.result.cost.steps <
        solver(gravity, "arkode-erk4").run.result.cost.steps);
}

TEST_CASE("survey: its tables of solvers can be made again from the store alone", "[study][survey][long]") {
  SolverSurvey survey;
  test::TemporaryFolder folder;
  Keeper::Plan plan;
  plan.code = "code";
  plan.machine = "machine";
  plan.limits.bytes = default_memory_limit();
  std::string first;
  {
    RunStore store(folder.path().string(), RunStore::Access::append);
    Keeper keeper(store, plan);
    first = shown(survey.make({gravity_class}, &keeper, true));
    CHECK(keeper.made() > 80);
    CHECK(first.find("exact-heavy-symmetric-top") != std::string::npos);
  }
  RunStore store(folder.path().string(), RunStore::Access::read);
  plan.measure = false;
  Keeper reader(store, plan);
  SolverSurvey again;
  CHECK(shown(again.make({gravity_class}, &reader, true)) == first);
  CHECK(reader.made() == 0);
  CHECK(reader.missing() == 0);
  // Without the times all is the same as in one process.
  Keeper untimed(store, plan);
  const auto kept = again.make({gravity_class}, &untimed, false);
  CHECK(shown(kept) == shown(survey.make({gravity_class}, nullptr, false)));
}
