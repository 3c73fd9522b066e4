#pragma once
#include <optional>
#include <string>
#include <vector>

#include "src/study/breaking.hpp"
#include "src/study/vary.hpp"

namespace gnomon {

/// What one scheme of equal steps survives; the runs themselves are rows of the study.
struct StabilityEntry {
  struct Point {
    std::size_t row;      ///< of SceneStudy::rows
    double step;          ///< as asked for, s
    std::string failure;  ///< empty: survived
  };
  const SchemeInfo* scheme;
  Breaking breaking;          ///< without its trials
  std::vector<Point> points;  ///< by step
  /// Steps beyond the first that fails which survive all the same, s.
  std::vector<double> islands() const;
};

/// All schemes on one scene, or on one variant of it.
struct StabilityScene : SceneStudy {
  std::vector<StabilityEntry> entries;
};

/// Variants of one scene, or the scene alone. All run the same ladder of steps.
struct Stability {
  std::string name;                    ///< of the scene without its variation
  std::optional<Variation> variation;  ///< none: one scene, as it is
  StepSearch search;
  std::vector<StabilityScene> scenes;
  bool interrupted() const { return !scenes.empty() && scenes.back().interrupted; }
};

/// Steps that divide the run into equal parts, by factors of 2 from about a 64th of the shortest time scale
/// of the scenes to 64 times the longest, at most an eighth of the scene; smaller ones where that fails. The
/// descent goes over a factor of 16, in a quick study with fewer steps.
StepSearch stability_search(const std::vector<Scene>& scenes, bool quick = false);

/// The schemes of equal steps among the chosen ones. Throws UsageError where another one was named.
std::vector<const SchemeInfo*> equal_step_schemes(const Catalogue& catalogue, const Scene& scene,
                                                  const StudyOptions& options);

/// The largest step of every scheme of equal steps on every scene. All scenes are variants of one.
Stability stability(Runner& runner, const std::vector<Scene>& scenes,
                    const std::optional<Variation>& variation, const Survival& survival,
                    const StudyOptions& options, output::Progress& progress);

}  // namespace gnomon
