#pragma once
#include <string>
#include <vector>

#include "src/output/table.hpp"
#include "src/study/compare.hpp"
#include "src/study/converge.hpp"
#include "src/study/drift_study.hpp"

namespace gnomon {

/// The reference's kind and bounds in one line.
std::string reference_line(const Scene& scene, const ReferenceStates& reference);
std::string reference_line(const SceneStudy& study);

/// How the cost of a level is found, for a note.
inline constexpr const char* levels_note =
    "the cheapest setting that counts: it and the next two tighter ones reach the level; log-log to the next "
    "looser one, ≤: it is the loosest one, or the next looser one failed; °: there are fewer than two "
    "tighter "
    "ones; the rates are those of the setting that is cheapest in CPU time; — not reached";

/// Inserts a column with the linear solver that was asked for, where it is not the default; `schemes` are
/// those of the rows.
void name_linear_solver(const SceneStudy& study, const std::vector<const SchemeInfo*>& schemes,
                        output::Table& table);

/// The scheme's position in the catalogue, so that it looks the same in every figure.
int style_of_scheme(const Catalogue& catalogue, const SchemeInfo& scheme);
/// An error, with a sign where it is not above the bound of the reference.
output::Cell error_cell(const Row& row, std::size_t metric);
/// The cost of a level: microseconds of CPU time, or evaluations; an upper bound and one that rests on few
/// settings with their signs.
output::Cell microseconds_cell(const std::optional<LevelCost>& cost);
output::Cell evaluations_cell(const std::optional<LevelCost>& cost);

/// The observed order, in brackets the declared one where it differs; a mark where there is none.
output::Cell order_cell(const ObservedOrder& order, const std::optional<double>& declared);
/// What the marks mean, for a note.
inline constexpr const char* order_marks =
    "in brackets the declared order where the observed one differs; → 4: no order yet, the local slopes "
    "still "
    "move towards the declared one; exact, roundoff: no order, the error is at roundoff at every step, of a "
    "scheme without or with a declared order; — no asymptotic range";
/// Why drifts are undecided, each with its integrator, setting and invariant; empty if none is.
std::string undecided_note(const DriftStudy& study);

/// One row a run: setting, errors, evaluations, CPU time, status.
output::Table runs_table(const SceneStudy& study, const std::string& caption);
/// The same of a comparison, the Pareto front marked.
output::Table comparison_table(const Comparison& study, const std::string& caption);
output::Table orders_table(const Convergence& study);
/// What every second of the levels of the error costs.
output::Table costs_table(const Comparison& study);
output::Table drift_table(const DriftStudy& study);
/// One row a run: what becomes of every invariant, how the run ended and the time it reached.
output::Table drift_runs_table(const DriftStudy& study);

}  // namespace gnomon
