#include "src/study/json.hpp"

#include <cmath>

#include "src/environment.hpp"

namespace gnomon {
namespace {

using Json = nlohmann::ordered_json;

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json optional(const std::optional<double>& value) { return value ? finite_or_null(*value) : Json(nullptr); }
Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (double value : values) list.push_back(finite_or_null(value));
  return list;
}
Json scalar_or_list(const std::vector<double>& values, int size) {
  if (values.empty()) return nullptr;
  return size == 1 ? finite_or_null(values[0]) : numbers(values);
}

Json named(const std::vector<Named>& components) {
  Json json = Json::object();
  for (const Named& component : components) json[component.name] = numbers(component.values);
  return json;
}

Json probes_json(const std::vector<Probe>& probes) {
  Json json = Json::object();
  for (const Probe& probe : probes)
    for (const auto& [component, value] : probe.components)
      json[probe.name][component] = finite_or_null(value);
  return json;
}

Json cost_json(const Cost& cost) {
  return {{"steps", cost.steps},
          {"rejected", cost.rejected},
          {"rhs", cost.rhs},
          {"moments", cost.moments},
          {"jacobians", cost.jacobians},
          {"factorizations", cost.factorizations},
          {"newton_iterations", cost.newton_iterations}};
}

Json invariants_json(const std::vector<InvariantSummary>& invariants) {
  Json json = Json::object();
  for (const InvariantSummary& summary : invariants)
    json[summary.info.name] = {{"since", summary.info.since},
                               {"scale", summary.info.scale},
                               {"initial", scalar_or_list(summary.initial, summary.info.size)},
                               {"final", scalar_or_list(summary.final, summary.info.size)},
                               {"max_drift", finite_or_null(summary.max_drift)},
                               {"slope", finite_or_null(summary.slope)}};
  return json;
}

/// Lists over the sample times: every component of the state, below "probes" every component of every probe,
/// and below "invariants" every invariant.
Json series_json(const AnyModel& model, const RunResult& result) {
  Json json;
  json["t"] = numbers(result.sample_times);
  for (std::size_t k = 0; k < result.samples.size(); ++k) {
    for (const Named& component : model.observe(result.samples[k]))
      json[component.name].push_back(numbers(component.values));
    for (const Probe& probe : model.probes(result.samples[k]))
      for (const auto& [component, value] : probe.components)
        json["probes"][probe.name][component].push_back(finite_or_null(value));
    const std::vector<double> values = model.invariants(result.sample_times[k], result.samples[k]);
    auto value = values.begin();
    for (const InvariantInfo& info : model.invariant_info()) {
      json["invariants"][info.name].push_back(scalar_or_list({value, value + info.size}, info.size));
      value += info.size;
    }
  }
  return json;
}

Json cpu_json(const std::optional<TimingStats>& timing) {
  if (!timing) return nullptr;
  return {{"median", finite_or_null(timing->median)},
          {"min", finite_or_null(timing->min)},
          {"max", finite_or_null(timing->max)},
          {"repetitions", timing->repetitions},
          {"unstable", timing->unstable}};
}

}  // namespace

Json options_json(const SchemeOptions& options) {
  return {{"newton_tol", options.newton_tol},
          {"spectral_radius", optional(options.spectral_radius)},
          {"modified_newton", options.modified_newton},
          {"linear_solver", to_string(options.linear_solver)}};
}

Json options_json(const SchemeOptions& options, const SchemeInfo& scheme) {
  Json json = options_json(options);
  const auto keep = [&](const char* key, bool used) {
    if (!used) json[key] = nullptr;
  };
  keep("newton_tol", scheme.uses.newton_tol);
  keep("spectral_radius", scheme.spectral_radii.has_value());
  keep("modified_newton", scheme.uses.modified_newton);
  keep("linear_solver", scheme.uses.linear_solver);
  return json;
}

Json run_json(const Scene& scene, const Row& row) {
  if (!row.document.is_null()) {
    Json json = row.document;
    json["cpu_seconds"] = cpu_json(row.timing);
    return json;
  }
  const AnyModel& model = *scene.model;
  const RunResult& result = row.result;
  Json json;
  json["scene"] = scene.name;
  json["integrator"] = row.scheme->name;
  json["step"] = optional(result.step);
  json["requested_step"] = optional(row.setting.step);
  json["tol"] = optional(row.setting.tol);
  json["options"] = options_json(row.options, *row.scheme);
  json["status"] = to_string(result.status);
  json["message"] = result.message;
  json["t"] = finite_or_null(result.t);
  // A run that ended its process left none.
  const bool state = !result.state.empty();
  json["state"] = state ? named(model.observe(result.state)) : Json(nullptr);
  json["probes"] = state ? probes_json(model.probes(result.state)) : Json(nullptr);
  json["invariants"] = invariants_json(row.invariants);
  json["error"] = nullptr;
  json["below_bound"] = nullptr;
  if (!row.error.empty()) {
    json["error"] = Json::object();
    json["below_bound"] = Json::object();
    for (std::size_t k = 0; k < row.error.size(); ++k) {
      const std::string name(model.metrics()[k].name);
      json["error"][name] = finite_or_null(row.error[k]);
      json["below_bound"][name] = static_cast<bool>(row.below_bound[k]);
    }
  }
  for (std::size_t k = 0; k < result.own_bound.size(); ++k)
    json["own_error_bound"][std::string(model.metrics()[k].name)] = finite_or_null(result.own_bound[k]);
  if (!result.samples.empty()) json["series"] = series_json(model, result);
  json["cost"] = cost_json(result.cost);
  json["cpu_seconds"] = cpu_json(row.timing);
  json["flags"] = result.flags;
  return json;
}

namespace {

Json scene_json(const SceneStudy& study) {
  Json json = study.scene.resolved;
  const ReferenceStates& reference = study.reference;
  json["reference"] = {{"kind", reference.kind.empty() ? Json(nullptr) : Json(reference.kind)},
                       {"methods", reference.methods},
                       {"error_bound", Json::object()}};
  if (!reference.message.empty()) json["reference"]["message"] = reference.message;
  const std::vector<MetricInfo> metrics = study.scene.model->metrics();
  for (std::size_t k = 0; k < metrics.size() && !reference.bounds.empty(); ++k)
    json["reference"]["error_bound"][std::string(metrics[k].name)] =
        finite_or_null(reference.bounds.back()[k]);
  if (!study.scene.warnings.empty()) json["warnings"] = study.scene.warnings;
  return json;
}

}  // namespace

Document::Document(const Catalogue& catalogue, const std::string& command) {
  json_["gnomon"] = gnomon_version;
  json_["command"] = command;
  json_["environment"] = environment(catalogue);
  json_["scenes"] = Json::array();
  json_["runs"] = Json::array();
  json_["orders"] = Json::array();
}

void Document::add(const SceneStudy& study) {
  json_["scenes"].push_back(scene_json(study));
  for (const Row& row : study.rows) json_["runs"].push_back(run_json(study.scene, row));
}

void Document::add_comparison(const Comparison& study) {
  const std::size_t first = json_["runs"].size();
  add(study);
  for (std::size_t k = 0; k < study.front_in_evaluations.size(); ++k)
    json_["runs"][first + k]["pareto"] = {{"cpu_seconds", static_cast<bool>(study.front_in_time[k])},
                                          {"rhs", static_cast<bool>(study.front_in_evaluations[k])}};
  if (!json_.contains("costs")) json_["costs"] = Json::array();
  const auto number = [](const std::optional<LevelCost>& cost) {
    return cost ? finite_or_null(cost->cost) : Json(nullptr);
  };
  for (const CostRow& cost : study.costs)
    for (std::size_t k = 0; k < study.levels.size(); ++k) {
      const auto &seconds = cost.seconds[k], &evaluations = cost.evaluations[k];
      json_["costs"].push_back(
          {{"scene", study.scene.name},
           {"integrator", cost.scheme->name},
           {"metric", study.scene.model->metrics()[0].name},
           {"error", study.levels[k]},
           {"cpu_seconds", number(seconds)},
           {"rhs", number(evaluations)},
           {"upper_bound",
            {{"cpu_seconds", seconds && seconds->upper_bound},
             {"rhs", evaluations && evaluations->upper_bound}}},
           {"few_settings",
            {{"cpu_seconds", seconds && seconds->few}, {"rhs", evaluations && evaluations->few}}}});
    }
}

void Document::add_orders(const std::string& scene, const std::vector<OrderRow>& orders) {
  for (const OrderRow& row : orders) {
    const ObservedOrder& order = row.order;
    Json json;
    json["scene"] = scene;
    json["integrator"] = row.scheme->name;
    json["metric"] = row.metric;
    json["observed"] = optional(order.observed);
    json["interval"] = order.observed ? numbers({order.interval[0], order.interval[1]}) : Json(nullptr);
    json["expected"] = optional(row.expected);
    json["points"] = order.points;
    json["verdict"] = order.verdict;
    json["finding"] = to_string(order.finding);
    json["dropped"] = Json::array();
    for (const DroppedPoint& point : order.dropped)
      json["dropped"].push_back(
          {{"step", point.step}, {"error", finite_or_null(point.error)}, {"reason", point.reason}});
    json["floor"] = row.floor ? finite_or_null(row.floor->level) : Json(nullptr);
    json["floor_kind"] = row.floor_kind ? Json(to_string(*row.floor_kind)) : Json(nullptr);
    json_["orders"].push_back(std::move(json));
  }
}

namespace {

Json error_before_json(const ErrorsBefore& before, std::size_t row) {
  Json json{{"t", before.scene.t_end},
            {"reference", nullptr},
            {"error_bound", nullptr},
            {"error", nullptr},
            {"below_bound", nullptr}};
  const std::vector<MetricInfo> metrics = before.scene.model->metrics();
  const auto by_metric = [&](const auto& value) {
    Json values = Json::object();
    for (std::size_t k = 0; k < metrics.size(); ++k) values[std::string(metrics[k].name)] = value(k);
    return values;
  };
  if (!before.reference.kind.empty()) {
    json["reference"] = before.reference.kind;
    json["error_bound"] =
        by_metric([&](std::size_t k) { return finite_or_null(before.reference.bounds.back()[k]); });
  }
  if (row >= before.rows.size() || before.rows[row].error.empty()) return json;
  json["error"] = by_metric([&](std::size_t k) { return finite_or_null(before.rows[row].error[k]); });
  json["below_bound"] =
      by_metric([&](std::size_t k) { return Json(static_cast<bool>(before.rows[row].below_bound[k])); });
  return json;
}

}  // namespace

void Document::add_drifts(const DriftStudy& study) {
  for (const DriftRow& row : study.drifts) {
    const Row& run = study.rows[row.row];
    const auto scaling = h_scaling(study, *run.scheme, row.invariant.info.name);
    const std::string why = run.result.status == Status::ok ? why_undecided(row.drift) : "";
    json_["drifts"].push_back(
        {{"scene", study.scene.name},
         {"integrator", run.scheme->name},
         {"step", optional(run.result.step)},
         {"tol", optional(run.setting.tol)},
         {"invariant", row.invariant.info.name},
         {"max_drift", finite_or_null(row.drift.max_abs)},
         {"oscillation", finite_or_null(row.drift.oscillation)},
         {"slope", finite_or_null(row.drift.slope)},
         {"slope_error", finite_or_null(row.drift.slope_error)},
         {"growth", finite_or_null(row.drift.growth)},
         {"verdict", run.result.status == Status::ok ? to_string(row.drift.verdict) : "failed"},
         {"undecided_because", why.empty() ? Json(nullptr) : Json(why)},
         {"h_scaling", scaling ? finite_or_null(scaling->exponent) : Json(nullptr)},
         {"h_scaling_of", scaling ? Json(scaling->of_slope ? "slope" : "max_drift") : Json(nullptr)}});
    for (const ErrorsBefore& before : study.before)
      json_["drifts"].back()["error_before"].push_back(error_before_json(before, row.row));
  }
}

std::string Document::text() const { return json_.dump(1) + "\n"; }

}  // namespace gnomon
