#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/scene.hpp"
#include "src/scene_reader.hpp"
#include "src/study/study_file.hpp"

namespace gnomon {

/// Checks what a study's file names against what exists: its scenes, and whether its integrators run on them.
/// Throws UsageError with file, line and key. Without a catalogue all is taken as it stands.
class StudyCheck {
 public:
  explicit StudyCheck(const Catalogue* catalogue) : catalogue_(catalogue) {}

  /// Scenes that a list names.
  void scenes(const Section& root, std::string_view key, const std::vector<std::string>& names);
  /// The integrators of the whole study: all are known, and some of them run on each scene of the lists.
  void shared_integrators(const Section& root, const std::vector<std::string>& names) const;
  void drift(const Section& section, const DriftPlan& plan) const;
  void work(const Section& section, const WorkPlan& plan) const;
  void speed(const Section& section, const SpeedPlan& plan) const;
  void survey(const Section& section, const SurveyPlan& plan) const;
  void peers(const Section& section, const PeerPlan& plan) const;
  void vary(const Section& section, const VaryPlan& plan) const;
  void refine(const Section& section, const StaticRefinePlan& plan) const;

 private:
  Scene load(const Section& section, std::string_view key, const std::string& name,
             const SceneChanges& changes = {}, std::optional<std::size_t> entry = std::nullopt) const;
  /// All of them run on the scene.
  void integrators(const Section& section, const std::vector<std::string>& names, const Scene& scene) const;

  const Catalogue* catalogue_;
  std::vector<Scene> listed_;  ///< all that lists have named
};

}  // namespace gnomon
