#include "src/study/scorecard.hpp"

#include <fmt/format.h>

#include <iostream>

#include "src/cli/command.hpp"
#include "src/cli/files.hpp"
#include "src/environment.hpp"

namespace gnomon::cli {

int scorecard(Context& context) {
  const Request& request = context.request;
  const StudyOptions options = study_options(request);
  if (request.scenes.empty())
    for (const std::string& file : context.catalogue.study_files)
      for (const std::string& name : read_study(file).scorecard) context.request.scenes.push_back(name);
  const std::vector<Scene> scenes = load_scenes(context);
  std::size_t total = 0;
  for (const Scene& scene : scenes) total += scorecard_runs(context.catalogue, scene, options);
  check_scheme_options(context, scenes, options);
  warn(scenes);

  ReferenceStore references(reference_folder(), true);
  Runner runner(context.catalogue, references, context.stop, jobs_of(request));
  output::Progress progress(total, output::progress_mode(request.quiet), std::cerr);
  Document document(context.catalogue, "scorecard");
  document.json()["scorecard"] = nlohmann::ordered_json::array();
  std::vector<Scorecard> cards;
  std::vector<output::Table> tables;
  bool stopped = false;
  for (const Scene& scene : scenes) {
    cards.push_back(gnomon::scorecard(runner, scene, options, progress));
    stopped = cards.back().interrupted;
    document.add(cards.back().comparison);
    for (auto& item : scorecard_json(cards.back())) document.json()["scorecard"].push_back(std::move(item));
    tables.push_back(scorecard_table(cards.back()));
    if (options.timing) tables.back().notes.push_back(sundials_line(context.catalogue));
    if (stopped) break;
  }
  progress.finish();
  if (cards.size() > 1) tables.insert(tables.begin(), joint_scorecard_table("Scorecard", cards));
  for (const output::Table& table : tables) show(request, table);
  if (!request.out.empty())
    for (const std::string& file : write_study(request.out, "scorecard", tables, document, std::nullopt, ""))
      say(request, "wrote " + file);
  write_outputs(request, document, tables);
  if (!stopped) return done;
  std::cerr << "gnomon: interrupted; what was finished is kept\n";
  return interrupted;
}

}  // namespace gnomon::cli
