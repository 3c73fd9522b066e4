#include "src/study/compare.hpp"

#include <fmt/format.h>

#include <iostream>

#include "src/cli/command.hpp"
#include "src/cli/files.hpp"
#include "src/environment.hpp"
#include "src/study/figures.hpp"
#include "src/study/present.hpp"
#include "src/study/vary_output.hpp"

namespace gnomon::cli {

int compare(Context& context) {
  const Request& request = context.request;
  const StudyOptions options = study_options(request);
  const std::vector<Scene> scenes = load_scenes(context);
  check_ladders(context, scenes, options);
  check_scheme_options(context, scenes, options);
  warn(scenes);
  const std::string folder = request.out.empty() ? "gnomon-out" : request.out;

  ReferenceStore references(reference_folder(), true);
  Runner runner(context.catalogue, references, context.stop, jobs_of(request));
  std::size_t total = 0;
  for (const Scene& scene : scenes) total += compare_runs(context.catalogue, scene, options);
  output::Progress progress(total, output::progress_mode(request.quiet), std::cerr);
  Document document(context.catalogue, "compare");
  std::vector<Comparison> studies;
  std::vector<output::Table> tables;
  std::vector<std::string> files;
  for (const Scene& scene : scenes) {
    studies.push_back(compare(runner, scene, options, progress));
    const Comparison& study = studies.back();
    document.add_comparison(study);
    output::Table runs = comparison_table(study, fmt::format("Work and precision, {}", study.scene.name));
    runs.notes.push_back(sundials_line(context.catalogue));
    const output::Table costs = costs_table(study);
    Document own(context.catalogue, "compare");
    own.add_comparison(study);
    for (std::string& file : write_study(folder, "compare-" + study.scene.name, {runs, costs}, own,
                                         work_precision_figure(context.catalogue, study), ""))
      files.push_back(std::move(file));
    tables.push_back(std::move(runs));
    tables.push_back(costs);
    if (study.interrupted) break;
  }
  progress.finish();
  std::vector<output::Table> csv, further;
  for (std::size_t k = 0; k < tables.size(); ++k) (k % 2 == 0 ? csv : further).push_back(tables[k]);
  const std::optional<Variation> varied = variation(request);
  const std::size_t variants = varied ? varied->values.size() : 1;
  for (std::size_t k = 0; varied && k + variants <= studies.size() && !studies.back().interrupted;
       k += variants) {
    const std::vector<Comparison> of(studies.begin() + static_cast<std::ptrdiff_t>(k),
                                     studies.begin() + static_cast<std::ptrdiff_t>(k + variants));
    const std::string name = of.front().scene.name.substr(0, of.front().scene.name.find('['));
    const std::vector<output::Table> over = varied_tables(of, *varied);
    tables.insert(tables.end(), over.begin(), over.end());
    further.insert(further.end(), over.begin(), over.end());
    Document own(context.catalogue, "compare");
    for (const Comparison& study : of) own.add_comparison(study);
    for (std::string& file : write_study(folder, fmt::format("compare-{}-by-{}", name, varied->key), over,
                                         own, varied_figure(context.catalogue, of, *varied), ""))
      files.push_back(std::move(file));
  }
  for (const output::Table& table : tables) show(request, table);
  for (const std::string& file : files) say(request, "wrote " + file);
  std::vector<const SceneStudy*> pointers;
  for (const Comparison& study : studies) pointers.push_back(&study);
  write_outputs(request, document, csv, further);
  return verdict(context, pointers);
}

}  // namespace gnomon::cli
