#include "src/study/refine.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "src/error.hpp"

namespace gnomon {
namespace {

Scene mesh(const Catalogue& catalogue, const RefinePlan& plan, double value) {
  SceneChanges changes = plan.changes;
  changes.set.push_back(fmt::format("{}={:.17g}", plan.key, value));
  return load_scene(catalogue, plan.scene, changes);
}

/// Only what makes the mesh finer goes to a limit.
void check_key(const Catalogue& catalogue, const RefinePlan& plan) {
  const Scene scene = load_scene(catalogue, plan.scene, plan.changes);
  const auto entry = std::ranges::find(catalogue.models, scene.model_name, &ModelEntry::name);
  if (!scene.model->has_field() || entry == catalogue.models.end() || entry->mesh.empty())
    throw UsageError(fmt::format("--refine: found scene '{}' of model {}, expected a model with a mesh",
                                 scene.name, scene.model_name));
  if (std::ranges::find(entry->mesh, plan.key) == entry->mesh.end())
    throw UsageError(fmt::format("--refine: found the key '{}', expected one that makes the mesh finer: {}",
                                 plan.key, fmt::join(entry->mesh, ", ")));
}

/// The meshes that the last one is compared with.
Scene finer_mesh(const Catalogue& catalogue, const RefinePlan& plan, double factor) {
  try {
    return mesh(catalogue, plan, factor * plan.values.back());
  } catch (const UsageError& error) {
    throw UsageError(
        fmt::format("--refine: found {} = {:g}, expected one of which {:g} times as much can be made to "
                    "compare with ({})",
                    plan.key, plan.values.back(), factor, error.what()));
  }
}

/// The one scheme that integrates on all meshes, and its setting.
Setting choose(const Catalogue& catalogue, const Scene& scene, const StudyOptions& options,
               const SchemeInfo*& scheme) {
  StudyOptions one = options;
  if (one.integrators.empty()) one.integrators = {"cvode-bdf"};
  const std::vector<const SchemeInfo*> schemes = select(catalogue, scene, one);
  if (schemes.size() != 1)
    throw UsageError(
        fmt::format("--integrators: found {} names, expected one with --refine", schemes.size()));
  scheme = schemes.front();
  const bool fixed = scheme->stepping == Stepping::fixed;
  const std::vector<double>& given = fixed ? options.steps : options.tols;
  if (given.size() > 1 || (fixed && given.empty()))
    throw UsageError(fmt::format("{}: found {} values, expected one with --refine because {} {}",
                                 fixed ? "--steps" : "--tols", given.size(), scheme->name,
                                 fixed ? "takes equal steps" : "chooses its own steps"));
  Setting setting;
  if (fixed)
    setting.step = given.front();
  else
    setting.tol = given.empty() ? 1e-8 : given.front();
  return setting;
}

Setting tighter(Setting setting) {
  if (setting.step) *setting.step *= 0.5;
  if (setting.tol) *setting.tol *= 0.1;
  return setting;
}

std::vector<double> places() {
  constexpr int count = 512;
  std::vector<double> at(count);
  for (int k = 0; k < count; ++k) at[k] = (k + 0.5) / count;
  return at;
}

OrderRow observe(const Refinement& study, std::size_t metric) {
  const MetricInfo info = study.meshes.front().scene.model->metrics()[metric];
  std::vector<OrderPoint> points;
  OrderOptions options;
  options.scale = info.saturation;
  for (std::size_t k = 0; k < study.meshes.size(); ++k) {
    const Row& row = study.meshes[k].rows.front();
    OrderPoint point;
    point.step = 1.0 / study.values[k];
    point.usable = !row.error.empty();
    if (point.usable)
      point.error = row.error[metric];
    else
      point.why_not = std::string(to_string(row.result.status));
    points.push_back(std::move(point));
    if (!study.time_errors[k].empty())
      options.floor = std::max(options.floor, 3.0 * study.time_errors[k][metric]);
  }
  options.bound = study.meshes.front().reference.bounds.back()[metric];
  return {study.scheme, std::string(info.name), observe_order(points, options), std::nullopt};
}

}  // namespace

std::size_t refine_runs(const RefinePlan& plan) { return 2 * plan.values.size() + 2; }

Refinement refine(Runner& runner, const RefinePlan& plan, const StudyOptions& options,
                  output::Progress& progress) {
  check_key(runner.catalogue(), plan);
  Refinement study;
  study.key = plan.key;
  study.values = plan.values;
  const double last = plan.values.back();
  study.finest = 4.0 * last;
  std::vector<Scene> scenes;
  for (double value : plan.values) scenes.push_back(mesh(runner.catalogue(), plan, value));
  for (double factor : {2.0, 4.0}) scenes.push_back(finer_mesh(runner.catalogue(), plan, factor));
  const AnyModel& model = *scenes.front().model;
  study.setting = choose(runner.catalogue(), scenes.front(), options, study.scheme);

  const std::vector<double> at = places();
  const auto run = [&](const Scene& scene, const Setting& setting, double value) {
    progress.begin(fmt::format("{} / {}, {} = {:g}  {}", scene.name, study.scheme->name, plan.key, value,
                               setting.text()));
    return runner.run(scene, {}, *study.scheme, setting, options);
  };
  std::vector<std::vector<double>> fields;
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    if (runner.stopped()) {
      study.interrupted = true;
      return study;
    }
    const Scene& scene = scenes[k];
    const bool shown = k < plan.values.size();
    const double value =
        shown ? plan.values[k] : last * std::pow(2.0, 1.0 + static_cast<double>(k - plan.values.size()));
    const Row row = run(scene, tighter(study.setting), value);
    const bool ok = row.result.status == Status::ok;
    fields.push_back(ok ? scene.model->field(row.result.state, at) : std::vector<double>());
    if (!shown) continue;
    const Row rough = run(scene, study.setting, value);
    const bool both = ok && rough.result.status == Status::ok;
    study.time_errors.push_back(
        both ? model.field_distance(scene.model->field(rough.result.state, at), fields.back())
             : std::vector<double>());
    study.meshes.push_back({scene, {}, {row}, false});
  }
  study.interrupted = runner.stopped();

  const std::size_t n = plan.values.size();
  if (fields[n - 1].empty() || fields[n].empty() || fields[n + 1].empty()) {
    study.message = fmt::format("the runs with {} = {:g} and more did not end well", plan.key, last);
    for (SceneStudy& each : study.meshes) each.reference.message = study.message;
    return study;
  }
  // With the order q seen on the three finest meshes the last one's own error is its change over 2^q - 1.
  ReferenceStates reference;
  reference.kind = "refined";
  reference.methods = {fmt::format("{} = {:g}, {} {}", plan.key, study.finest, study.scheme->name,
                                   tighter(study.setting).text())};
  const std::vector<double> change = model.field_distance(fields[n], fields[n + 1]),
                            before = model.field_distance(fields[n - 1], fields[n]);
  std::vector<double> bound;
  for (std::size_t m = 0; m < change.size(); ++m) {
    const double order = change[m] > 0.0 ? std::clamp(std::log2(before[m] / change[m]), 1.0, 10.0) : 10.0;
    bound.push_back(1.5 * change[m] / (std::pow(2.0, order) - 1.0));
  }
  reference.bounds = {bound};
  for (std::size_t k = 0; k < n; ++k) {
    SceneStudy& each = study.meshes[k];
    each.reference = reference;
    if (fields[k].empty()) continue;
    Row& row = each.rows.front();
    row.error = model.field_distance(fields[k], fields[n + 1]);
    for (std::size_t m = 0; m < bound.size(); ++m) {
      row.below_bound.push_back(!(row.error[m] > bound[m]));
      if (row.below_bound.back()) row.error[m] = bound[m];
    }
  }
  for (std::size_t m = 0; m < bound.size(); ++m) study.orders.push_back(observe(study, m));
  return study;
}

}  // namespace gnomon
