// What tables say of figures that are bounds, rest on little or do not exist, from made-up results.
#include <atomic>
#include <sstream>

#include "src/study/scorecard.hpp"
#include "src/study/survey.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;

namespace {

using MaybeCost = std::optional<LevelCost>;

Score score_of(const SchemeInfo* scheme, MaybeCost cost) {
  Score score{scheme, {}, {}, {}, {}, {}, Status::ok, {}, 0, 0, ""};
  score.seconds = {cost};
  score.evaluations = {cost};
  return score;
}

/// Of two schemes on two scenes.
std::vector<Scorecard> cards_of(const Catalogue& catalogue, MaybeCost a1, MaybeCost b1, MaybeCost a2,
                                MaybeCost b2) {
  const SchemeInfo *a = catalogue.scheme("rkmk4"), *b = catalogue.scheme("no-squish");
  std::vector<Scorecard> cards(2);
  for (Scorecard& card : cards) {
    card.comparison.scene = load_scene(catalogue, "asymmetric-free-top");
    card.levels = {1e-3};
  }
  cards[0].scores = {score_of(a, a1), score_of(b, b1)};
  cards[1].scores = {score_of(a, a2), score_of(b, b2)};
  return cards;
}

}  // namespace

TEST_CASE("scorecard: means say what bounds and few settings they rest on, and where there is none",
          "[study]") {
  const Catalogue catalogue = test::full_catalogue();
  const auto cell = [&](std::size_t row, MaybeCost a1, MaybeCost b1, MaybeCost a2, MaybeCost b2) {
    return joint_scorecard_table("", cards_of(catalogue, a1, b1, a2, b2)).rows.at(row).at(2).text;
  };
  const LevelCost one{1.0, false, false}, four{4.0, false, false};
  CHECK(cell(0, one, four, one, one) == "1.0");
  CHECK(cell(1, one, four, one, one) == "2.0");
  CHECK(cell(1, one, LevelCost{4.0, true, false}, one, one) == "≤ 2.0");
  CHECK(cell(1, one, four, one, LevelCost{1.0, false, true}) == "2.0°");
  CHECK(cell(0, LevelCost{1.0, true, false}, four, one, one) == "≤ 1.0");
  CHECK(cell(1, LevelCost{1.0, true, false}, four, one, one) == "≥ 2.0");
  CHECK(cell(1, LevelCost{1.0, true, false}, four, one, LevelCost{1.0, true, false}) == "≈ 2.0");
  CHECK(cell(1, one, std::nullopt, one, one) == "— (1 of 2)");
  CHECK(cell(1, one, std::nullopt, one, std::nullopt) == "—");
  // What is exact takes one step for any error and is no measure for the others.
  std::vector<Scorecard> cards = cards_of(catalogue, one, four, one, one);
  const auto shown = [&](std::size_t row) {
    return joint_scorecard_table("", cards).rows.at(row).at(2).text;
  };
  cards[0].scores[0].order.finding = OrderFinding::exact;
  CHECK(shown(0) == "0.50");
  CHECK(shown(1) == "1.0");
  // Where a scheme does not run it has not failed.
  cards = cards_of(catalogue, one, four, one, one);
  cards[1].scores.pop_back();
  CHECK(shown(1) == "4.0");
}

TEST_CASE("survey: a scheme without a time has a reason, in a note and in the document", "[study][survey]") {
  const Catalogue catalogue = test::full_catalogue();
  Survey survey;
  survey.model = "rigid_body";
  SurveyClass of{
      {"free", "asymmetric-free-top", 0.05, 50.0}, load_scene(catalogue, "asymmetric-free-top"), {}};
  SurveyEntry timed{}, failed{};
  timed.scheme = catalogue.scheme("rkmk4");
  timed.timed_steps = 10;
  timed.run.median = 1e-6;
  timed.run.repetitions = 5;
  failed.scheme = catalogue.scheme("zhao-van-wachem");
  failed.timed_steps = 10;
  failed.timed_status = Status::diverged;
  failed.timed_failure = "diverged: at t = 3 s";
  of.entries = {timed, failed};
  survey.classes.push_back(of);
  const std::string shown = to_text(survey_cost_table(survey));
  CHECK(shown.find("zhao-van-wachem, free (10 steps of 0.05 s): diverged: at t = 3 s") != std::string::npos);
  const auto json = survey_json(survey);
  CHECK(json[0]["timed_status"] == "ok");
  CHECK(json[0]["untimed_because"].is_null());
  CHECK(json[1]["timed_status"] == "diverged");
  CHECK(json[1]["untimed_because"] == "diverged: at t = 3 s");
}

TEST_CASE("compare: default ladders begin below the loosest level, written ones do not move", "[study]") {
  const Catalogue catalogue = test::full_catalogue();
  ReferenceStore references("");
  const std::atomic<bool> stop{false};
  Runner runner(catalogue, references, stop);
  std::ostringstream sink;
  output::Progress progress(1, output::ProgressMode::silent, sink);
  StudyOptions options;
  options.integrators = {"blanes-moan-rkn6-exact-drift", "arkode-erk5", "exact-free-top"};
  options.quick = true;
  options.timing = false;
  const Scene scene = load_scene(catalogue, "asymmetric-free-top");
  const Comparison study = compare(runner, scene, options, progress);
  for (const CostRow& cost : study.costs) {
    INFO(cost.scheme->name);
    std::vector<const Row*> rows;
    for (const Row& row : study.rows)
      if (row.scheme == cost.scheme) rows.push_back(&row);
    if (cost.scheme->stepping == Stepping::closed_form) {
      CHECK(rows.size() == 1);
      continue;
    }
    for (std::size_t k = 1; k < rows.size(); ++k)
      CHECK((rows[k - 1]->setting.step ? *rows[k - 1]->setting.step > *rows[k]->setting.step
                                       : *rows[k - 1]->setting.tol > *rows[k]->setting.tol));
    // It goes on until the loosest level is missed, or nothing is looser.
    CHECK((rows.front()->error.at(0) > study.levels.front() || !looser(scene, rows.front()->setting)));
    CHECK(rows.back()->error.at(0) < 1e-6);
  }
  options.integrators = {"arkode-erk5"};
  options.tols = {1e-6, 1e-7, 1e-8};
  CHECK(compare(runner, scene, options, progress).rows.size() == 3);
}
