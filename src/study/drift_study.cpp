#include "src/study/drift_study.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace gnomon {
namespace {

std::vector<Setting> drift_settings(const Scene& scene, const SchemeInfo& scheme,
                                    const StudyOptions& options) {
  return settings(scheme, options, {0.1 * scene.model->time_scale()}, {1e-8});
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
      runs.push_back({*run.result.step, row.drift});
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
  options.watch = given.watch;
  for (const double time : times) {
    if (study.interrupted || !(time < study.scene.t_end)) continue;
    ErrorsBefore& before = study.before.emplace_back();
    before.scene = study.scene.with_end(time);
    before.reference = runner.reference(before.scene, options);
    before.rows = run_to_end(before.scene, before.reference);
  }
  for (std::size_t k = 0; k < study.rows.size(); ++k)
    for (const InvariantSummary& invariant : study.rows[k].invariants)
      study.drifts.push_back({k, invariant, invariant.measured});
  return study;
}

}  // namespace gnomon
