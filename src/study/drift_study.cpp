#include "src/study/drift_study.hpp"

#include <fmt/format.h>

namespace gnomon {

DriftStudy drift(Runner& runner, Scene scene, const StudyOptions& given, output::Progress& progress) {
  StudyOptions options = given;
  options.watch = std::max(options.watch, 2048);
  DriftStudy study;
  study.scene = std::move(scene);
  const auto schemes = select(runner.catalogue(), study.scene, options);
  study.reference = runner.reference(study.scene, options);
  const std::vector<double> steps{0.1 * study.scene.model->time_scale()}, tols{1e-8};
  for (const SchemeInfo* scheme : schemes)
    for (const Setting& setting : settings(*scheme, options, steps, tols)) {
      if (runner.stopped()) {
        study.interrupted = true;
        return study;
      }
      progress.begin(fmt::format("{} / {}  {}", study.scene.name, scheme->name, setting.text()));
      study.rows.push_back(runner.run(study.scene, study.reference, *scheme, setting, options));
      for (const InvariantSummary& invariant : study.rows.back().invariants)
        study.drifts.push_back({study.rows.size() - 1, invariant, invariant.measured});
    }
  return study;
}

}  // namespace gnomon
