#pragma once
#include <string>

#include "src/output/figure.hpp"
#include "src/study/compare.hpp"
#include "src/study/converge.hpp"
#include "src/study/drift_study.hpp"

namespace gnomon {

/// Error against step, or against the tolerance in a second panel.
output::Figure convergence_figure(const Catalogue& catalogue, const Convergence& study);
/// Error against CPU time and against evaluations, with the Pareto fronts.
output::Figure work_precision_figure(const Catalogue& catalogue, const Comparison& study);
/// |drift| of one invariant against time; where schemes ran at several steps or tolerances, the largest
/// |drift| against those. What exceeds ten times the invariant's scale is a cross at the top, like a run that
/// failed.
output::Figure drift_figure(const Catalogue& catalogue, const DriftStudy& study,
                            const std::string& invariant);

}  // namespace gnomon
