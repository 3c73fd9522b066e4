#include "src/reference.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <iostream>

#include "src/cli/command.hpp"
#include "src/cli/files.hpp"
#include "src/output/files.hpp"
#include "src/reference_file.hpp"

namespace gnomon::cli {
namespace {

/// Places after the decimal point, in the unit of the error, that a bound leaves certain.
int certain_decimals(double bound) { return static_cast<int>(std::floor(-std::log10(2.0 * bound))); }

output::Table bounds_table(const SceneStudy& study) {
  output::Table table;
  table.caption = fmt::format("Reference of {} at t = {:g} s", study.scene.name, study.scene.t_end);
  table.columns = {{"metric", "error", output::Align::left},
                   {"unit", "unit", output::Align::left},
                   {"bound", "bound"},
                   {"decimals", "certain decimals"}};
  const std::vector<MetricInfo> metrics = study.scene.model->metrics();
  for (std::size_t k = 0; k < metrics.size(); ++k) {
    const double bound = study.reference.bounds.back()[k];
    table.rows.push_back({std::string(metrics[k].name),
                          metrics[k].unit == "1" ? "relative" : std::string(metrics[k].unit),
                          output::at_most_cell(bound, 2), output::count_cell(certain_decimals(bound))});
  }
  return table;
}

struct Origin {
  std::string file;  ///< where it is kept; empty: nowhere
  bool there;        ///< it was there before
  double seconds;    ///< of wall-clock time, to compute or to read it
};

void print(const Request& request, const SceneStudy& study, const Origin& origin) {
  const ReferenceStates& reference = study.reference;
  if (reference.kind.empty()) {
    say(request, fmt::format("{}: no reference: {}", study.scene.name, reference.message));
    return;
  }
  say(request, fmt::format("{}: {}", study.scene.name, reference.kind));
  for (const std::string& method : reference.methods) say(request, "  method: " + method);
  if (!origin.file.empty())
    say(request, fmt::format("  file: {} ({})", origin.file,
                             origin.there ? "read" : fmt::format("computed in {:.2g} s", origin.seconds)));
  say(request, "");
  show(request, bounds_table(study));
  say(request, "state at the end");
  const std::vector<double>& state = reference.states.back();
  for (const Named& component : study.scene.model->observe(state))
    say(request, fmt::format("  {:<20} {:.17g}", component.name, fmt::join(component.values, ", ")));
  for (const Probe& probe : study.scene.model->probes(state))
    for (const auto& [component, value] : probe.components)
      say(request, fmt::format("  {:<20} {:.17g}", probe.name + " " + component, value));
}

/// Puts the reference beside its scene; false where there is no place for it.
bool keep(const SceneStudy& study, const std::string& file) {
  const std::string text =
      file.empty() || study.reference.kind.empty() ? "" : reference_text(study.scene, study.reference);
  if (text.empty()) return false;
  try {
    output::write_file_atomically(file, text);
    return true;
  } catch (const std::runtime_error& error) {
    std::cerr << fmt::format("gnomon: {}: the reference is not kept beside the scene: {}\n", study.scene.name,
                             error.what());
    return false;
  }
}

/// Adds what other commands do not show to the reference of the last scene.
void complete(Document& document, const SceneStudy& study, const Origin& origin) {
  nlohmann::ordered_json& json = document.json()["scenes"].back()["reference"];
  const bool exists = !study.reference.kind.empty();
  json["t"] = exists ? nlohmann::ordered_json(study.scene.t_end) : nlohmann::ordered_json(nullptr);
  json["file"] = origin.file.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(origin.file);
  json["from_file"] = origin.there;
  json["seconds"] = origin.seconds;
  json["state"] = nullptr;
  json["probes"] = nlohmann::ordered_json::object();
  json["decimals"] = nlohmann::ordered_json::object();
  if (!exists) return;
  const std::vector<double>& state = study.reference.states.back();
  json["state"] = nlohmann::ordered_json::object();
  for (const Named& component : study.scene.model->observe(state))
    json["state"][component.name] = component.values;
  for (const Probe& probe : study.scene.model->probes(state))
    for (const auto& [component, value] : probe.components) json["probes"][probe.name][component] = value;
  const std::vector<MetricInfo> metrics = study.scene.model->metrics();
  for (std::size_t k = 0; k < metrics.size(); ++k)
    json["decimals"][std::string(metrics[k].name)] = certain_decimals(study.reference.bounds.back()[k]);
}

}  // namespace

int reference(Context& context) {
  const Request& request = context.request;
  const StudyOptions options = study_options(request);
  const std::vector<Scene> scenes = load_scenes(context);
  warn(scenes);
  ReferenceStore references(reference_folder(), true);
  Runner runner(context.catalogue, references, context.stop);
  Document document(context.catalogue, "reference");
  std::vector<output::Table> tables;
  bool missing = false;
  for (const Scene& scene : scenes) {
    SceneStudy study;
    study.scene = scene;
    const std::string beside = reference_file(scene, {scene.t_end});
    const std::string cached = references.path(scene, {scene.t_end});
    std::error_code code;
    if (request.fresh)
      for (const std::string& file : {beside, cached})
        if (!file.empty()) std::filesystem::remove(file, code);
    const bool stands_beside = references.beside(scene, {scene.t_end}).has_value();
    const bool there = stands_beside || (!cached.empty() && std::filesystem::exists(cached, code));
    Origin origin{stands_beside ? beside : cached, there, 0.0};
    const double begin = wall_seconds();
    study.reference = runner.reference(scene, options);
    origin.seconds = wall_seconds() - begin;
    if (runner.stopped()) break;
    if (!stands_beside && keep(study, beside)) origin.file = beside;
    missing = missing || study.reference.kind.empty();
    print(request, study, origin);
    document.add(study);
    complete(document, study, origin);
    if (!study.reference.kind.empty()) tables.push_back(bounds_table(study));
  }
  write_outputs(request, document, tables);
  if (runner.stopped()) return interrupted;
  for (const auto& scene : document.json()["scenes"])
    if (scene["reference"]["kind"].is_null())
      std::cerr << fmt::format("gnomon: {}: no reference: {}\n", scene["name"].get<std::string>(),
                               scene["reference"]["message"].get<std::string>());
  return missing ? run_failed : done;
}

}  // namespace gnomon::cli
