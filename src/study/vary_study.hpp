#pragma once
#include <nlohmann/json.hpp>
#include <vector>

#include "src/output/figure.hpp"
#include "src/output/table.hpp"
#include "src/study/compare.hpp"
#include "src/study/json.hpp"
#include "src/study/stability.hpp"
#include "src/study/study_file.hpp"

namespace gnomon {

/// What becomes of errors and costs, or of the largest step, as one key of a scene changes.
struct VariedStudy {
  Variation variation;
  std::vector<Comparison> comparisons;  ///< one a value; none where stability was asked for
  Stability stability;
  bool interrupted = false;
  std::vector<output::Table> tables() const;  ///< the runs last
  output::Figure figure(const Catalogue& catalogue) const;
  void add_to(Document& document) const;
};

/// One scene a value. Throws UsageError.
std::vector<Scene> variants_of(const Catalogue& catalogue, const VaryPlan& plan);
/// Number of parts that `vary` reports as progress.
std::size_t vary_runs(const Catalogue& catalogue, const VaryPlan& plan, const StudyOptions& options);
/// `options` hold what the plan does not say.
VariedStudy vary(Runner& runner, const VaryPlan& plan, StudyOptions options, output::Progress& progress);
/// The command that shows the same, without the name of the program and the integrators.
std::string vary_command(const VaryPlan& plan);

}  // namespace gnomon
