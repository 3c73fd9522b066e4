#pragma once
// The parts of a study: what `bench` and `report` make, one after the other.

#include <functional>
#include <string>
#include <vector>

#include "src/cli/command.hpp"
#include "src/cli/session.hpp"
#include "src/cli/study_folder.hpp"
#include "src/study/study_file.hpp"

namespace gnomon::cli {

/// A part of the study: it writes files of its own.
struct Part {
  std::string name;     ///< also the stem of its files
  std::string heading;  ///< in the index
  std::size_t runs;
  std::function<bool(output::Progress&)> make;  ///< false: interrupted, nothing written
};

/// Makes parts and gives their tables and figures to the study's folder.
class PartMaker {
 public:
  PartMaker(Context& context, Runner& runner, const Session& session, StudyFolder& files)
      : context_(context), runner_(runner), session_(session), files_(files) {}

  /// Adds what a model's study, read with the catalogue, asks for. `model` is what files of a part are called
  /// by. The parts refer to the maker.
  void plan(const StudyPlan& study, const std::string& model, std::vector<Part>& parts);

 private:
  bool make_orders(const std::string& model, const std::vector<Scene>& scenes,
                   const std::vector<StudyOptions>& options, output::Progress& progress);
  bool make_comparison(const Scene& scene, const StudyOptions& options, output::Progress& progress);
  bool make_drift(const DriftPlan& plan, output::Progress& progress);
  bool make_vary(const VaryPlan& plan, const StudyOptions& options, output::Progress& progress);
  bool make_refine(const StaticRefinePlan& plan, output::Progress& progress);
  bool make_scorecard(const std::string& model, const std::vector<Scene>& scenes,
                      const std::vector<StudyOptions>& options, output::Progress& progress);
  bool make_survey(const std::string& model, const StudyPlan& plan, const StudyOptions& options,
                   output::Progress& progress);
  bool make_speed(const std::string& model, const StudyPlan& plan, output::Progress& progress);
  bool make_peers(const PeerPlan& plan, output::Progress& progress);
  Document new_document() const;

  Context& context_;
  Runner& runner_;
  const Session& session_;
  StudyFolder& files_;
};

}  // namespace gnomon::cli
