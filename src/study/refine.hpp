#pragma once
#include <string>
#include <vector>

#include "src/study/converge.hpp"

namespace gnomon {

/// Meshes of one scene: a key of its mesh (ModelEntry::mesh), such as beam.elements, takes each of the
/// values.
struct RefinePlan {
  std::string scene;
  SceneChanges changes;
  std::string key;
  std::vector<double> values;  ///< at least two, ascending
};

/// The error in space, mesh by mesh. All meshes are integrated by one scheme; what each mesh gives is
/// compared as a field with that of a mesh four times as fine as the last one, whose own error is estimated
/// from a mesh twice as fine as the last one and bounds what can be seen.
struct Refinement {
  std::string key;
  const SchemeInfo* scheme = nullptr;
  Setting setting;
  std::vector<double> values;
  std::vector<SceneStudy> meshes;                ///< one run each; its error is that in space
  std::vector<std::vector<double>> time_errors;  ///< by a run at half the step or a tenth of the tolerance
  double finest = 0.0;                           ///< value of the key on the mesh that is compared with
  std::vector<OrderRow> orders;                  ///< against 1 / value
  std::string message;                           ///< why there are no errors; empty if there are
  bool interrupted = false;
};

/// Throws UsageError if the key is none of the mesh or cannot take the values, if the model has no field, or
/// if there is not exactly one scheme and setting. Without any, cvode-bdf at the tolerance 1e-8.
Refinement refine(Runner& runner, const RefinePlan& plan, const StudyOptions& options,
                  output::Progress& progress);
std::size_t refine_runs(const RefinePlan& plan);

}  // namespace gnomon
