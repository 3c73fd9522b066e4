#include <fmt/format.h>

#include <iostream>

#include "src/cli/command.hpp"
#include "src/cli/files.hpp"
#include "src/study/stability_output.hpp"

namespace gnomon::cli {

int stability(Context& context) {
  const Request& request = context.request;
  StudyOptions options = study_options(request);
  if (request.time_limit.empty()) options.time_limit = 20.0;
  Survival survival;
  if (!request.max_drift.empty())
    survival.max_drift = positive_number("--max-drift", request.max_drift, "a positive number");
  const std::vector<Scene> scenes = load_scenes(context);
  const std::optional<Variation> varied = variation(request);
  std::size_t total = 0;
  for (const Scene& scene : scenes) total += equal_step_schemes(context.catalogue, scene, options).size();
  check_scheme_options(context, scenes, options);
  warn(scenes);

  ReferenceStore references(reference_folder(), true);
  Runner runner(context.catalogue, references, context.stop, jobs_of(request));
  output::Progress progress(total, output::progress_mode(request.quiet), std::cerr);
  Document document(context.catalogue, "stability");
  document.json()["stability"] = nlohmann::ordered_json::array();
  const auto add = [](Document& to, const Stability& study) {
    for (const StabilityScene& on : study.scenes) to.add(on);
    for (auto& item : stability_json(study)) to.json()["stability"].push_back(std::move(item));
  };
  std::vector<output::Table> all, further;
  bool stopped = false;
  const std::size_t variants = varied ? varied->values.size() : 1;
  for (std::size_t k = 0; k < scenes.size() && !stopped; k += variants) {
    const auto first = scenes.begin() + static_cast<std::ptrdiff_t>(k);
    const Stability study = gnomon::stability(runner, {first, first + static_cast<std::ptrdiff_t>(variants)},
                                              varied, survival, options, progress);
    stopped = study.interrupted();
    add(document, study);
    const std::vector<output::Table> tables{stability_table(study), stability_map(study)};
    show(request, tables[0]);
    if (varied) show(request, tables[1]);
    if (!request.out.empty()) {
      Document own(context.catalogue, "stability");
      own.json()["stability"] = nlohmann::ordered_json::array();
      add(own, study);
      for (const std::string& file : write_study(request.out, "stability-" + study.name, tables, own,
                                                 stability_figure(context.catalogue, study), ""))
        say(request, "wrote " + file);
    }
    all.push_back(tables[0]);
    further.push_back(tables[1]);
  }
  progress.finish();
  write_outputs(request, document, all, further);
  if (!stopped) return done;
  std::cerr << "gnomon: interrupted; what was finished is kept\n";
  return interrupted;
}

}  // namespace gnomon::cli
