#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "src/study/study.hpp"

namespace gnomon {

/// When a run still counts as a motion of the model.
struct Survival {
  double max_drift = 0.5;  ///< of every invariant, relative to its scale
  /// Of the errors at the end, relative to the size of one that is wrong altogether (MetricInfo::saturation);
  /// looked at only where no energy is constant in the run.
  double max_error = 0.5;
};

/// Why a run does not survive: its status, or what is wrong altogether; empty if it survives.
std::string failure_of(const Scene& scene, const Row& row, const Survival& survival);

/// What counts as surviving, in one line.
std::string survival_line(const Survival& survival);

/// The largest drift of an invariant in a run, relative to its scale; none where nothing is constant.
std::optional<double> largest_drift(const Row& row);

/// Where the largest step is looked for.
struct StepSearch {
  double first = 0.0;       ///< smallest step of a ladder of factors of 2, s
  int count = 0;            ///< of its steps
  bool whole = false;       ///< all of them run, also those beyond the first that fails
  double resolution = 2.0;  ///< bisection ends when the two neighbours are this close
  double lowest = 0.0;      ///< where the first one fails, smaller ones are tried down to this; 0: none
  Survival survival;
};

struct Trial {
  double step;          ///< as asked for, s
  std::string failure;  ///< empty: survived
  Row row;
};

/// The largest step that a scheme survives, and how it fails beyond.
struct Breaking {
  double survived = 0.0;         ///< with all smaller ones that were tried, s; 0 if none is
  std::optional<double> breaks;  ///< the next larger one that was tried, s; none where the ladder ends first
  std::string how;               ///< why that one failed: its status, or what is wrong altogether
  Status status = Status::ok;    ///< of that run
  std::string message;           ///< of that run
  double t = 0.0;                ///< time it reached, s
  std::vector<Trial> trials;     ///< all runs, by step
};

/// The search for one scheme's largest step: the ladder from its smallest step up, then bisection (in the
/// logarithm) between the last step that survives and the first that does not.
class BreakingSearch {
 public:
  BreakingSearch(const Scene& scene, const StepSearch& search) : scene_(scene), search_(search) {}
  /// Steps that are to be run next, whose runs do not depend on each other; none at the end. All have to be
  /// taken before it goes on.
  std::vector<double> next();
  void take(double step, Row row);
  /// As far as it has come.
  Breaking result() &&;

 private:
  bool is_open() const;

  const Scene& scene_;
  StepSearch search_;
  Breaking breaking_;
  int begun_ = 0;  ///< steps of the ladder
  std::optional<double> smaller_;
};

/// Searches for every scheme; nothing for one that an interruption ended. Schemes go on side by side where
/// the runner makes several runs at a time, with the same results. `begin` is called before the first run of
/// each.
std::vector<std::optional<Breaking>> find_breakings(Runner& runner, const Scene& scene,
                                                    const ReferenceStates& reference,
                                                    const std::vector<const SchemeInfo*>& schemes,
                                                    const StepSearch& search, const StudyOptions& options,
                                                    const std::function<void(const SchemeInfo&)>& begin);

}  // namespace gnomon
