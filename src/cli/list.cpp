#include <fmt/format.h>
#include <fmt/ranges.h>

#include "src/cli/command.hpp"
#include "src/environment.hpp"
#include "src/error.hpp"

namespace gnomon::cli {
namespace {

using output::Align;
using output::Table;
using Json = nlohmann::ordered_json;

Table scenes_table(const Catalogue& catalogue, Json& json) {
  Table table{"Scenes",
              {{"scene", "scene", Align::left},
               {"model", "model", Align::left},
               {"load", "load", Align::left},
               {"t_end_s", "t_end [s]"},
               {"description", "description", Align::left}},
              {},
              {}};
  json = Json::array();
  for (const ShippedScene& shipped : shipped_scenes(catalogue)) {
    const Scene scene = load_scene(catalogue, shipped.name);
    table.rows.push_back({scene.name, scene.model_name, std::string(scene.model->load_class()),
                          output::number_cell(scene.t_end, 4), scene.description});
    Json entry = scene.resolved;
    entry["path"] = shipped.path;
    json.push_back(std::move(entry));
  }
  return table;
}

Table models_table(const Catalogue& catalogue, Json& json) {
  Table table{"Models",
              {{"model", "model", Align::left},
               {"summary", "summary", Align::left},
               {"citation", "source", Align::left}},
              {},
              {}};
  json = Json::array();
  for (const ModelEntry& model : catalogue.models) {
    std::string summary(model.summary);
    if (!model.loads.empty()) summary += fmt::format("; loads: {}", fmt::join(model.loads, ", "));
    table.rows.push_back({std::string(model.name), summary, std::string(model.citation)});
    json.push_back({{"name", model.name}, {"summary", summary}, {"citation", model.citation}});
  }
  return table;
}

/// "rigid_body", or "rigid_body (none)" where only some of its types fit.
std::string models_of(const Catalogue& catalogue, const SchemeInfo& scheme) {
  std::string text;
  for (const ModelEntry& model : catalogue.models) {
    std::string variants;
    int count = 0;
    for (const Pair& pair : catalogue.pairs)
      if (pair.scheme == scheme.name && pair.model == model.name) {
        ++count;
        variants += (variants.empty() ? "" : ", ") + std::string(pair.variant);
      }
    if (count == 0) continue;
    text += (text.empty() ? "" : "; ") + std::string(model.name);
    if (count < catalogue.variants(model.name)) text += fmt::format(" ({})", variants);
  }
  return text;
}

std::string orders_of(const SchemeInfo& scheme) {
  std::string text;
  for (const DeclaredOrder& declared : scheme.orders)
    if (!declared.load_class.empty())
      text += fmt::format("{}{} {:g}", text.empty() ? "" : ", ", declared.load_class, declared.order);
  for (const DeclaredOrder& declared : scheme.momentum_orders)
    if (!declared.load_class.empty())
      text += fmt::format(", momentum: {} {:g}", declared.load_class, declared.order);
  return text.empty() ? "variable" : text;
}

Table integrators_table(const Catalogue& catalogue, Json& json) {
  Table table{"Integrators",
              {{"integrator", "integrator", Align::left},
               {"form", "form", Align::left},
               {"stepping", "stepping", Align::left},
               {"order", "order by load", Align::left},
               {"models", "models", Align::left},
               {"summary", "summary", Align::left}},
              {},
              {}};
  json = Json::array();
  for (const SchemeInfo& scheme : catalogue.schemes) {
    const bool closed = scheme.stepping == Stepping::closed_form;
    const std::string order = closed ? "exact" : orders_of(scheme), models = models_of(catalogue, scheme);
    table.rows.push_back({std::string(scheme.name), std::string(scheme.form),
                          std::string(to_string(scheme.stepping)), order, models,
                          std::string(scheme.summary)});
    Json orders = Json::object();
    for (const DeclaredOrder& declared : scheme.orders)
      if (!declared.load_class.empty()) orders[std::string(declared.load_class)] = declared.order;
    json.push_back({{"name", scheme.name},
                    {"family", scheme.family},
                    {"form", scheme.form},
                    {"stepping", to_string(scheme.stepping)},
                    {"orders", orders},
                    {"stages", scheme.stages},
                    {"reversible", scheme.reversible},
                    {"conserves_energy", scheme.conserves_energy},
                    {"conserves_momentum", scheme.conserves_momentum},
                    {"negative_control", scheme.control},
                    {"models", models},
                    {"summary", scheme.summary},
                    {"citation", scheme.citation}});
  }
  return table;
}

}  // namespace

int list(Context& context) {
  const std::vector<std::string>& words = context.request.what;
  if (words.size() > 1)
    throw UsageError(fmt::format("list: found '{}', expected no further argument", words[1]));
  const std::string what = words.empty() ? "" : words[0];
  if (!what.empty() && what != "scenes" && what != "models" && what != "integrators")
    throw UsageError(fmt::format("list: found '{}', expected scenes, models or integrators", what));
  Json json;
  json["gnomon"] = gnomon_version;
  json["command"] = "list";
  if (what.empty() || what == "scenes")
    show(context.request, scenes_table(context.catalogue, json["scenes"]));
  if (what.empty() || what == "models")
    show(context.request, models_table(context.catalogue, json["models"]));
  if (what.empty() || what == "integrators")
    show(context.request, integrators_table(context.catalogue, json["integrators"]));
  write_json(context.request, json);
  return done;
}

}  // namespace gnomon::cli
