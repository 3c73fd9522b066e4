#include "src/study/drift_study.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace gnomon {
namespace {

std::vector<Setting> drift_settings(const Scene& scene, const SchemeInfo& scheme,
                                    const StudyOptions& options) {
  return settings(scheme, options, {0.1 * scene.model->time_scale()}, {1e-8});
}

std::optional<DriftAtStep> at_step(const Row& row, const Drift& drift) {
  const RunResult& result = row.result;
  if (result.status != Status::ok || !result.step) return std::nullopt;
  return DriftAtStep{*result.step, drift, count_evaluations(result.cost), result.cost.newton_iterations > 0};
}

/// Runs that may show biased rounding, and whose scheme has none with a smaller step, at half their steps.
std::vector<Row> rounding_checks(Runner& runner, const DriftStudy& study, const StudyOptions& options) {
  std::vector<RunPlan> plans;
  for (std::size_t k = 0; k < study.rows.size(); ++k) {
    const Row& row = study.rows[k];
    const bool asks = std::ranges::any_of(study.drifts, [&](const DriftRow& drift) {
      const auto at = at_step(row, drift.drift);
      return drift.row == k && at && may_be_biased_rounding(*at);
    });
    const bool has_finer = std::ranges::any_of(study.rows, [&](const Row& other) {
      return other.scheme == row.scheme && other.result.status == Status::ok && other.result.step &&
             row.result.step && *other.result.step <= 0.75 * *row.result.step;
    });
    if (asks && !has_finer) plans.push_back({row.scheme, {0.5 * *row.result.step, std::nullopt}});
  }
  if (plans.empty() || runner.stopped()) return {};
  return runner.run_each(study.scene, {}, plans, options, [](const RunPlan&) {});
}

void tell_rounding_apart(DriftStudy& study, const std::vector<Row>& checks) {
  for (const DriftRow& each : study.drifts) {
    const SchemeInfo* scheme = study.rows[each.row].scheme;
    const std::string& name = each.invariant.info.name;
    std::vector<DriftAtStep> runs;
    std::vector<DriftRow*> shown;
    for (DriftRow& row : study.drifts)
      if (study.rows[row.row].scheme == scheme && row.invariant.info.name == name)
        if (const auto at = at_step(study.rows[row.row], row.drift)) {
          runs.push_back(*at);
          shown.push_back(&row);
        }
    for (const Row& check : checks)
      for (const InvariantSummary& invariant : check.invariants)
        if (check.scheme == scheme && invariant.info.name == name)
          if (const auto at = at_step(check, invariant.measured)) runs.push_back(*at);
    tell_rounding(runs);
    for (std::size_t k = 0; k < shown.size(); ++k) shown[k]->drift.verdict = runs[k].drift.verdict;
  }
}

}  // namespace

bool DriftStudy::has_ladder() const {
  for (std::size_t k = 1; k < rows.size(); ++k)
    if (rows[k].scheme == rows[k - 1].scheme) return true;
  return false;
}

std::optional<DriftScaling> h_scaling(const DriftStudy& study, const SchemeInfo& scheme,
                                      const std::string& invariant) {
  std::vector<DriftAtStep> runs;
  for (const DriftRow& row : study.drifts) {
    const Row& run = study.rows[row.row];
    if (run.scheme == &scheme && run.result.status == Status::ok && run.result.step &&
        row.invariant.info.name == invariant)
      runs.push_back({*run.result.step, row.drift, 0.0, false});
  }
  return drift_scaling(runs);
}

std::size_t drift_runs(const Catalogue& catalogue, const Scene& scene, const StudyOptions& options) {
  std::size_t runs = 0;
  for (const SchemeInfo* scheme : select(catalogue, scene, options))
    runs += drift_settings(scene, *scheme, options).size();
  const auto before = std::ranges::count_if(options.error_times, [&](double t) { return t < scene.t_end; });
  return runs * (1 + static_cast<std::size_t>(before));
}

DriftStudy drift(Runner& runner, Scene scene, const StudyOptions& given, output::Progress& progress) {
  StudyOptions options = given;
  options.watch = std::max(options.watch, 2048);
  DriftStudy study;
  study.scene = std::move(scene);
  const auto schemes = select(runner.catalogue(), study.scene, options);
  const std::vector<double>& times = options.error_times;
  study.error_at_end = times.empty() || std::ranges::find(times, study.scene.t_end) != times.end();
  if (study.error_at_end) study.reference = runner.reference(study.scene, options);
  std::vector<RunPlan> plans;
  for (const SchemeInfo* scheme : schemes)
    for (const Setting& setting : drift_settings(study.scene, *scheme, options))
      plans.push_back({scheme, setting});
  const auto run_to_end = [&](const Scene& upto, const ReferenceStates& reference) {
    std::vector<Row> rows = runner.run_each(upto, reference, plans, options, [&](const RunPlan& plan) {
      progress.begin(fmt::format("{} / {}  {}", upto.name, plan.scheme->name, plan.setting.text()));
    });
    study.interrupted = study.interrupted || rows.size() < plans.size();
    return rows;
  };
  study.rows = run_to_end(study.scene, study.reference);
  for (std::size_t k = 0; k < study.rows.size(); ++k)
    for (const InvariantSummary& invariant : study.rows[k].invariants)
      study.drifts.push_back({k, invariant, invariant.measured});
  tell_rounding_apart(study, rounding_checks(runner, study, options));
  options.watch = given.watch;
  for (const double time : times) {
    if (study.interrupted || !(time < study.scene.t_end)) continue;
    ErrorsBefore& before = study.before.emplace_back();
    before.scene = study.scene.with_end(time);
    before.reference = runner.reference(before.scene, options);
    before.rows = run_to_end(before.scene, before.reference);
  }
  return study;
}

}  // namespace gnomon
