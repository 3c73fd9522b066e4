#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "src/cli/command.hpp"
#include "src/cli/files.hpp"
#include "src/error.hpp"
#include "src/nearest.hpp"
#include "src/study/survey.hpp"

namespace gnomon::cli {

int survey(Context& context) {
  const Request& request = context.request;
  StudyOptions options = study_options(request);
  struct Planned {
    std::string model;
    std::vector<SurveyPlan> plans;
  };
  std::vector<Planned> planned;
  std::vector<std::string> models;
  for (const std::string& file : context.catalogue.study_files) {
    const std::string model = std::filesystem::path(file).parent_path().filename().string();
    std::vector<SurveyPlan> plans = read_study(file).survey;
    if (plans.empty()) continue;
    models.push_back(model);
    if (request.what.empty() || std::ranges::find(request.what, model) != request.what.end())
      planned.push_back({model, std::move(plans)});
  }
  for (const std::string& name : request.what)
    if (std::ranges::find(models, name) == models.end())
      throw UsageError(
          fmt::format("survey: found '{}', expected a model with a survey: {}", name, choices_text(models)));

  ReferenceStore references(reference_folder(), true);
  Runner runner(context.catalogue, references, context.stop, jobs_of(request));
  std::size_t runs = 0;
  for (const Planned& each : planned) runs += survey_runs(context.catalogue, each.plans, options.quick);
  output::Progress progress(runs, output::progress_mode(request.quiet), std::cerr);
  Document document(context.catalogue, "survey");
  std::vector<output::Table> all;
  bool stopped = false;
  for (const Planned& each : planned) {
    const Survey study = gnomon::survey(runner, each.model, each.plans, options, progress);
    stopped = stopped || study.interrupted;
    if (study.classes.empty()) break;
    const std::vector<output::Table> tables = survey_tables(study);
    document.json()["survey"][each.model] = survey_json(study);
    for (const output::Table& table : tables) show(request, table);
    if (!request.out.empty()) {
      Document own(context.catalogue, "survey");
      own.json()["survey"][each.model] = survey_json(study);
      for (const std::string& file :
           write_study(request.out, each.model + "-survey", tables, own, std::nullopt, ""))
        say(request, "wrote " + file);
    }
    all.insert(all.end(), tables.begin(), tables.end());
    if (stopped) break;
  }
  progress.finish();
  write_outputs(request, document, all);
  return stopped ? interrupted : done;
}

}  // namespace gnomon::cli
