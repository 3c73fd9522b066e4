#include "src/study/kept_row.hpp"

#include <cmath>

#include "src/study/json.hpp"

namespace gnomon {
namespace kept {

using Json = nlohmann::ordered_json;

double number(const Json& json) { return json.is_number() ? json.get<double>() : std::nan(""); }
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::vector<double> numbers(const Json& json) {
  if (json.is_null()) return {};
  if (!json.is_array()) return {number(json)};
  std::vector<double> values;
  for (const Json& each : json) values.push_back(number(each));
  return values;
}
Json numbers(const std::vector<double>& values) {
  Json json = Json::array();
  for (const double value : values) json.push_back(number(value));
  return json;
}

Json drift_json(const InvariantSummary& summary) {
  const Drift& drift = summary.measured;
  return {{"max_abs", number(drift.max_abs)},         {"oscillation", number(drift.oscillation)},
          {"slope_error", number(drift.slope_error)}, {"growth", number(drift.growth)},
          {"verdict", to_string(drift.verdict)},      {"t", numbers(summary.times)},
          {"drift", numbers(summary.drift)}};
}

DriftVerdict verdict_named(const std::string& name) {
  for (const DriftVerdict verdict :
       {DriftVerdict::bounded, DriftVerdict::secular, DriftVerdict::roundoff, DriftVerdict::dissipated,
        DriftVerdict::newton, DriftVerdict::saturated, DriftVerdict::far_off, DriftVerdict::undecided})
    if (to_string(verdict) == name) return verdict;
  return DriftVerdict::failed;
}

void restore_drift(InvariantSummary& summary, const Json& json) {
  summary.measured = {
      number(json.at("max_abs")),     number(json.at("oscillation")), summary.slope,
      number(json.at("slope_error")), number(json.at("growth")),      verdict_named(json.at("verdict"))};
  summary.times = numbers(json.at("t"));
  summary.drift = numbers(json.at("drift"));
}

}  // namespace kept

nlohmann::ordered_json row_json(const Scene& scene, const Row& row, bool drifts) {
  kept::Json json{{"run", run_json(scene, row)}};
  json["cpu"] = kept::number(row.result.cpu_seconds);
  if (drifts)
    for (const InvariantSummary& summary : row.invariants)
      json["drifts"][summary.info.name] = kept::drift_json(summary);
  return json;
}

Row restore_row(const Scene& scene, const SchemeInfo& scheme, const Setting& setting,
                const nlohmann::ordered_json& json) {
  const kept::Json& run = json.at("run");
  Row row;
  row.scheme = &scheme;
  row.setting = setting;
  RunResult& result = row.result;
  result.status = status_named(run.at("status").get<std::string>());
  result.message = run.at("message");
  result.t = kept::number(run.at("t"));
  if (!run.at("step").is_null()) result.step = run.at("step");
  const kept::Json& cost = run.at("cost");
  result.cost = {cost.at("steps"),
                 cost.at("rejected"),
                 cost.at("rhs"),
                 cost.at("moments"),
                 cost.at("jacobians"),
                 cost.at("factorizations"),
                 cost.at("newton_iterations")};
  result.flags = run.at("flags").get<std::vector<std::string>>();
  result.cpu_seconds = kept::number(json.at("cpu"));
  if (!run.at("error").is_null())
    for (const MetricInfo& metric : scene.model->metrics()) {
      row.error.push_back(kept::number(run.at("error").at(std::string(metric.name))));
      row.below_bound.push_back(run.at("below_bound").at(std::string(metric.name)));
    }
  for (const InvariantInfo& info : scene.model->invariant_info()) {
    const kept::Json& invariant = run.at("invariants").at(info.name);
    InvariantSummary summary;
    summary.info = info;
    summary.initial = kept::numbers(invariant.at("initial"));
    summary.final = kept::numbers(invariant.at("final"));
    summary.max_drift = kept::number(invariant.at("max_drift"));
    summary.slope = summary.measured.slope = kept::number(invariant.at("slope"));
    if (json.contains("drifts")) kept::restore_drift(summary, json.at("drifts").at(info.name));
    row.invariants.push_back(std::move(summary));
  }
  row.document = run;
  return row;
}

Row failed_row(const Scene& scene, const SchemeInfo& scheme, const Setting& setting, Status status,
               const std::string& message) {
  Row row;
  row.scheme = &scheme;
  row.setting = setting;
  row.result.status = status;
  row.result.message = message;
  if (setting.step) row.result.step = plan_steps(scene.t_end, *setting.step, scene.model->breaks()).h;
  row.result.t = std::nan("");
  return row;
}

nlohmann::ordered_json timing_json(const TimingStats& stats) {
  return {{"median", kept::number(stats.median)}, {"min", kept::number(stats.min)},
          {"max", kept::number(stats.max)},       {"mdape", kept::number(stats.mdape)},
          {"repetitions", stats.repetitions},     {"unstable", stats.unstable}};
}

TimingStats restore_timing(const nlohmann::ordered_json& json) {
  return {kept::number(json.at("median")), kept::number(json.at("min")), kept::number(json.at("max")),
          kept::number(json.at("mdape")),  json.at("repetitions"),       json.at("unstable")};
}

nlohmann::ordered_json reference_json(const ReferenceStates& reference) {
  kept::Json json{{"kind", reference.kind}, {"methods", reference.methods}, {"message", reference.message}};
  json["times"] = reference.times;
  json["bounds"] = kept::Json::array();
  for (const std::vector<double>& bounds : reference.bounds) json["bounds"].push_back(kept::numbers(bounds));
  return json;
}

ReferenceStates restore_reference(const nlohmann::ordered_json& json) {
  ReferenceStates reference;
  reference.kind = json.at("kind");
  reference.methods = json.at("methods").get<std::vector<std::string>>();
  reference.message = json.at("message");
  reference.times = json.at("times").get<std::vector<double>>();
  for (const kept::Json& bounds : json.at("bounds")) reference.bounds.push_back(kept::numbers(bounds));
  return reference;
}

}  // namespace gnomon
