#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "src/measure/drift.hpp"
#include "src/output/table.hpp"
#include "src/study/breaking.hpp"
#include "src/study/compare.hpp"
#include "src/study/converge.hpp"

namespace gnomon {

/// What one scheme does on one scene, on one line.
struct Score {
  const SchemeInfo* scheme;
  ObservedOrder order;  ///< of the first metric; of schemes of equal steps
  std::optional<double> declared;
  std::vector<std::optional<LevelCost>> seconds, evaluations;  ///< one a level of the scorecard
  std::optional<Drift> energy;                                 ///< of the long run
  Status long_run = Status::ok;                                ///< how that ended
  std::optional<Breaking> breaking;                            ///< of schemes of equal steps
  int runs = 0, failed = 0;                                    ///< of the ladder of steps or tolerances
  std::string first_failure;  ///< setting and reason of the loosest one that failed
};

struct Scorecard {
  Comparison comparison;       ///< the ladder
  std::vector<double> levels;  ///< of the error in the first metric: 3, 6 and 9 digits
  double long_t_end = 0.0;     ///< s
  std::vector<Score> scores;
  bool interrupted = false;
};

/// Order, cost, energy over a thousand time scales (a tenth of one the step, 1e-8 the tolerance), largest
/// step and failures of every chosen scheme. The ladders are those of `compare`.
Scorecard scorecard(Runner& runner, const Scene& scene, const StudyOptions& options,
                    output::Progress& progress);

/// Number of parts that `scorecard` reports as progress.
std::size_t scorecard_runs(const Catalogue& catalogue, const Scene& scene, const StudyOptions& options);

/// One scene: what the errors cost, and the steps, in their units.
output::Table scorecard_table(const Scorecard& card);
/// All scenes at once, one row a scheme: costs relative to the cheapest scheme of each scene, largest steps
/// to the scene's time scale, and the worst energy, so that scenes of any size can stand together.
output::Table joint_scorecard_table(const std::string& heading, const std::vector<Scorecard>& cards);
/// One entry a scheme.
nlohmann::ordered_json scorecard_json(const Scorecard& card);

}  // namespace gnomon
