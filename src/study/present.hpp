#pragma once
#include <string>
#include <vector>

#include "src/output/figure.hpp"
#include "src/output/table.hpp"
#include "src/study/compare.hpp"
#include "src/study/converge.hpp"
#include "src/study/drift_study.hpp"
#include "src/study/vary.hpp"

namespace gnomon {

/// The reference's kind and bounds in one line.
std::string reference_line(const SceneStudy& study);

/// The cost of a level: microseconds of CPU time, or evaluations; an upper bound with its sign.
output::Cell microseconds_cell(const std::optional<LevelCost>& cost);
output::Cell evaluations_cell(const std::optional<LevelCost>& cost);

/// One row a run: setting, errors, evaluations, CPU time, status.
output::Table runs_table(const SceneStudy& study, const std::string& caption);
/// The same of a comparison, the Pareto front marked.
output::Table comparison_table(const Comparison& study, const std::string& caption);
output::Table orders_table(const Convergence& study);
/// What every second of the levels of the error costs.
output::Table costs_table(const Comparison& study);
/// What errors cost on the variants of one scene: one row an integrator and level, one column a value.
output::Table varied_costs_table(const std::vector<Comparison>& variants, const Variation& variation);
output::Figure varied_costs_figure(const Catalogue& catalogue, const std::vector<Comparison>& variants,
                                   const Variation& variation);
output::Table drift_table(const DriftStudy& study);
/// One row a run: what becomes of every invariant, how the run ended and the time it reached.
output::Table drift_runs_table(const DriftStudy& study);

/// Error against step, or against the tolerance in a second panel.
output::Figure convergence_figure(const Catalogue& catalogue, const Convergence& study);
/// Error against CPU time and against evaluations.
output::Figure work_precision_figure(const Catalogue& catalogue, const Comparison& study);
/// |drift| of one invariant against time.
output::Figure drift_figure(const Catalogue& catalogue, const DriftStudy& study,
                            const std::string& invariant);

}  // namespace gnomon
