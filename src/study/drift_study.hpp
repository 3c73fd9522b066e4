#pragma once
#include <optional>
#include <string>
#include <vector>

#include "src/measure/drift.hpp"
#include "src/measure/drift_scaling.hpp"
#include "src/study/study.hpp"

namespace gnomon {

/// The drift of one invariant in one run.
struct DriftRow {
  std::size_t row;  ///< of SceneStudy::rows
  InvariantSummary invariant;
  Drift drift;
};

/// The errors of the same runs at a time before their end.
struct ErrorsBefore {
  Scene scene;  ///< ends there
  ReferenceStates reference;
  std::vector<Row> rows;  ///< one a row of the study
};

struct DriftStudy : SceneStudy {
  std::vector<DriftRow> drifts;
  bool error_at_end = true;  ///< it is looked at there, too
  std::vector<ErrorsBefore> before;
  /// A scheme ran at more than one step or tolerance.
  bool has_ladder() const;
};

/// Long runs, their invariants sampled at jittered times so that no period is aliased, the trajectory error
/// beside them: at the end, or where no reference reaches so far at the `error_times` of the options, from
/// runs with the same settings that end there. Where an invariant's drift may be biased rounding or the
/// truncation of the scheme, another run at half the step decides, which is not shown.
DriftStudy drift(Runner& runner, Scene scene, const StudyOptions& options, output::Progress& progress);

/// How the drift of an invariant falls with the step, over the runs of a scheme that ended well.
std::optional<DriftScaling> h_scaling(const DriftStudy& study, const SchemeInfo& scheme,
                                      const std::string& invariant);

std::size_t drift_runs(const Catalogue& catalogue, const Scene& scene, const StudyOptions& options);

}  // namespace gnomon
