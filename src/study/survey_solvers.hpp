#pragma once
#include <optional>
#include <string>
#include <vector>

#include "src/measure/drift.hpp"
#include "src/output/table.hpp"
#include "src/study/json.hpp"
#include "src/study/study.hpp"
#include "src/study/study_file.hpp"

namespace gnomon {

/// The tolerance at which schemes that choose their steps are surveyed.
inline constexpr double survey_tol = 1e-8;

/// What one scheme that chooses its steps, or a closed form, does on one class of scenes.
struct SolverEntry {
  const SchemeInfo* scheme;
  std::string scene;              ///< the class's, or its other one with a closed form
  Row run;                        ///< to the end of the scene; its timing, if it was timed
  double own_bound;               ///< of a closed form on its error in the first metric; else NaN
  Status status = Status::ok;     ///< of the long run; that of `run` if there was none
  std::vector<std::string> held;  ///< invariants that the long run keeps to roundoff
  std::optional<Drift> energy;
  /// The loosest tolerance that does, with all tighter ones, and the first that does not, with the reason:
  /// to end well and to keep every invariant to a hundredth of its scale.
  std::optional<double> loosest, off_at;
  std::string off_how;
};

/// One class of scenes, its scene loaded.
struct SolverClass {
  SurveyPlan plan;
  std::string metric, unit;  ///< of the error shown
  std::vector<SolverEntry> entries;
};

/// The schemes that choose their steps and the closed forms on the scenes of a class, negative controls
/// included, as a run to the end of the scene, a long run and runs at ever looser tolerances. A scheme whose
/// first run does not end well makes no others. `plan.t_end` is that of the long run of equal steps; here it
/// has at most 20000 of them.
SolverClass survey_solvers(Runner& runner, const SurveyPlan& plan, const StudyOptions& options,
                           output::Progress& progress);

/// Times the runs to the end of the scene, interleaved.
void time_solvers(Runner& runner, std::vector<SolverClass>& classes, const StudyOptions& options);

/// Number of parts that `survey_solvers` reports as progress.
std::size_t survey_solver_runs(const Catalogue& catalogue, const SurveyPlan& plan);

/// Errors, steps, evaluations and times.
output::Table solver_cost_table(const std::string& model, const std::vector<SolverClass>& classes);
/// Invariants held, energy and the first tolerance that is off by 1 %.
output::Table solver_stability_table(const std::string& model, const std::vector<SolverClass>& classes);
/// Appends one entry a scheme and class.
void add_solvers(const std::vector<SolverClass>& classes, nlohmann::ordered_json& list);

}  // namespace gnomon
