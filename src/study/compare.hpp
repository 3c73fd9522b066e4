#pragma once
#include <optional>
#include <vector>

#include "src/measure/work.hpp"
#include "src/study/study.hpp"

namespace gnomon {

/// What it costs one scheme to reach an error in the first metric.
struct CostRow {
  const SchemeInfo* scheme;
  std::vector<std::optional<LevelCost>> seconds;      ///< one a level
  std::vector<std::optional<LevelCost>> evaluations;  ///< one a level
};

/// The scheme that reaches every error from `from` down to `to` in the least CPU time.
struct Cheapest {
  const SchemeInfo* scheme;
  double from, to;
};

struct Comparison : SceneStudy {
  std::vector<double> levels;  ///< errors in the unit of the first metric, decades from 1e-2 to 1e-12
  std::vector<CostRow> costs;
  std::vector<Cheapest> cheapest;  ///< from 0.1 of the first metric's unit down; where it changes they cross
  /// For each row, whether no other run reaches its error or less in less CPU time, or with fewer
  /// evaluations.
  std::vector<bool> front_in_time, front_in_evaluations;
};

/// Error against cost, a ladder of steps or tolerances for each scheme, timed interleaved. Default ladders go
/// on to looser settings, by factors of 2 and 10, as long as the run ends well and its error is not above the
/// loosest level, so that the cost of a level does not depend on where they begin.
Comparison compare(Runner& runner, Scene scene, const StudyOptions& options, output::Progress& progress);

/// What errors of other levels cost a scheme.
CostRow costs_of(const Comparison& study, const SchemeInfo& scheme, const std::vector<double>& levels);

/// The next looser setting: half the number of steps, down to one, or ten times the tolerance, up to 0.1;
/// none beyond.
std::optional<Setting> looser(const Scene& scene, const Setting& setting);

std::size_t compare_runs(const Catalogue& catalogue, const Scene& scene, const StudyOptions& options);

}  // namespace gnomon
