#pragma once
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "src/study/vary.hpp"

namespace gnomon {

struct Catalogue;

/// A drift that somebody else's program has, as published.
struct PublishedDrift {
  std::string name, invariant;
  double max_drift;  ///< relative to the invariant's scale
};

struct DriftPlan {
  std::string label{};  ///< files are called by it; the scene's name unless there is another
  std::string scene;
  double t_end;
  std::optional<double> quick_t_end;  ///< none: not part of a quick study
  std::vector<double> steps;  ///< s; several of them, from "steps" in the file, make a table of large steps
  std::optional<double> tol;
  std::vector<double> error_times;  ///< s; see StudyOptions
  std::vector<std::string> integrators;
  std::vector<PublishedDrift> published;  ///< shown below ours
  std::string source;                     ///< of these
};

/// Work and precision on a scene whose runs are too long for the default ladders.
struct WorkPlan {
  std::string scene;
  std::vector<double> steps, explicit_steps, tols;
  std::vector<std::string> integrators;
  double time_limit = 300.0;  ///< s of one run
  /// CPU s of all repetitions; at least one is made.
  double timing_budget = std::numeric_limits<double>::infinity();
};

struct SpeedPlan {
  std::string scene;
  double step;
  long steps = 100'000;          ///< a run
  std::vector<std::string> set;  ///< changes of the scene, key.path=value
  double parts = 1.0;  ///< equal parts of the system, such as elements, the time is also given for one
  double newton_tol = 1e-10;
  /// A key of the scene that chooses the vector instructions: every set that the machine has is timed.
  std::string instructions_key{};
  bool scalar = false;                     ///< that key knows "scalar", too: none of them
  std::vector<std::string> integrators{};  ///< empty: those of the study
  bool full_only = false;                  ///< left out of a quick study

  /// The sets of instructions that it is about and this machine has, by name.
  std::vector<std::string> instructions() const;
};

/// One class of scenes in the survey of a model.
struct SurveyPlan {
  std::string label;  ///< as it stands in the tables
  std::string scene;
  double step;   ///< s, of the long run and of the timed one
  double t_end;  ///< s, of the long run
  /// A scene of the class on which closed forms run that do not on the first; may be empty.
  std::string closed_form_scene{};
  /// The label as a name.
  std::string key() const;
};

/// Time to given errors, integrators of ours against the peers of the scene's model.
struct PeerPlan {
  std::string scene;
  std::vector<double> levels;  ///< of the error in the first metric, from the greatest on
  std::vector<double> goals;   ///< for each level, the share of the best peer's time that ours is to need
  std::vector<std::string> integrators;
};

/// One key of a scene takes each of several values.
struct VaryPlan {
  std::string label;  ///< files are called by it
  std::string scene;
  Variation variation;
  bool stability = false;           ///< the largest step instead of errors and costs
  std::optional<double> t_end;      ///< s; none: the scene's
  std::vector<std::string> set;     ///< further changes of the scene, key.path=value
  std::vector<double> steps, tols;  ///< empty: the default ladder; one alone: errors without their cost
  std::vector<std::string> integrators;
  double time_limit = 300.0;  ///< s of one run
  /// CPU s of all repetitions on one value; at least one is made.
  double timing_budget = std::numeric_limits<double>::infinity();
  bool full_only = false;  ///< left out of a quick study
};

/// Equilibria of one scene: the error in space of a place that a probe looks at.
struct StaticRefinePlan {
  std::string label;  ///< files are called by it
  std::string scene;
  Variation rows, columns;              ///< the columns are meshes, or values on one mesh a row
  std::vector<std::string> row_set;     ///< one a row, a further change of the scene; empty: none
  std::vector<std::string> set;         ///< further changes of the scene, key.path=value
  std::string probe;                    ///< its name
  std::vector<std::string> components;  ///< of the probe; the error is the length of their differences
  std::vector<std::string> reference;   ///< what makes the mesh fine that a column is compared with
  std::vector<std::string> coarser;     ///< another fine mesh: the difference bounds the reference's error
  std::vector<double> orders;           ///< that are expected, one a row; empty: the columns are no meshes
  std::string meaning;                  ///< shown below the table
};

/// What `bench` does with one model, read from its study.toml.
struct StudyPlan {
  std::vector<std::string> converge, quick_converge, compare, quick_compare;
  std::vector<std::string> scorecard, quick_scorecard;  ///< scenes
  std::vector<std::string> integrators;  ///< that converge, compare and the scorecard show; empty: all
  std::vector<DriftPlan> drift;
  std::vector<WorkPlan> work;  ///< not in a quick study
  std::vector<SpeedPlan> speed;
  std::vector<SurveyPlan> survey;
  std::vector<PeerPlan> peers;
  std::vector<VaryPlan> vary;
  std::vector<StaticRefinePlan> refine;
  bool empty() const;
};

/// Throws UsageError if the file does not fit or has no part; with a catalogue also if its scenes or
/// integrators are not in it or do not go together.
StudyPlan read_study(const std::string& path, const Catalogue* catalogue = nullptr);
/// What stands in the file. Throws UsageError if it cannot be read.
std::string study_text(const std::string& path);
/// The plan of the text of that file.
StudyPlan read_study_text(const std::string& text, const std::string& path,
                          const Catalogue* catalogue = nullptr);

}  // namespace gnomon
