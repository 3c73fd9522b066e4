#include <fmt/format.h>

#include <iostream>

#include "src/cli/command.hpp"
#include "src/cli/files.hpp"
#include "src/error.hpp"
#include "src/statics.hpp"

namespace gnomon::cli {
namespace {

using Json = nlohmann::ordered_json;

StaticsOptions statics_options(const Context& context) {
  const Request& request = context.request;
  const StudyOptions common = study_options(request);
  StaticsOptions options;
  if (!request.load_steps.empty())
    options.load_steps = static_cast<int>(whole_number("--load-steps", request.load_steps, 1'000'000));
  options.arc_length = request.arc_length;
  if (!request.newton_tol.empty()) options.newton_tol = common.scheme.newton_tol;
  if (!request.max_steps.empty()) options.max_points = common.max_steps;
  options.stop = &context.stop;
  return options;
}

std::string unit_of(const std::string& component) { return component == "phi" ? "rad" : "m"; }

/// Load factor, probes and corrections of every point.
output::Table path_table(const Scene& scene, const StaticPath& path) {
  output::Table table;
  table.caption = fmt::format("{}: equilibria", scene.name);
  table.columns = {{"load_factor", "load factor"}};
  for (const Equilibrium& point : path.points) {
    std::vector<output::Cell> cells{output::number_cell(point.factor, 9)};
    for (const Probe& probe : scene.model->probes(point.state))
      for (const auto& [component, value] : probe.components) {
        if (table.rows.empty())
          table.columns.push_back({fmt::format("{}_{}", probe.name, component),
                                   fmt::format("{} {} [{}]", probe.name, component, unit_of(component))});
        cells.push_back(output::number_cell(value, 12));
      }
    cells.push_back(output::count_cell(point.iterations));
    table.rows.push_back(std::move(cells));
  }
  table.columns.push_back({"newton_iterations", "Newton iterations"});
  return table;
}

Json numbers_of(const std::vector<Probe>& probes) {
  Json json = Json::object();
  for (const Probe& probe : probes)
    for (const auto& [component, value] : probe.components) json[probe.name][component] = value;
  return json;
}

/// The last equilibrium as the state of a run, so that a scene can begin with it.
Json path_document(const Catalogue& catalogue, const Scene& scene, const StaticPath& path) {
  Document document(catalogue, "static");
  Json json = std::move(document.json());
  json["scenes"].push_back(scene.resolved);
  Json points = Json::array();
  long iterations = 0;
  for (const Equilibrium& point : path.points) {
    iterations += point.iterations;
    points.push_back({{"load_factor", point.factor},
                      {"probes", numbers_of(scene.model->probes(point.state))},
                      {"newton_iterations", point.iterations}});
  }
  Json run{{"scene", scene.name},
           {"integrator", nullptr},
           {"status", to_string(path.status)},
           {"message", path.message},
           {"t", 0.0},
           {"state", Json::object()},
           {"probes", Json::object()},
           {"path", std::move(points)},
           {"cost", {{"newton_iterations", iterations}}}};
  if (!path.points.empty()) {
    for (const Named& component : scene.model->observe(path.points.back().state))
      run["state"][component.name] = component.values;
    run["probes"] = numbers_of(scene.model->probes(path.points.back().state));
  }
  json["runs"].push_back(std::move(run));
  return json;
}

}  // namespace

int statics(Context& context) {
  const Request& request = context.request;
  const StaticsOptions options = statics_options(context);
  if (request.scenes.size() > 1)
    throw UsageError(fmt::format("static: found {} scenes, expected one", request.scenes.size()));
  const Scene scene = std::move(load_scenes(context).front());
  const std::unique_ptr<StaticSystem> system = scene.model->statics();
  if (!system)
    throw UsageError(fmt::format("static: found scene {} of model {}, expected a model with statics",
                                 scene.name, scene.model_name));
  if (const std::string found = system->refusal(); !found.empty())
    throw UsageError(
        fmt::format("static: found in scene {} {}, expected one that is held in place", scene.name, found));
  warn({scene});
  const StaticPath path = follow_equilibrium(*system, options);
  const output::Table table = path_table(scene, path);
  show(request, table);
  write_json(request, path_document(context.catalogue, scene, path));
  write_csv(request, {table});
  if (path.status == Status::interrupted) return interrupted;
  if (path.status == Status::ok) return done;
  std::cerr << fmt::format("gnomon: {} / static: {}: {}\n", scene.name, to_string(path.status), path.message);
  return run_failed;
}

}  // namespace gnomon::cli
