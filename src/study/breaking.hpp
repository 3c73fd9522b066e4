#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "src/study/study.hpp"

namespace gnomon {

/// When a run still counts as a motion of the model. This is a question of stability, not of accuracy: where
/// an energy is constant the path may be wrong.
struct Survival {
  double max_drift = 0.5;  ///< of every invariant, relative to its scale
  /// Of the errors at the end, relative to the size of one that is wrong altogether (MetricInfo::saturation);
  /// looked at only where no energy is constant in the run.
  double max_error = 0.5;
};

/// Why a run does not survive: its status, or what is wrong altogether; empty if it survives.
std::string failure_of(const Scene& scene, const Row& row, const Survival& survival);

/// The same without figures: "energy off", "newton_failed".
std::string failure_kind(const std::string& failure);

/// What counts as surviving, in one line.
std::string survival_line(const Survival& survival);

/// The largest drift of an invariant in a run, relative to its scale; none where nothing is constant.
std::optional<double> largest_drift(const Row& row);

/// Whether the model has an energy that is constant from some time of the scene on.
bool keeps_energy(const Scene& scene);

/// Fewest steps from which a step can be said to survive.
inline constexpr double fewest_steps = 100.0;

/// To what time a step is run: the end of the scene, doubled until that takes `fewest_steps`, s.
double horizon(double t_end, double step);

/// Where the largest step is looked for.
struct StepSearch {
  /// Further steps below the largest one that survives: survival need not be monotone in the step.
  struct Descent {
    int near = 0;       ///< an octave of the step within the first one; 0: no descent
    int far = 1;        ///< an octave beyond; divides `near`
    int octaves = 4;    ///< how far
    int at_most = 256;  ///< trials of a scheme, those of the ladder counted
  };
  double first = 0.0;       ///< smallest step of a ladder of factors of 2, s
  int count = 0;            ///< of its steps
  bool whole = false;       ///< all of them run, also those beyond the first that fails
  double resolution = 2.0;  ///< bisection ends when the two neighbours are this close
  double lowest = 0.0;      ///< where the first one fails, smaller ones are tried down to this; 0: none
  Descent descent;
  Survival survival;
};

struct Trial {
  double step;          ///< as asked for, s
  std::string failure;  ///< empty: survived
  Row row;
};

/// The largest step below which a scheme survives all steps that were tried, and how it fails beyond.
struct Breaking {
  double survived = 0.0;         ///< with all smaller ones that were tried, s; 0 if none is
  std::optional<double> breaks;  ///< the smallest that fails, s; none where the ladder ends first
  std::string how;               ///< why that one failed: its status, or what is wrong altogether
  Status status = Status::ok;    ///< of that run
  std::string message;           ///< of that run
  double t = 0.0;                ///< time it reached, s
  double again = 0.0;            ///< largest step beyond `breaks` that survives all the same, s; 0: none
  std::size_t tried = 0;         ///< steps that were run and not ended by a limit
  double down_to = 0.0;          ///< the smallest of them, s
  std::vector<Trial> trials;     ///< all runs, by step
};

/// The search for one scheme's largest step: the ladder from its smallest step up, then bisection (in the
/// logarithm) between the smallest step that fails and the largest below it that survives, then the descent:
/// a finer ladder downwards from that, jittered so that it shares no steps with the bisection. Where one of
/// its steps fails, bisection and descent begin again below that one. Runs that a limit ended say nothing;
/// the descent stops at the first.
class BreakingSearch {
 public:
  BreakingSearch(const Scene& scene, const StepSearch& search)
      : t_end_(scene.t_end), scene_(scene), search_(search) {}
  /// Steps that are to be run next, whose runs do not depend on each other; none at the end. All have to be
  /// taken before it goes on.
  std::vector<double> next();
  /// The run of a step; `failure` as of failure_of.
  void take(double step, Row row, std::string failure);
  void take(double step, Row row);
  /// As far as it has come.
  Breaking result() &&;

 private:
  struct Bracket {
    const Trial* survived = nullptr;
    const Trial* fails = nullptr;
  };
  Bracket bracket() const;
  bool is_tried(double step) const;
  double whole_part(double step) const;
  std::vector<double> descend(double survived) const;

  double t_end_;
  const Scene& scene_;
  StepSearch search_;
  std::vector<Trial> trials_;  ///< by step
  int begun_ = 0;              ///< steps of the ladder
};

/// Searches for every scheme, every step run to its horizon. Where no energy is constant, the errors are
/// those at the end of the scene, where the reference is. Nothing for one that an interruption ended. Schemes
/// go on side by side where the runner makes several runs at a time, with the same results. `begin` is called
/// before the first run of each.
std::vector<std::optional<Breaking>> find_breakings(Runner& runner, const Scene& scene,
                                                    const ReferenceStates& reference,
                                                    const std::vector<const SchemeInfo*>& schemes,
                                                    const StepSearch& search, const StudyOptions& options,
                                                    const std::function<void(const SchemeInfo&)>& begin);

}  // namespace gnomon
