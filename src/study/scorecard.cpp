#include "src/study/scorecard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/study/drift_study.hpp"
#include "src/study/stability.hpp"

namespace gnomon {
namespace {

void add_ladder(Scorecard& card, Score& score) {
  const Comparison& study = card.comparison;
  for (const Row& row : study.rows) {
    if (row.scheme != score.scheme) continue;
    ++score.runs;
    if (row.result.status == Status::ok) continue;
    if (score.failed++ == 0)
      score.first_failure = fmt::format("{}: {}", row.setting.text(), to_string(row.result.status));
  }
  if (score.scheme->stepping == Stepping::fixed) {
    const OrderRow order = observed_order(study, *score.scheme, 0);
    score.order = order.order;
    score.declared = order.expected;
  }
  const auto cost = std::ranges::find(study.costs, score.scheme, &CostRow::scheme);
  for (const double level : card.levels) {
    const auto at = static_cast<std::size_t>(std::ranges::find(study.levels, level) - study.levels.begin());
    const bool known = cost != study.costs.end() && at < study.levels.size();
    score.seconds.push_back(known ? cost->seconds[at] : std::nullopt);
    score.evaluations.push_back(known ? cost->evaluations[at] : std::nullopt);
  }
}

}  // namespace

std::size_t scorecard_runs(const Catalogue& catalogue, const Scene& scene, const StudyOptions& options) {
  std::size_t runs = compare_runs(catalogue, scene, options);
  for (const SchemeInfo* scheme : select(catalogue, scene, options))
    runs += scheme->stepping == Stepping::fixed ? 2 : 1;
  return runs;
}

Scorecard scorecard(Runner& runner, const Scene& scene, const StudyOptions& options,
                    output::Progress& progress) {
  Scorecard card;
  card.levels = {1e-3, 1e-6, 1e-9};
  card.comparison = compare(runner, scene, options, progress);
  for (const SchemeInfo* scheme : select(runner.catalogue(), scene, options)) {
    card.scores.push_back({scheme, {}, {}, {}, {}, {}, Status::ok, {}, 0, 0, ""});
    add_ladder(card, card.scores.back());
  }

  StudyOptions long_options = options;
  long_options.reference = false;
  long_options.time_limit = std::min(options.time_limit, 20.0);
  card.long_t_end = std::max(scene.t_end, 1000.0 * scene.model->time_scale());
  const Scene long_scene = scene.with_end(card.long_t_end);
  const DriftStudy drifts = drift(runner, long_scene, long_options, progress);
  for (Score& score : card.scores) {
    for (const Row& row : drifts.rows)
      if (row.scheme == score.scheme) score.long_run = row.result.status;
    for (const DriftRow& row : drifts.drifts)
      if (drifts.rows[row.row].scheme == score.scheme && row.invariant.info.name == "energy" &&
          !row.invariant.times.empty())
        score.energy = row.drift;
  }

  StepSearch search = stability_search({scene}, options.quick);
  search.whole = false;
  std::vector<const SchemeInfo*> fixed;
  std::vector<Score*> scores;
  for (Score& score : card.scores) {
    if (score.scheme->stepping != Stepping::fixed) continue;
    fixed.push_back(score.scheme);
    scores.push_back(&score);
  }
  auto found = find_breakings(
      runner, scene, card.comparison.reference, fixed, search, long_options, [&](const SchemeInfo& scheme) {
        progress.begin(fmt::format("{} / {}  larger and larger steps", scene.name, scheme.name));
      });
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (!found[k]) continue;
    scores[k]->breaking = std::move(*found[k]);
    scores[k]->breaking->trials.clear();
  }
  card.interrupted = runner.stopped();
  return card;
}

nlohmann::ordered_json scorecard_json(const Scorecard& card) {
  using Json = nlohmann::ordered_json;
  const auto number = [](const std::optional<double>& value) {
    return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
  };
  Json list = Json::array();
  for (const Score& score : card.scores) {
    Json item;
    item["scene"] = card.comparison.scene.name;
    item["integrator"] = score.scheme->name;
    item["observed_order"] = number(score.order.observed);
    item["declared_order"] = number(score.declared);
    item["order_finding"] =
        score.scheme->stepping == Stepping::fixed ? Json(to_string(score.order.finding)) : Json(nullptr);
    item["costs"] = Json::array();
    for (std::size_t k = 0; k < card.levels.size(); ++k) {
      const auto &seconds = score.seconds[k], &evaluations = score.evaluations[k];
      item["costs"].push_back({{"error", card.levels[k]},
                               {"cpu_seconds", seconds ? number(seconds->cost) : Json(nullptr)},
                               {"rhs", evaluations ? number(evaluations->cost) : Json(nullptr)},
                               {"upper_bound", evaluations && evaluations->upper_bound},
                               {"few_settings", evaluations && evaluations->few}});
    }
    item["energy"] = nullptr;
    if (score.energy)
      item["energy"] = {
          {"verdict", score.long_run == Status::ok ? to_string(score.energy->verdict) : "failed"},
          {"max_drift", number(score.energy->max_abs)},
          {"status", to_string(score.long_run)}};
    if (const std::string why =
            score.energy && score.long_run == Status::ok ? why_undecided(*score.energy) : "";
        !why.empty())
      item["energy"]["undecided_because"] = why;
    item["largest_step"] =
        score.breaking && score.breaking->survived > 0.0 ? number(score.breaking->survived) : Json(nullptr);
    item["breaks_at"] = score.breaking ? number(score.breaking->breaks) : Json(nullptr);
    item["breaks_how"] = score.breaking && score.breaking->breaks ? Json(score.breaking->how) : Json(nullptr);
    item["survives_again_up_to"] =
        score.breaking && score.breaking->again > 0.0 ? number(score.breaking->again) : Json(nullptr);
    item["steps_tried"] = score.breaking ? Json(score.breaking->tried) : Json(nullptr);
    item["tried_down_to"] =
        score.breaking && score.breaking->tried > 0 ? number(score.breaking->down_to) : Json(nullptr);
    item["runs"] = score.runs;
    item["failed"] = score.failed;
    item["first_failure"] = score.failed > 0 ? Json(score.first_failure) : Json(nullptr);
    list.push_back(std::move(item));
  }
  return list;
}

}  // namespace gnomon
