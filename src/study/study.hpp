#pragma once
#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "src/catalogue.hpp"
#include "src/measure/timing.hpp"
#include "src/output/progress.hpp"
#include "src/reference.hpp"
#include "src/run.hpp"
#include "src/scene.hpp"

namespace gnomon {

/// What a command was told about its runs.
struct StudyOptions {
  std::vector<std::string>
      integrators;            ///< empty: every one that runs on the scene, negative controls left out
  std::vector<double> steps;  ///< s; empty: the default ladder
  std::vector<double> tols;   ///< empty: the default ladder
  int samples = 0;
  int watch = 256;
  long max_steps = 100'000'000;
  double time_limit = 600.0;  ///< s
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

/// One run with its error against the scene's reference.
struct Row {
  const SchemeInfo* scheme = nullptr;
  Setting setting;
  SchemeOptions options;
  RunResult result;
  std::vector<double> error;  ///< one a metric; empty when there is no reference or the run did not end well
  std::vector<bool> below_bound;  ///< the error is not above the reference's bound, which stands in its place
  std::optional<TimingStats> timing;
  long evaluations() const { return result.cost.rhs; }
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
  Runner(const Catalogue& catalogue, ReferenceStore& references, const std::atomic<bool>& stop)
      : catalogue_(catalogue), references_(references), stop_(stop) {}

  const Catalogue& catalogue() const { return catalogue_; }
  bool stopped() const { return stop_.load(std::memory_order_relaxed); }
  /// The reference at t_end, or an empty one with --no-reference.
  ReferenceStates reference(const Scene& scene, const StudyOptions& options);
  Row run(const Scene& scene, const ReferenceStates& reference, const SchemeInfo& scheme,
          const Setting& setting, const StudyOptions& options);
  /// Times the rows that ended well, interleaved, each at least 5 times and 20 ms.
  void time(const Scene& scene, std::vector<Row>& rows, const StudyOptions& options);

 private:
  RunSpec spec(const Scene& scene, const Setting& setting, const StudyOptions& options) const;

  const Catalogue& catalogue_;
  ReferenceStore& references_;
  const std::atomic<bool>& stop_;
};

/// The integrators a study is to run on a scene. Throws UsageError for a name that does not exist or does not
/// fit.
std::vector<const SchemeInfo*> select(const Catalogue& catalogue, const Scene& scene,
                                      const StudyOptions& options);

/// Steps t_end / N with N = N0 2^(k ratio), N0 from the time scale of the motion; `count` of them.
std::vector<double> step_ladder(const Scene& scene, int count, double ratio);

/// The settings of one scheme: the given ones, else the ladder of steps or tolerances.
std::vector<Setting> settings(const SchemeInfo& scheme, const StudyOptions& options,
                              const std::vector<double>& steps, const std::vector<double>& tols);

/// An invariant along a run, as its drift relative to its scale.
struct InvariantSummary {
  InvariantInfo info;
  std::vector<double> initial;  ///< at `since`, or at the start
  std::vector<double> final;
  double max_drift = 0.0;
  double slope = 0.0;         ///< of the drift, 1/s
  std::vector<double> times;  ///< from `since` on
  std::vector<double> drift;  ///< signed for a scalar, a norm for a vector
};
std::vector<InvariantSummary> summarise_invariants(const AnyModel& model, const Trace& trace);

}  // namespace gnomon
