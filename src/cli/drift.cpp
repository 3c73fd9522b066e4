#include <fmt/format.h>

#include <iostream>

#include "src/cli/command.hpp"
#include "src/cli/files.hpp"
#include "src/error.hpp"
#include "src/study/figures.hpp"
#include "src/study/present.hpp"

namespace gnomon::cli {

int drift(Context& context) {
  const Request& request = context.request;
  const StudyOptions options = study_options(request);
  const std::vector<Scene> scenes = load_scenes(context);
  for (const Scene& scene : scenes)
    if (!options.error_times.empty() && options.error_times.back() > scene.t_end)
      throw UsageError(fmt::format("--error-at: found '{}', expected times up to the end of {}, t = {:g} s",
                                   request.error_at, scene.name, scene.t_end));
  check_ladders(context, scenes, options);
  check_scheme_options(context, scenes, options);
  warn(scenes);

  ReferenceStore references(reference_folder(), true);
  Runner runner(context.catalogue, references, context.stop, jobs_of(request));
  std::size_t total = 0;
  for (const Scene& scene : scenes) total += drift_runs(context.catalogue, scene, options);
  output::Progress progress(total, output::progress_mode(request.quiet), std::cerr);
  Document document(context.catalogue, "drift");
  std::vector<DriftStudy> studies;
  for (const Scene& scene : scenes) {
    studies.push_back(drift(runner, scene, options, progress));
    document.add(studies.back());
    document.add_drifts(studies.back());
    if (studies.back().interrupted) break;
  }
  progress.finish();

  std::vector<output::Table> tables, further;
  std::vector<const SceneStudy*> pointers;
  for (const DriftStudy& study : studies) {
    std::vector<output::Table> own_tables{drift_table(study)};
    if (study.has_ladder()) own_tables.insert(own_tables.begin(), drift_runs_table(study));
    tables.push_back(own_tables.front());
    further.insert(further.end(), own_tables.begin() + 1, own_tables.end());
    pointers.push_back(&study);
    for (const output::Table& table : own_tables) show(request, table);
    if (request.out.empty()) continue;
    Document own(context.catalogue, "drift");
    own.add(study);
    own.add_drifts(study);
    for (const std::string& file : write_study(request.out, "drift-" + study.scene.name, own_tables, own,
                                               drift_figure(context.catalogue, study, "energy"), ""))
      say(request, "wrote " + file);
  }
  write_outputs(request, document, tables, further);
  return verdict(context, pointers);
}

}  // namespace gnomon::cli
