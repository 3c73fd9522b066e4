#include "src/study/vary_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "src/study/present.hpp"
#include "src/study/stability_output.hpp"
#include "src/study/vary_output.hpp"

namespace gnomon {
namespace {

StudyOptions planned(const VaryPlan& plan, StudyOptions options) {
  options.integrators = plan.integrators;
  options.steps = plan.steps;
  options.tols = plan.tols;
  options.time_limit = std::min(options.time_limit, plan.time_limit);
  options.timing_budget = plan.timing_budget;
  if (plan.stability) options.time_limit = std::min(options.time_limit, 20.0);
  // One setting alone shows errors; what they cost takes several.
  options.timing = options.timing && !(plan.steps.size() < 2 && plan.tols.size() < 2 &&
                                       plan.steps.size() + plan.tols.size() > 0);
  return options;
}

}  // namespace

std::vector<Scene> variants_of(const Catalogue& catalogue, const VaryPlan& plan) {
  std::vector<Scene> scenes;
  SceneChanges changes;
  changes.t_end = plan.t_end;
  changes.set = plan.set;
  for (std::size_t k = 0; k < plan.variation.values.size(); ++k) {
    changes.vary = plan.variation.assignment(k);
    scenes.push_back(load_scene(catalogue, plan.scene, changes));
  }
  return scenes;
}

std::size_t vary_runs(const Catalogue& catalogue, const VaryPlan& plan, const StudyOptions& options) {
  std::size_t runs = 0;
  const StudyOptions chosen = planned(plan, options);
  for (const Scene& scene : variants_of(catalogue, plan))
    runs += plan.stability ? equal_step_schemes(catalogue, scene, chosen).size()
                           : compare_runs(catalogue, scene, chosen);
  return runs;
}

VariedStudy vary(Runner& runner, const VaryPlan& plan, StudyOptions options, output::Progress& progress) {
  VariedStudy study;
  study.variation = plan.variation;
  const std::vector<Scene> scenes = variants_of(runner.catalogue(), plan);
  const StudyOptions chosen = planned(plan, std::move(options));
  if (plan.stability) {
    study.stability = stability(runner, scenes, plan.variation, {}, chosen, progress);
    study.interrupted = study.stability.interrupted();
    return study;
  }
  for (const Scene& scene : scenes) {
    study.comparisons.push_back(compare(runner, scene, chosen, progress));
    study.interrupted = study.comparisons.back().interrupted;
    if (study.interrupted) break;
  }
  return study;
}

std::vector<output::Table> VariedStudy::tables() const {
  if (comparisons.empty()) return {stability_table(stability), stability_map(stability)};
  std::vector<output::Table> tables = varied_tables(comparisons, variation);
  tables.push_back(varied_runs_table(comparisons, variation));
  return tables;
}

output::Figure VariedStudy::figure(const Catalogue& catalogue) const {
  return comparisons.empty() ? stability_figure(catalogue, stability)
                             : varied_figure(catalogue, comparisons, variation);
}

void VariedStudy::add_to(Document& document) const {
  for (const Comparison& comparison : comparisons) document.add_comparison(comparison);
  if (!comparisons.empty()) return;
  for (const StabilityScene& scene : stability.scenes) document.add(scene);
  document.json()["stability"] = stability_json(stability);
}

std::string vary_command(const VaryPlan& plan) {
  std::string text = fmt::format("{} {} --vary '{}={}'", plan.stability ? "stability" : "compare", plan.scene,
                                 plan.variation.key, fmt::join(plan.variation.values, ","));
  for (const std::string& change : plan.set) text += fmt::format(" --set '{}'", change);
  if (plan.t_end) text += fmt::format(" --t-end {:g}", *plan.t_end);
  if (!plan.steps.empty()) text += fmt::format(" --steps {:g}", fmt::join(plan.steps, ","));
  if (!plan.tols.empty()) text += fmt::format(" --tols {:g}", fmt::join(plan.tols, ","));
  if (plan.time_limit < 300.0) text += fmt::format(" --time-limit {:g}", plan.time_limit);
  return text;
}

}  // namespace gnomon
