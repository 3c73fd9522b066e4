#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "src/measure/order.hpp"
#include "src/output/figure.hpp"
#include "src/output/table.hpp"
#include "src/study/study.hpp"
#include "src/study/study_file.hpp"

namespace gnomon {

/// The equilibrium of one variant of the scene: where the probe is, against the finest mesh.
struct StaticError {
  Status status = Status::interrupted;  ///< interrupted: not made
  std::string message;
  std::optional<double> error;  ///< none where it or its reference has no equilibrium
  bool below_bound = false;  ///< the error is not above the bound of its reference, which stands in its place
};

/// Errors in space of the equilibria of one scene, one row and one column a value.
struct StaticRefinement {
  StaticRefinePlan plan;
  std::string unit;                              ///< of the errors
  std::vector<std::vector<StaticError>> errors;  ///< by row, then by column
  std::vector<double> bounds;         ///< of the references, by column; not finite where there is none
  std::vector<ObservedOrder> orders;  ///< by row; empty where the columns are no meshes
  bool interrupted = false;
};

/// The scene of one entry of the table; the reference of a column, and the coarser mesh by which its error is
/// bounded. Throws UsageError.
Scene static_variant(const Catalogue& catalogue, const StaticRefinePlan& plan, std::size_t row,
                     std::size_t column);
Scene static_reference(const Catalogue& catalogue, const StaticRefinePlan& plan, std::size_t column,
                       bool coarser);
/// Why the plan cannot be carried out: no statics, no such probe or component; empty if it can.
std::string static_misfit(const StaticRefinePlan& plan, const Scene& scene);

StaticRefinement refine_static(Runner& runner, const StaticRefinePlan& plan, output::Progress& progress);
std::size_t static_refine_runs(const StaticRefinePlan& plan);

output::Table static_refine_table(const StaticRefinement& study);
output::Figure static_refine_figure(const StaticRefinement& study);
nlohmann::ordered_json static_refine_json(const StaticRefinement& study);

}  // namespace gnomon
