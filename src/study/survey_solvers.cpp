#include "src/study/survey_solvers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/study/breaking.hpp"
#include "src/study/drift_study.hpp"

namespace gnomon {
namespace {

/// From the tightest on.
constexpr double looser_tols[] = {1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1};

struct Solver {
  const SchemeInfo* scheme;
  std::string scene;
};

Scene scene_to(const Catalogue& catalogue, const std::string& name, std::optional<double> t_end) {
  SceneChanges changes;
  changes.t_end = t_end;
  return load_scene(catalogue, name, changes);
}

/// Closed forms that the scene of the class has not run on its other scene.
std::vector<Solver> solvers_of(const Catalogue& catalogue, const SurveyPlan& plan) {
  std::vector<Solver> list;
  const Scene scene = scene_to(catalogue, plan.scene, std::nullopt);
  std::optional<Scene> other;
  if (!plan.closed_form_scene.empty()) other = scene_to(catalogue, plan.closed_form_scene, std::nullopt);
  for (const SchemeInfo& scheme : catalogue.schemes) {
    if (scheme.stepping == Stepping::fixed) continue;
    if (catalogue.pair(scheme.name, *scene.model))
      list.push_back({&scheme, plan.scene});
    else if (other && scheme.stepping == Stepping::closed_form && catalogue.pair(scheme.name, *other->model))
      list.push_back({&scheme, plan.closed_form_scene});
  }
  return list;
}

double own_bound_of(const Row& row, const Scene& scene) {
  const std::string metric(scene.model->metrics()[0].name);
  if (!row.result.own_bound.empty()) return row.result.own_bound[0];
  if (row.document.contains("own_error_bound") && row.document["own_error_bound"][metric].is_number())
    return row.document["own_error_bound"][metric].get<double>();
  return std::nan("");
}

void make_long_run(Runner& runner, const SurveyPlan& plan, const StudyOptions& given, SolverEntry& entry,
                   output::Progress& progress) {
  StudyOptions options = given;
  options.integrators = {std::string(entry.scheme->name)};
  options.tols = {survey_tol};
  options.reference = false;
  const double t_end = std::min(plan.t_end, 20'000.0 * plan.step);
  const DriftStudy study = drift(runner, scene_to(runner.catalogue(), entry.scene, t_end), options, progress);
  if (study.rows.empty()) return;
  entry.status = study.rows.front().result.status;
  for (const DriftRow& row : study.drifts) {
    const std::string& name = row.invariant.info.name;
    if (row.drift.verdict == DriftVerdict::roundoff) entry.held.push_back(name);
    if (name == "energy") entry.energy = row.drift;
  }
}

void loosen(Runner& runner, const SurveyPlan& plan, SolverEntry& entry, output::Progress& progress) {
  Scene scene = scene_to(runner.catalogue(), entry.scene, std::nullopt);
  const double t_end = std::min(500.0 * scene.model->time_scale(), plan.t_end);
  scene = scene_to(runner.catalogue(), entry.scene, t_end);
  StudyOptions options;
  options.time_limit = 20.0;
  std::vector<RunPlan> plans;
  for (const double tol : looser_tols) plans.push_back({entry.scheme, {std::nullopt, tol}});
  progress.begin(fmt::format("{} / {}  looser and looser tolerances", entry.scene, entry.scheme->name));
  const std::vector<Row> rows = runner.run_each(scene, {}, plans, options, [](const RunPlan&) {});
  Survival survival;
  survival.max_drift = 0.01;
  for (const Row& row : rows) {
    entry.off_how = failure_of(scene, row, survival);
    if (!entry.off_how.empty()) {
      entry.off_at = row.setting.tol;
      return;
    }
    entry.loosest = row.setting.tol;
  }
}

}  // namespace

std::size_t survey_solver_runs(const Catalogue& catalogue, const SurveyPlan& plan) {
  std::size_t runs = 0;
  for (const Solver& solver : solvers_of(catalogue, plan))
    runs += solver.scheme->control ? 1 : solver.scheme->stepping == Stepping::adaptive ? 3 : 2;
  return runs;
}

SolverClass survey_solvers(Runner& runner, const SurveyPlan& plan, const StudyOptions& options,
                           output::Progress& progress) {
  const MetricInfo metric = scene_to(runner.catalogue(), plan.scene, std::nullopt).model->metrics()[0];
  SolverClass of{plan, std::string(metric.name), std::string(metric.unit), {}};
  for (const auto& [scheme, name] : solvers_of(runner.catalogue(), plan)) {
    if (runner.stopped()) break;
    const Scene scene = scene_to(runner.catalogue(), name, std::nullopt);
    const ReferenceStates reference = runner.reference(scene, options);
    Setting setting;
    if (scheme->stepping == Stepping::adaptive) setting.tol = survey_tol;
    progress.begin(fmt::format("{} / {}  {}", name, scheme->name, setting.text()));
    SolverEntry entry{
        scheme, name, runner.run(scene, reference, *scheme, setting, options), {}, {}, {}, {}, {}, {}, {}};
    entry.own_bound = own_bound_of(entry.run, scene);
    entry.status = entry.run.result.status;
    if (entry.status == Status::ok && !scheme->control) {
      make_long_run(runner, of.plan, options, entry, progress);
      if (setting.tol && !runner.stopped()) loosen(runner, of.plan, entry, progress);
    }
    of.entries.push_back(std::move(entry));
  }
  return of;
}

void time_solvers(Runner& runner, std::vector<SolverClass>& classes, const StudyOptions& options) {
  std::vector<Scene> scenes;  // alive until the last run
  std::vector<TimedTask> tasks;
  std::vector<std::string> names;
  std::vector<SolverEntry*> timed;
  for (SolverClass& of : classes)
    for (SolverEntry& entry : of.entries) {
      if (entry.run.result.status != Status::ok) continue;
      scenes.push_back(scene_to(runner.catalogue(), entry.scene, std::nullopt));
      RunSpec spec;
      spec.tol = entry.run.setting.tol;
      spec.t_end = scenes.back().t_end;
      spec.record = false;
      const auto run = runner.catalogue().pair(entry.scheme->name, *scenes.back().model)->run;
      tasks.push_back({[run, spec, model = scenes.back().model] {
        const RunResult result = run(model->get(), spec);
        return result.status == Status::ok ? result.cpu_seconds : std::nan("");
      }});
      names.push_back(fmt::format("{} {}, {}, {}", entry.scene, scenes.back().physics_hash(),
                                  entry.scheme->name, entry.run.setting.text()));
      timed.push_back(&entry);
    }
  TimingPlan plan;
  if (options.quick) plan.min_seconds = 0.005;
  const auto stats = runner.time("survey times of solvers", {}, names, tasks, plan);
  for (std::size_t k = 0; k < stats.size(); ++k)
    if (stats[k].repetitions > 0) timed[k]->run.timing = stats[k];
}

}  // namespace gnomon
