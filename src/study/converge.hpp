#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/measure/floor.hpp"
#include "src/measure/order.hpp"
#include "src/study/study.hpp"

namespace gnomon {

/// What keeps the error from falling further.
enum class FloorKind {
  roundoff,  ///< it does not fall when nonlinear equations are solved 100 times as exactly, or there are none
  newton     ///< it does
};
constexpr std::string_view to_string(FloorKind kind) {
  return kind == FloorKind::newton ? "Newton" : "roundoff";
}

/// The observed order of one scheme in one class of error.
struct OrderRow {
  const SchemeInfo* scheme;
  std::string metric;
  ObservedOrder order;
  std::optional<double> expected;
  std::optional<ErrorFloor> floor;      ///< if the error stops falling within the ladder
  std::optional<FloorKind> floor_kind;  ///< if it is known
};

struct Convergence : SceneStudy {
  std::vector<OrderRow> orders;  ///< of the fixed-step schemes
};

/// The order that the rows of one scheme of equal steps show in one metric.
OrderRow observed_order(const SceneStudy& study, const SchemeInfo& scheme, std::size_t metric);

/// The kind of a floor from the error at one of its steps and the error there with a Newton tolerance a
/// hundredth as large: Newton if that is below a fifth, more than the scatter of roundoff.
FloorKind floor_kind_of(double error, double tightened);

/// Error against step (or tolerance) for each chosen scheme.
Convergence converge(Runner& runner, Scene scene, const StudyOptions& options, output::Progress& progress);

/// Number of runs that `converge` makes, for the progress report.
std::size_t converge_runs(const Catalogue& catalogue, const Scene& scene, const StudyOptions& options);

}  // namespace gnomon
