#pragma once
#include "src/output/figure.hpp"
#include "src/output/table.hpp"
#include "src/study/json.hpp"
#include "src/study/refine.hpp"

namespace gnomon {

/// One row a mesh: errors in space, largest error in time, status.
output::Table refinement_table(const Refinement& study);
output::Table refinement_orders_table(const Refinement& study);
/// Error in space against 1 / value, one line a metric.
output::Figure refinement_figure(const Refinement& study);
/// Runs with "refine": {key: value} and "time_error", and orders.
void add_refinement(Document& document, const Refinement& study);

}  // namespace gnomon
