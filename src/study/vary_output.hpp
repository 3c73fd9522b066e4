#pragma once
#include <cstddef>
#include <vector>

#include "src/output/figure.hpp"
#include "src/output/table.hpp"
#include "src/study/compare.hpp"
#include "src/study/vary.hpp"

namespace gnomon {

/// An empty panel over the values of the variation: its axis, or the numbers of the values where they have
/// none.
output::Panel varied_panel(const Variation& variation);
/// Where the value of a number (from 0) stands on it.
double varied_x(const Variation& variation, std::size_t of);

// Comparisons on the variants of one scene, one a value of the variation.

/// What errors cost: one row an integrator and level, one column a value.
output::Table varied_costs_table(const std::vector<Comparison>& variants, const Variation& variation);
output::Figure varied_costs_figure(const Catalogue& catalogue, const std::vector<Comparison>& variants,
                                   const Variation& variation);
/// Errors of the first metric: one row an integrator and setting, one column a value; first the bound of the
/// reference.
output::Table varied_errors_table(const std::vector<Comparison>& variants, const Variation& variation);
/// The same; the bound of the reference as a curve.
output::Figure varied_errors_figure(const Catalogue& catalogue, const std::vector<Comparison>& variants,
                                    const Variation& variation);
/// One row a run.
output::Table varied_runs_table(const std::vector<Comparison>& variants, const Variation& variation);

/// Costs where a scheme ran at several settings, then errors.
std::vector<output::Table> varied_tables(const std::vector<Comparison>& variants, const Variation& variation);
/// Costs where a scheme ran at several settings, else errors.
output::Figure varied_figure(const Catalogue& catalogue, const std::vector<Comparison>& variants,
                             const Variation& variation);

}  // namespace gnomon
