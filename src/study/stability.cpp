#include "src/study/stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/error.hpp"

namespace gnomon {

std::vector<double> StabilityEntry::islands() const {
  std::vector<double> steps;
  for (const Point& point : points)
    if (point.failure.empty() && breaking.breaks && point.step > *breaking.breaks)
      steps.push_back(point.step);
  return steps;
}

StepSearch stability_search(const std::vector<Scene>& scenes, bool quick) {
  double shortest = scenes.front().model->time_scale(), longest = shortest, t_end = scenes.front().t_end;
  for (const Scene& scene : scenes) {
    shortest = std::min(shortest, scene.model->time_scale());
    longest = std::max(longest, scene.model->time_scale());
    t_end = std::min(t_end, scene.t_end);
  }
  const double fewest = std::max(8.0, std::ceil(t_end / (64.0 * longest)));
  const double octaves = std::clamp(std::ceil(std::log2(64.0 * t_end / (fewest * shortest))), 4.0, 20.0);
  StepSearch search;
  search.first = t_end / (fewest * std::exp2(octaves));
  search.count = static_cast<int>(octaves) + 1;
  search.whole = true;
  search.resolution = std::pow(2.0, 0.125);
  search.lowest = search.first / 4096.0;
  search.descent.near = quick ? 4 : 12;
  search.descent.far = quick ? 2 : 4;
  return search;
}

std::vector<const SchemeInfo*> equal_step_schemes(const Catalogue& catalogue, const Scene& scene,
                                                  const StudyOptions& options) {
  std::vector<const SchemeInfo*> schemes = select(catalogue, scene, options);
  for (const SchemeInfo* scheme : schemes)
    if (scheme->stepping != Stepping::fixed && !options.integrators.empty())
      throw UsageError(fmt::format("--integrators: found '{}' ({}), expected schemes that take equal steps",
                                   scheme->name, to_string(scheme->stepping)));
  std::erase_if(schemes, [](const SchemeInfo* scheme) { return scheme->stepping != Stepping::fixed; });
  return schemes;
}

Stability stability(Runner& runner, const std::vector<Scene>& scenes,
                    const std::optional<Variation>& variation, const Survival& survival,
                    const StudyOptions& options, output::Progress& progress) {
  Stability study;
  study.name = scenes.front().name.substr(0, scenes.front().name.find('['));
  study.variation = variation;
  study.search = stability_search(scenes, options.quick);
  study.search.survival = survival;
  for (const Scene& scene : scenes) {
    study.scenes.emplace_back();
    StabilityScene& on = study.scenes.back();
    on.scene = scene;
    // Errors are looked at only where no energy is constant.
    if (keeps_energy(scene))
      on.reference.message = "not needed: the energy tells";
    else
      on.reference = runner.reference(scene, options);
    const auto schemes = equal_step_schemes(runner.catalogue(), scene, options);
    auto found = find_breakings(
        runner, scene, on.reference, schemes, study.search, options, [&](const SchemeInfo& scheme) {
          progress.begin(fmt::format("{} / {}  larger and larger steps", scene.name, scheme.name));
        });
    for (std::size_t k = 0; k < schemes.size(); ++k) {
      if (!found[k]) break;
      StabilityEntry entry{schemes[k], std::move(*found[k]), {}};
      for (Trial& trial : entry.breaking.trials) {
        entry.points.push_back({on.rows.size(), trial.step, trial.failure});
        on.rows.push_back(std::move(trial.row));
      }
      entry.breaking.trials.clear();
      on.entries.push_back(std::move(entry));
    }
    on.interrupted = runner.stopped();
    if (on.interrupted) break;
  }
  return study;
}

}  // namespace gnomon
