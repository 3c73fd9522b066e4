#include <fmt/format.h>

#include <iostream>

#include "src/cli/command.hpp"
#include "src/cli/files.hpp"
#include "src/study/figures.hpp"
#include "src/study/present.hpp"

namespace gnomon::cli {

int converge(Context& context) {
  const Request& request = context.request;
  if (!request.refine.empty()) return refine(context);
  const StudyOptions options = study_options(request);
  const std::vector<Scene> scenes = load_scenes(context);
  check_ladders(context, scenes, options);
  check_scheme_options(context, scenes, options);
  warn(scenes);

  ReferenceStore references(reference_folder(), true);
  Runner runner(context.catalogue, references, context.stop, jobs_of(request));
  std::size_t total = 0;
  for (const Scene& scene : scenes) total += converge_runs(context.catalogue, scene, options);
  output::Progress progress(total, output::progress_mode(request.quiet), std::cerr);
  Document document(context.catalogue, "converge");
  std::vector<Convergence> studies;
  for (const Scene& scene : scenes) {
    studies.push_back(converge(runner, scene, options, progress));
    document.add(studies.back());
    document.add_orders(studies.back().scene.name, studies.back().orders);
    if (studies.back().interrupted) break;
  }
  progress.finish();

  std::vector<output::Table> tables, further;
  std::vector<const SceneStudy*> pointers;
  for (const Convergence& study : studies) {
    const output::Table runs = runs_table(study, fmt::format("Convergence, {}", study.scene.name));
    const output::Table orders = orders_table(study);
    show(request, runs);
    show(request, orders);
    if (!request.out.empty()) {
      Document own(context.catalogue, "converge");
      own.add(study);
      own.add_orders(study.scene.name, study.orders);
      for (const std::string& file : write_study(request.out, "converge-" + study.scene.name, {orders, runs},
                                                 own, convergence_figure(context.catalogue, study), ""))
        say(request, "wrote " + file);
    }
    tables.push_back(runs);
    further.push_back(orders);
    pointers.push_back(&study);
  }
  write_outputs(request, document, tables, further);
  return verdict(context, pointers);
}

}  // namespace gnomon::cli
