#include "src/study/static_refine.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "src/statics.hpp"

namespace gnomon {
namespace {

using Json = nlohmann::ordered_json;

/// "a,b" and its k-th value as "a=value" and "b=value".
void assign(const Variation& variation, std::size_t k, std::vector<std::string>& set) {
  for (std::size_t begin = 0; begin <= variation.key.size();) {
    const std::size_t end = std::min(variation.key.find(',', begin), variation.key.size());
    set.push_back(variation.key.substr(begin, end - begin) + "=" + variation.values[k]);
    begin = end + 1;
  }
}

/// The components of the probe that count, in the order of the plan; fewer where some are missing.
std::vector<double> observed(const StaticRefinePlan& plan, const AnyModel& model,
                             const std::vector<double>& state) {
  std::vector<double> values;
  for (const Probe& probe : model.probes(state)) {
    if (probe.name != plan.probe) continue;
    for (const std::string& wanted : plan.components)
      for (const auto& [name, value] : probe.components)
        if (name == wanted) values.push_back(value);
  }
  return values;
}

struct Place {
  Status status = Status::interrupted;
  std::string message;
  std::vector<double> values;
};

Place equilibrium(Runner& runner, const StaticRefinePlan& plan, const Scene& scene) {
  const Json identity{{"scene", scene.name},
                      {"physics", scene.physics_hash()},
                      {"probe", plan.probe},
                      {"components", plan.components}};
  const Json kept = runner.measure("equilibrium", identity, false, [&]() -> Json {
    const std::unique_ptr<StaticSystem> system = scene.model->statics();
    const StaticPath path = follow_equilibrium(*system);
    Json json{{"status", to_string(path.status)}, {"message", path.message}, {"values", Json::array()}};
    if (path.status == Status::ok) json["values"] = observed(plan, *scene.model, path.points.back().state);
    return json;
  });
  Place place;
  if (kept.is_null()) return place;
  place.message = kept.at("message").get<std::string>();
  place.values = kept.at("values").get<std::vector<double>>();
  place.status = place.values.empty() ? Status::newton_failed : Status::ok;
  return place;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.empty() || a.size() != b.size()) return std::nan("");
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum);
}

ObservedOrder observe(const StaticRefinement& study, std::size_t row, double scale) {
  std::vector<OrderPoint> points;
  OrderOptions options;
  options.scale = scale;
  options.declared = study.plan.orders[row];
  const std::vector<double> numbers = study.plan.columns.numbers().value();
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const StaticError& each = study.errors[row][k];
    options.bound = std::max(options.bound, study.bounds[k]);
    points.push_back({1.0 / numbers[k], each.error.value_or(0.0), each.error.has_value(),
                      each.error ? "" : std::string(to_string(each.status))});
  }
  return observe_order(points, options);
}

}  // namespace

Scene static_variant(const Catalogue& catalogue, const StaticRefinePlan& plan, std::size_t row,
                     std::size_t column) {
  SceneChanges changes;
  changes.set = plan.set;
  assign(plan.rows, row, changes.set);
  if (!plan.row_set.empty()) changes.set.push_back(plan.row_set[row]);
  assign(plan.columns, column, changes.set);
  return load_scene(catalogue, plan.scene, changes);
}

Scene static_reference(const Catalogue& catalogue, const StaticRefinePlan& plan, std::size_t column,
                       bool coarser) {
  SceneChanges changes;
  changes.set = plan.set;
  assign(plan.columns, column, changes.set);
  const std::vector<std::string>& mesh = coarser ? plan.coarser : plan.reference;
  changes.set.insert(changes.set.end(), mesh.begin(), mesh.end());
  return load_scene(catalogue, plan.scene, changes);
}

std::string static_misfit(const StaticRefinePlan& plan, const Scene& scene) {
  const std::unique_ptr<StaticSystem> system = scene.model->statics();
  if (!system)
    return fmt::format("found scene {} of model {}, expected a model with statics", scene.name,
                       scene.model_name);
  if (const std::string found = system->refusal(); !found.empty())
    return fmt::format("found in scene {} {}, expected one that is held in place", scene.name, found);
  const std::vector<double> rest(static_cast<std::size_t>(system->size()), 0.0);
  const std::vector<double> state = system->state(rest.data());
  std::vector<std::string> names;
  for (const Probe& probe : scene.model->probes(state))
    for (const auto& component : probe.components) names.push_back(probe.name + " " + component.first);
  for (const std::string& component : plan.components)
    if (std::ranges::find(names, plan.probe + " " + component) == names.end())
      return fmt::format("found '{} {}', expected some of {}", plan.probe, component, fmt::join(names, ", "));
  return {};
}

std::size_t static_refine_runs(const StaticRefinePlan& plan) {
  return plan.rows.values.size() * plan.columns.values.size() + 2 * plan.columns.values.size();
}

StaticRefinement refine_static(Runner& runner, const StaticRefinePlan& plan, output::Progress& progress) {
  StaticRefinement study;
  study.plan = plan;
  study.unit = std::ranges::find(plan.components, "phi") == plan.components.end() ? "m" : "rad";
  study.errors.resize(plan.rows.values.size());
  const auto solve = [&](const Scene& scene, const std::string& text) {
    progress.begin(fmt::format("{} / equilibrium, {}", scene.name, text));
    return equilibrium(runner, plan, scene);
  };
  double scale = 1.0;
  for (std::size_t column = 0; column < plan.columns.values.size(); ++column) {
    const std::string at = fmt::format("{} = {}", plan.columns.key, plan.columns.values[column]);
    const Place fine = solve(static_reference(runner.catalogue(), plan, column, false), at + ", reference"),
                coarse = solve(static_reference(runner.catalogue(), plan, column, true), at + ", coarser");
    study.bounds.push_back(distance(fine.values, coarse.values));
    for (std::size_t row = 0; row < plan.rows.values.size(); ++row) {
      if (runner.stopped()) {
        study.interrupted = true;
        return study;
      }
      const Scene scene = static_variant(runner.catalogue(), plan, row, column);
      scale = scene.model->metrics()[0].saturation;
      const Place place = solve(scene, fmt::format("{}, {} = {}", at, plan.rows.key, plan.rows.values[row]));
      StaticError entry{place.status, place.message, std::nullopt, false};
      if (const double error = distance(place.values, fine.values); std::isfinite(error)) {
        entry.below_bound = error <= study.bounds.back();
        entry.error = std::max(error, study.bounds.back());
      }
      study.errors[row].push_back(std::move(entry));
    }
  }
  if (!plan.orders.empty())
    for (std::size_t row = 0; row < plan.rows.values.size(); ++row)
      study.orders.push_back(observe(study, row, scale));
  return study;
}

}  // namespace gnomon
