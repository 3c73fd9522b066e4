#include "src/study/scorecard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/study/drift_study.hpp"
#include "src/study/present.hpp"
#include "src/study/stability.hpp"

namespace gnomon {
namespace {

StudyOptions ladder_options(const StudyOptions& given) {
  StudyOptions options = given;
  options.quick = true;
  options.steps.clear();
  options.tols.clear();
  return options;
}

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

output::Cell score_order_cell(const Score& score) {
  if (!score.order.observed) return {};
  output::Cell cell = output::number_cell(*score.order.observed, 3);
  if (score.declared && std::abs(*score.order.observed - *score.declared) > 0.1)
    cell.text += fmt::format(" ({:g})", *score.declared);
  return cell;
}

}  // namespace

std::size_t scorecard_runs(const Catalogue& catalogue, const Scene& scene, const StudyOptions& options) {
  std::size_t runs = compare_runs(catalogue, scene, ladder_options(options));
  for (const SchemeInfo* scheme : select(catalogue, scene, options))
    runs += scheme->stepping == Stepping::fixed ? 2 : 1;
  return runs;
}

Scorecard scorecard(Runner& runner, const Scene& scene, const StudyOptions& given,
                    output::Progress& progress) {
  const StudyOptions options = ladder_options(given);
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
  Scene long_scene = scene;
  long_scene.resolved["t_end"] = long_scene.t_end = card.long_t_end =
      std::max(scene.t_end, 1000.0 * scene.model->time_scale());
  const DriftStudy drifts = drift(runner, long_scene, long_options, progress);
  for (Score& score : card.scores) {
    for (const Row& row : drifts.rows)
      if (row.scheme == score.scheme) score.long_run = row.result.status;
    for (const DriftRow& row : drifts.drifts)
      if (drifts.rows[row.row].scheme == score.scheme && row.invariant.info.name == "energy" &&
          !row.invariant.times.empty())
        score.energy = row.drift;
  }

  StepSearch search = stability_search({scene});
  search.whole = false;
  for (Score& score : card.scores) {
    if (score.scheme->stepping != Stepping::fixed || runner.stopped()) continue;
    progress.begin(fmt::format("{} / {}  larger and larger steps", scene.name, score.scheme->name));
    score.breaking =
        find_breaking(runner, scene, card.comparison.reference, *score.scheme, search, long_options);
    score.breaking->trials.clear();
  }
  card.interrupted = runner.stopped();
  return card;
}

output::Table scorecard_table(const Scorecard& card) {
  using output::Align;
  using output::Cell;
  output::Table table;
  const Scene& scene = card.comparison.scene;
  const MetricInfo metric = scene.model->metrics()[0];
  table.caption = fmt::format("Scorecard, {}", scene.name);
  table.columns = {{"integrator", "integrator", Align::left}, {"order", "order"}};
  for (const double level : card.levels) {
    table.columns.push_back(
        {fmt::format("cpu_us_at_{:.0e}", level), fmt::format("us to {:.0e} {}", level, metric.unit)});
    table.columns.push_back({fmt::format("rhs_at_{:.0e}", level), "(rates)"});
  }
  table.columns.insert(table.columns.end(), {{"energy", "energy", Align::left},
                                             {"energy_drift", "its drift"},
                                             {"largest_step_s", "largest step [s]"},
                                             {"how", "fails beyond", Align::left},
                                             {"failed", "failed runs", Align::left}});
  for (const Score& score : card.scores) {
    std::vector<Cell> cells{std::string(score.scheme->name), score_order_cell(score)};
    for (std::size_t k = 0; k < card.levels.size(); ++k) {
      cells.push_back(microseconds_cell(score.seconds[k]));
      cells.push_back(evaluations_cell(score.evaluations[k]));
    }
    if (score.long_run != Status::ok)
      cells.emplace_back(std::string(to_string(score.long_run)));
    else
      cells.push_back(score.energy ? Cell(std::string(to_string(score.energy->verdict))) : Cell());
    cells.push_back(score.energy ? output::number_cell(score.energy->max_abs, 2) : Cell());
    if (!score.breaking) {
      cells.insert(cells.end(), 2, Cell());
    } else {
      Cell step =
          score.breaking->survived > 0.0 ? output::number_cell(score.breaking->survived) : Cell("none", "");
      if (!score.breaking->breaks) step.text = "≥ " + step.text;
      cells.push_back(step);
      cells.push_back(score.breaking->breaks ? Cell(score.breaking->how) : Cell());
    }
    std::string failed = fmt::format("{} of {}", score.failed, score.runs);
    if (score.failed > 0) failed += " (" + score.first_failure + ")";
    cells.emplace_back(failed);
    table.rows.push_back(std::move(cells));
  }
  table.notes.push_back(reference_line(card.comparison));
  table.notes.push_back(
      fmt::format("order and cost of the {} error at t = {:g} s, order in brackets: the declared one where "
                  "it differs; ≤: "
                  "already the loosest setting reaches the level; — not reached, or no asymptotic range",
                  metric.name, scene.t_end));
  table.notes.push_back(fmt::format("energy to t = {:g} s at a step of {:.3g} s or a tolerance of 1e-8",
                                    card.long_t_end, 0.1 * scene.model->time_scale()));
  table.notes.push_back("largest step: " + survival_line({}));
  return table;
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
    item["costs"] = Json::array();
    for (std::size_t k = 0; k < card.levels.size(); ++k) {
      const auto &seconds = score.seconds[k], &evaluations = score.evaluations[k];
      item["costs"].push_back({{"error", card.levels[k]},
                               {"cpu_seconds", seconds ? number(seconds->cost) : Json(nullptr)},
                               {"rhs", evaluations ? number(evaluations->cost) : Json(nullptr)},
                               {"upper_bound", evaluations && evaluations->upper_bound}});
    }
    item["energy"] = nullptr;
    if (score.energy)
      item["energy"] = {
          {"verdict", score.long_run == Status::ok ? to_string(score.energy->verdict) : "failed"},
          {"max_drift", number(score.energy->max_abs)},
          {"status", to_string(score.long_run)}};
    item["largest_step"] =
        score.breaking && score.breaking->survived > 0.0 ? number(score.breaking->survived) : Json(nullptr);
    item["breaks_at"] = score.breaking ? number(score.breaking->breaks) : Json(nullptr);
    item["breaks_how"] = score.breaking && score.breaking->breaks ? Json(score.breaking->how) : Json(nullptr);
    item["runs"] = score.runs;
    item["failed"] = score.failed;
    item["first_failure"] = score.failed > 0 ? Json(score.first_failure) : Json(nullptr);
    list.push_back(std::move(item));
  }
  return list;
}

}  // namespace gnomon
