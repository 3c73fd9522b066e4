#pragma once
#include <atomic>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "src/catalogue.hpp"
#include "src/measure/drift.hpp"
#include "src/measure/timing.hpp"
#include "src/output/progress.hpp"
#include "src/reference.hpp"
#include "src/run.hpp"
#include "src/scene.hpp"

namespace gnomon {

class Keeper;

/// What a command was told about its runs.
struct StudyOptions {
  std::vector<std::string>
      integrators;            ///< empty: every one that runs on the scene, negative controls left out
  std::vector<double> steps;  ///< s; empty: the default ladder
  std::vector<double> explicit_steps;  ///< s, of schemes with a fixed number of stages; empty: `steps`
  std::vector<double> tols;            ///< empty: the default ladder
  /// s, up to the end; of `drift`: where the errors of its runs are looked at. Empty: at the end.
  std::vector<double> error_times;
  int samples = 0;
  int watch = 256;
  long max_steps = 100'000'000;
  double time_limit = 600.0;  ///< s
  /// CPU s for the repetitions of all runs on a scene; each is repeated at least once.
  double timing_budget = std::numeric_limits<double>::infinity();
  SchemeOptions scheme;
  bool reference = true;
  bool timing = true;
  bool quick = false;
};

/// A step or a tolerance; a closed form has neither.
struct Setting {
  std::optional<double> step;
  std::optional<double> tol;
  std::string text() const;
};

/// An invariant along a run, as its drift relative to its scale.
struct InvariantSummary {
  InvariantInfo info;
  std::vector<double> initial;  ///< at `since`, or at the start
  std::vector<double> final;
  double max_drift = 0.0;
  double slope = 0.0;         ///< of the drift, 1/s
  Drift measured;             ///< all that is known of the drift
  std::vector<double> times;  ///< from `since` on
  std::vector<double> drift;  ///< signed for a scalar, a norm for a vector
};

/// One run with its error against the scene's reference.
struct Row {
  const SchemeInfo* scheme = nullptr;
  Setting setting;
  SchemeOptions options;
  RunResult result;
  std::vector<double> error;  ///< one a metric; empty when there is no reference or the run did not end well
  std::vector<bool> below_bound;  ///< the error is not above the reference's bound, which stands in its place
  std::optional<TimingStats> timing;
  /// Of the run, thinned to twelve points a decade of its time, each with the largest |drift| so far.
  std::vector<InvariantSummary> invariants;
  nlohmann::ordered_json document;  ///< what was stored of the run, as documents show it; null: not stored
  long evaluations() const { return result.cost.rhs; }
};

/// One of several runs on a scene.
struct RunPlan {
  const SchemeInfo* scheme = nullptr;
  Setting setting;
};

/// All runs on one scene.
struct SceneStudy {
  Scene scene;
  ReferenceStates reference;
  std::vector<Row> rows;
  bool interrupted = false;
};

/// Makes runs on behalf of the studies.
class Runner {
 public:
  Runner(const Catalogue& catalogue, ReferenceStore& references, const std::atomic<bool>& stop, int jobs = 1)
      : catalogue_(catalogue), references_(references), stop_(stop), jobs_(jobs) {}

  const Catalogue& catalogue() const { return catalogue_; }
  bool stopped() const { return stop_.load(std::memory_order_relaxed); }
  /// The reference at t_end, or an empty one with --no-reference.
  ReferenceStates reference(const Scene& scene, const StudyOptions& options);
  /// Keeps every measurement from here on, made in a child process of its own; see Keeper.
  void keep_in(Keeper* keeper) { keeper_ = keeper; }
  Keeper* keeper() const { return keeper_; }
  /// Runs made at a time.
  int jobs() const;
  Row run(const Scene& scene, const ReferenceStates& reference, const SchemeInfo& scheme,
          const Setting& setting, const StudyOptions& options);
  /// Runs that do not depend on each other, in the order of `plans`, up to the `jobs` of the constructor at a
  /// time in child processes; the rows do not depend on how many. Fewer if the user interrupts. `begin` is
  /// called before each.
  std::vector<Row> run_each(const Scene& scene, const ReferenceStates& reference,
                            const std::vector<RunPlan>& plans, const StudyOptions& options,
                            const std::function<void(const RunPlan&)>& begin);
  /// Times the rows that ended well, interleaved, each at least 5 times and 20 ms. Nothing else runs
  /// meanwhile, and the process that is timed stays on one core (see timing_core).
  void time(const Scene& scene, std::vector<Row>& rows, const StudyOptions& options);
  /// Times tasks of any kind in turn. `identity` says what is timed and `names`, one a task, what each does.
  /// One that ends its process has no times.
  std::vector<TimingStats> time(std::string_view kind, const nlohmann::ordered_json& identity,
                                const std::vector<std::string>& names, const std::vector<TimedTask>& tasks,
                                TimingPlan plan);
  /// What `work` gives, whether kept or made; null if it failed.
  nlohmann::ordered_json measure(std::string_view kind, const nlohmann::ordered_json& identity, bool timed,
                                 const std::function<nlohmann::ordered_json()>& work);

 private:
  Row run_here(const Scene& scene, const ReferenceStates& reference, const SchemeInfo& scheme,
               const Setting& setting, const StudyOptions& options);
  std::vector<Row> run_in_children(const Scene& scene, const ReferenceStates& reference,
                                   const std::vector<RunPlan>& plans, const StudyOptions& options,
                                   const std::function<void(const RunPlan&)>& begin);
  RunSpec spec(const Scene& scene, const Setting& setting, const StudyOptions& options) const;

  const Catalogue& catalogue_;
  ReferenceStore& references_;
  const std::atomic<bool>& stop_;
  int jobs_ = 1;
  Keeper* keeper_ = nullptr;
};

/// Why no integrator of that name runs on a scene, as "found .., expected .."; empty if one does.
std::string misfit(const Catalogue& catalogue, const Scene& scene, const std::string& name);

/// The integrators a study is to run on a scene. Throws UsageError, in the name of `option`, for a name that
/// does not exist or does not fit.
std::vector<const SchemeInfo*> select(const Catalogue& catalogue, const Scene& scene,
                                      const StudyOptions& options, std::string_view option = "--integrators");

/// Whether a scheme of equal steps declares order 6 or more on the scene: its error is at roundoff at steps
/// at which others begin.
bool is_of_high_order(const Scene& scene, const SchemeInfo& scheme);

/// Steps t_end / N with N = N0 2^(k ratio); `count` of them. The first is half the time scale of the motion,
/// or four of them for schemes of high order. N is rounded to a multiple that meets the breaks of the model's
/// data where a small one does.
std::vector<double> step_ladder(const Scene& scene, const SchemeInfo& scheme, int count, double ratio);

/// The settings of one scheme: the given ones, else the ladder of steps or tolerances.
std::vector<Setting> settings(const SchemeInfo& scheme, const StudyOptions& options,
                              const std::vector<double>& steps, const std::vector<double>& tols);

/// The drifts of a run with so many evaluations; see rounding_level.
std::vector<InvariantSummary> summarise_invariants(const AnyModel& model, const Trace& trace,
                                                   double evaluations = 0.0);
/// Of rates or moments, Newton iterations or steps, whichever are most.
double count_evaluations(const Cost& cost);
/// Wall-clock time after which a run that does not look at its own limit is ended, s.
double patience(const StudyOptions& options);
/// Twelve points a decade of time of the largest |drift| so far: enough to see growth.
void thin(InvariantSummary& summary);

}  // namespace gnomon
