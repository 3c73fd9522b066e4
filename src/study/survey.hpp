#pragma once
#include <optional>
#include <string>
#include <vector>

#include "src/measure/drift.hpp"
#include "src/measure/order.hpp"
#include "src/measure/timing.hpp"
#include "src/output/table.hpp"
#include "src/study/breaking.hpp"
#include "src/study/json.hpp"
#include "src/study/study.hpp"
#include "src/study/study_file.hpp"
#include "src/study/survey_solvers.hpp"

namespace gnomon {

/// What one scheme of equal steps does on one class of scenes.
struct SurveyEntry {
  const SchemeInfo* scheme;
  ObservedOrder order;  ///< of the first metric
  std::optional<double> declared;
  Cost cost;                      ///< of the run to `drift_t_end`
  Status status = Status::ok;     ///< of that run
  std::vector<std::string> held;  ///< invariants that it keeps to roundoff
  std::optional<Drift> energy;
  Breaking breaking;
  TimingStats run;                   ///< of the timed run, s
  Status timed_status = Status::ok;  ///< of that run
  std::string timed_failure;         ///< why it has no time
  long timed_steps = 0;
};

struct SurveyClass {
  SurveyPlan plan;
  Scene scene;
  std::vector<SurveyEntry> entries;
};

struct Survey {
  std::string model;
  std::vector<SurveyClass> classes;
  std::vector<SolverClass> solvers;  ///< the same classes
  bool interrupted = false;
};

/// Every scheme of equal steps on one scene of each class: order, cost, invariants, drift of the energy, and
/// the step at which it is off by 1 %, in an invariant or, where no energy is constant, in its errors; beside
/// them those that choose their steps and the closed forms.
Survey survey(Runner& runner, const std::string& model, const std::vector<SurveyPlan>& plans,
              const StudyOptions& options, output::Progress& progress);

/// Number of parts that `survey` reports as progress.
std::size_t survey_runs(const Catalogue& catalogue, const std::vector<SurveyPlan>& plans, bool quick);

/// Orders, evaluations and time of a step.
output::Table survey_cost_table(const Survey& survey);
/// Invariants held, energy and the first step that is off by 1 %.
output::Table survey_stability_table(const Survey& survey);
/// These and the tables of the schemes that choose their steps.
std::vector<output::Table> survey_tables(const Survey& survey);
nlohmann::ordered_json survey_json(const Survey& survey);

}  // namespace gnomon
