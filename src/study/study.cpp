#include "src/study/study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "src/error.hpp"
#include "src/nearest.hpp"
#include "src/solver_reference.hpp"

namespace gnomon {

std::string Setting::text() const {
  if (step) return fmt::format("step {:.4g}", *step);
  if (tol) return fmt::format("tol {:.3g}", *tol);
  return "closed form";
}

RunSpec Runner::spec(const Scene& scene, const Setting& setting, const StudyOptions& options) const {
  RunSpec spec;
  spec.t_end = scene.t_end;
  spec.step = setting.step;
  spec.tol = setting.tol;
  spec.samples = options.samples;
  spec.watch = options.watch;
  spec.max_steps = options.max_steps;
  spec.time_limit = options.time_limit;
  spec.scheme = options.scheme;
  spec.stop = &stop_;
  return spec;
}

ReferenceStates Runner::reference(const Scene& scene, const StudyOptions& options) {
  if (!options.reference) {
    ReferenceStates none;
    none.message = "not asked for";
    return none;
  }
  return references_.get(scene, {scene.t_end},
                         [&] { return solver_reference(catalogue_, scene, 20.0, &stop_); });
}

Row Runner::run(const Scene& scene, const ReferenceStates& reference, const SchemeInfo& scheme,
                const Setting& setting, const StudyOptions& options) {
  const Pair* pair = catalogue_.pair(scheme.name, *scene.model);
  Row row;
  row.scheme = &scheme;
  row.setting = setting;
  row.options = options.scheme;
  row.result = pair->run(scene.model->get(), spec(scene, setting, options));
  if (row.result.status != Status::ok || reference.states.empty()) return row;
  row.error = scene.model->distance(row.result.state, reference.states.back());
  for (std::size_t k = 0; k < row.error.size(); ++k) {
    const double bound = reference.bounds.back()[k];
    row.below_bound.push_back(!(row.error[k] > bound));
    if (row.below_bound.back()) row.error[k] = bound;
  }
  return row;
}

void Runner::time(const Scene& scene, std::vector<Row>& rows, const StudyOptions& options) {
  if (!options.timing) return;
  std::vector<Row*> timed;
  std::vector<TimedTask> tasks;
  for (Row& row : rows) {
    if (row.result.status != Status::ok) continue;
    RunSpec fast = spec(scene, row.setting, options);
    fast.record = false;
    const auto run = catalogue_.pair(row.scheme->name, *scene.model)->run;
    const void* model = scene.model->get();
    timed.push_back(&row);
    tasks.push_back({[=] { return run(model, fast).cpu_seconds; }});
  }
  TimingPlan plan;
  plan.timer_cost = timer_cost();
  const std::vector<TimingStats> stats = measure_interleaved(tasks, plan, [this] { return stopped(); });
  for (std::size_t k = 0; k < timed.size(); ++k)
    if (stats[k].repetitions > 0) timed[k]->timing = stats[k];
}

std::vector<const SchemeInfo*> select(const Catalogue& catalogue, const Scene& scene,
                                      const StudyOptions& options) {
  const std::vector<const SchemeInfo*> valid = catalogue.schemes_for(*scene.model);
  if (options.integrators.empty()) return valid;
  std::vector<const SchemeInfo*> chosen;
  for (const std::string& name : options.integrators) {
    const SchemeInfo* info = catalogue.scheme(name);
    std::vector<std::string> names;
    for (const SchemeInfo* each : valid) names.emplace_back(each->name);
    if (!info) {
      std::vector<std::string> all;
      for (const SchemeInfo& each : catalogue.schemes) all.emplace_back(each.name);
      const std::string near = nearest(name, all);
      throw UsageError(fmt::format("--integrators: found the unknown name '{}', expected {}", name,
                                   near.empty() ? fmt::format("one of {}", fmt::join(names, ", ")) : near));
    }
    if (!catalogue.pair(name, *scene.model)) {
      const std::string_view why = catalogue.refusal(name, *scene.model);
      throw UsageError(
          fmt::format("--integrators: found '{}', which does not run on scene '{}' (model {}, load {}){}{}, "
                      "expected one of {}",
                      name, scene.name, scene.model_name, scene.model->load_class(), why.empty() ? "" : ": ",
                      why, fmt::join(names, ", ")));
    }
    chosen.push_back(info);
  }
  return chosen;
}

std::vector<double> step_ladder(const Scene& scene, int count, double ratio) {
  const double first = std::max(8.0, std::ceil(scene.t_end / (0.5 * scene.model->time_scale())));
  std::vector<double> steps;
  for (int k = 0; k < count; ++k) steps.push_back(scene.t_end / std::round(first * std::pow(2.0, ratio * k)));
  return steps;
}

std::vector<Setting> settings(const SchemeInfo& scheme, const StudyOptions& options,
                              const std::vector<double>& steps, const std::vector<double>& tols) {
  std::vector<Setting> list;
  if (scheme.stepping == Stepping::closed_form) return {Setting{}};
  const bool fixed = scheme.stepping == Stepping::fixed;
  const std::vector<double>& given = fixed ? options.steps : options.tols;
  for (double value : given.empty() ? (fixed ? steps : tols) : given) {
    Setting setting;
    (fixed ? setting.step : setting.tol) = value;
    list.push_back(setting);
  }
  return list;
}

std::vector<InvariantSummary> summarise_invariants(const AnyModel& model, const Trace& trace) {
  std::vector<InvariantSummary> summaries;
  const std::vector<InvariantInfo> infos = model.invariant_info();
  std::size_t width = 0, offset = 0;
  for (const InvariantInfo& info : infos) width += static_cast<std::size_t>(info.size);
  for (const InvariantInfo& info : infos) {
    InvariantSummary summary;
    summary.info = info;
    const std::size_t size = static_cast<std::size_t>(info.size);
    for (std::size_t k = 0; k < trace.t.size(); ++k) {
      if (trace.t[k] < info.since) continue;
      const double* value = trace.values.data() + k * width + offset;
      if (summary.initial.empty()) summary.initial.assign(value, value + size);
      double square = 0.0;
      for (std::size_t i = 0; i < size; ++i) square += std::pow(value[i] - summary.initial[i], 2);
      const double drift = (size == 1 ? value[0] - summary.initial[0] : std::sqrt(square)) / info.scale;
      summary.times.push_back(trace.t[k]);
      summary.drift.push_back(drift);
      summary.final.assign(value, value + size);
      summary.max_drift = std::isnan(drift) ? drift : std::max(summary.max_drift, std::abs(drift));
    }
    summary.slope = summary.times.empty()
                        ? std::nan("")
                        : measure_drift(summary.times, summary.drift, summary.times.front()).slope;
    offset += size;
    summaries.push_back(std::move(summary));
  }
  return summaries;
}

}  // namespace gnomon
