#pragma once
#include <optional>
#include <string>
#include <vector>

#include "src/measure/order.hpp"
#include "src/study/study.hpp"

namespace gnomon {

/// The observed order of one scheme in one class of error.
struct OrderRow {
  const SchemeInfo* scheme;
  std::string metric;
  ObservedOrder order;
  std::optional<double> expected;
};

struct Convergence : SceneStudy {
  std::vector<OrderRow> orders;  ///< of the fixed-step schemes
};

/// The order that the rows of one scheme of equal steps show in one metric.
OrderRow observed_order(const SceneStudy& study, const SchemeInfo& scheme, std::size_t metric);

/// Error against step (or tolerance) for each chosen scheme.
Convergence converge(Runner& runner, Scene scene, const StudyOptions& options, output::Progress& progress);

/// Number of runs that `converge` makes, for the progress report.
std::size_t converge_runs(const Catalogue& catalogue, const Scene& scene, const StudyOptions& options);

}  // namespace gnomon
