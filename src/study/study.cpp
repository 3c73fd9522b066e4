#include "src/study/study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "src/error.hpp"
#include "src/measure/core.hpp"
#include "src/measure/timing.hpp"
#include "src/nearest.hpp"
#include "src/solver_reference.hpp"
#include "src/study/json.hpp"
#include "src/study/keeper.hpp"
#include "src/study/kept_row.hpp"

namespace gnomon {

using Json = nlohmann::ordered_json;

namespace {
/// Without a sign of life for so long a measurement other than a run hangs, s.
constexpr double longest_silence = 300.0;
}  // namespace

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
  const Json identity{{"scene", scene.name}, {"physics", scene.physics_hash()}};
  if (keeper_ && !keeper_->measures()) {
    const Json kept = keeper_->recall("reference", identity);
    if (!kept.is_null()) return restore_reference(kept);
    ReferenceStates none;
    none.message = "not in the store";
    return none;
  }
  const ReferenceStates& reference = references_.get(
      scene, {scene.t_end}, [&] { return solver_reference(catalogue_, scene, 60.0, &stop_); });
  if (keeper_ && !stopped()) keeper_->remember("reference", identity, reference_json(reference));
  return reference;
}

Row Runner::run(const Scene& scene, const ReferenceStates& reference, const SchemeInfo& scheme,
                const Setting& setting, const StudyOptions& options) {
  return run_each(scene, reference, {{&scheme, setting}}, options, [](const RunPlan&) {}).front();
}

int Runner::jobs() const { return keeper_ ? keeper_->jobs() : jobs_; }

double patience(const StudyOptions& options) {
  return options.time_limit + std::max(1.0, 0.1 * options.time_limit);
}

std::vector<Row> Runner::run_each(const Scene& scene, const ReferenceStates& reference,
                                  const std::vector<RunPlan>& plans, const StudyOptions& options,
                                  const std::function<void(const RunPlan&)>& begin) {
  std::vector<Row> rows;
  if (!keeper_) {
    if (jobs_ > 1 && plans.size() > 1) return run_in_children(scene, reference, plans, options, begin);
    for (const RunPlan& plan : plans) {
      if (stopped() && !rows.empty()) break;
      begin(plan);
      rows.push_back(run_here(scene, reference, *plan.scheme, plan.setting, options));
    }
    return rows;
  }
  std::vector<Json> identities;
  for (const auto& [scheme, setting] : plans)
    identities.push_back({{"scene", scene.name},
                          {"physics", scene.physics_hash()},
                          {"integrator", scheme->name},
                          {"step", setting.step ? Json(*setting.step) : Json()},
                          {"tol", setting.tol ? Json(*setting.tol) : Json()},
                          {"samples", options.samples},
                          {"watch", options.watch},
                          {"max_steps", options.max_steps},
                          {"time_limit", options.time_limit},
                          {"options", options_json(options.scheme)},
                          {"reference", reference.kind}});
  // A run looks at its limit itself; one that never comes to do so is ended.
  keeper_->set_seconds(patience(options));
  keeper_->get_each(
      "run", identities,
      [&](std::size_t k, Pulse&) {
        return row_json(scene, run_here(scene, reference, *plans[k].scheme, plans[k].setting, options),
                        options.watch > 256);
      },
      [&](std::size_t k) { begin(plans[k]); },
      [&](std::size_t k, const Keeper::Kept& kept) {
        const auto& [scheme, setting] = plans[k];
        rows.push_back(kept.status == Status::ok
                           ? restore_row(scene, *scheme, setting, kept.result)
                           : failed_row(scene, *scheme, setting, kept.status, kept.message));
        rows.back().options = options.scheme;
      });
  return rows;
}

std::vector<Row> Runner::run_in_children(const Scene& scene, const ReferenceStates& reference,
                                         const std::vector<RunPlan>& plans, const StudyOptions& options,
                                         const std::function<void(const RunPlan&)>& begin) {
  std::vector<std::optional<Row>> done(plans.size());
  const auto settle = [&](std::size_t k, Row row) {
    row.options = options.scheme;
    done[k] = std::move(row);
  };
  const ChildLimits limits{patience(options), default_memory_limit() / static_cast<std::uint64_t>(jobs_),
                           &stop_};
  in_children(
      {plans.size(),
       [&](std::size_t k, Pulse&, const Say& say) {
         const Row row = run_here(scene, reference, *plans[k].scheme, plans[k].setting, options);
         say(row_json(scene, row, options.watch > 256).dump(-1, ' ', false, Json::error_handler_t::replace));
       },
       [&](std::size_t k) { begin(plans[k]); },
       [&](std::size_t k, const std::string& line) {
         settle(k, restore_row(scene, *plans[k].scheme, plans[k].setting, Json::parse(line)));
       },
       [&](std::size_t k, const ChildResult& end) {
         if (done[k]) return;
         const Status status = end.end == ChildEnd::time_limit    ? Status::time_limit
                               : end.end == ChildEnd::interrupted ? Status::interrupted
                                                                  : Status::crashed;
         settle(k, failed_row(scene, *plans[k].scheme, plans[k].setting, status, end.text));
       }},
      jobs_, limits);
  std::vector<Row> rows;
  for (std::optional<Row>& row : done)
    if (row) rows.push_back(std::move(*row));
  return rows;
}

Row Runner::run_here(const Scene& scene, const ReferenceStates& reference, const SchemeInfo& scheme,
                     const Setting& setting, const StudyOptions& options) {
  const Pair* pair = catalogue_.pair(scheme.name, *scene.model);
  Row row;
  row.scheme = &scheme;
  row.setting = setting;
  row.options = options.scheme;
  row.result = pair->run(scene.model->get(), spec(scene, setting, options));
  row.invariants =
      summarise_invariants(*scene.model, row.result.invariants, count_evaluations(row.result.cost));
  for (InvariantSummary& invariant : row.invariants) {
    const std::string& name = invariant.info.name;
    const bool conserved =
        name == "energy" ? scheme.conserves_energy : scheme.conserves_momentum && name.ends_with("momentum");
    if (conserved && row.result.cost.newton_iterations > 0)
      allow_newton_residue(invariant.measured, options.scheme.newton_tol);
    thin(invariant);
  }
  row.result.invariants = {};
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
  std::vector<std::string> names;
  for (Row& row : rows) {
    if (row.result.status != Status::ok) continue;
    RunSpec fast = spec(scene, row.setting, options);
    fast.record = false;
    const auto run = catalogue_.pair(row.scheme->name, *scene.model)->run;
    const void* model = scene.model->get();
    timed.push_back(&row);
    tasks.push_back({[=] { return run(model, fast).cpu_seconds; }});
    names.push_back(fmt::format("{}, {:.17g}, {:.17g}", row.scheme->name, row.setting.step.value_or(0.0),
                                row.setting.tol.value_or(0.0)));
  }
  const Json identity{{"scene", scene.name},
                      {"physics", scene.physics_hash()},
                      {"max_steps", options.max_steps},
                      {"time_limit", options.time_limit},
                      {"options", options_json(options.scheme)}};
  TimingPlan plan;
  plan.budget_seconds = options.timing_budget;
  const std::vector<TimingStats> stats = time("times", identity, names, tasks, plan);
  for (std::size_t k = 0; k < timed.size(); ++k)
    if (stats[k].repetitions > 0) timed[k]->timing = stats[k];
}

std::vector<TimingStats> Runner::time(std::string_view kind, const Json& identity,
                                      const std::vector<std::string>& names,
                                      const std::vector<TimedTask>& tasks, TimingPlan plan) {
  plan.timer_cost = timer_cost();
  if (!keeper_) {
    const OnOneCore here;
    return measure_interleaved(tasks, plan, [this] { return stopped(); });
  }
  keeper_->set_seconds(longest_silence);
  std::vector<TimingStats> all(tasks.size());
  // The places of the tasks that have not ended their process.
  std::vector<std::size_t> places(tasks.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  while (!places.empty()) {
    Json which{{"of", identity}, {"repetitions", plan.repetitions}, {"min_seconds", plan.min_seconds}};
    for (const std::size_t k : places) which["tasks"].push_back(names[k]);
    const Keeper::Kept kept = keeper_->get(kind, which, true, [&](Pulse& pulse) {
      std::vector<TimedTask> beating;
      for (std::size_t k = 0; k < places.size(); ++k)
        beating.push_back({[&pulse, &task = tasks[places[k]], k] {
          pulse.beat(static_cast<int>(k));
          return task.run();
        }});
      const OnOneCore here;
      Json json = Json::array();
      for (const TimingStats& stats : measure_interleaved(beating, plan, {}))
        json.push_back(timing_json(stats));
      return json;
    });
    if (kept.status == Status::ok) {
      for (std::size_t k = 0; k < places.size(); ++k) all[places[k]] = restore_timing(kept.result.at(k));
      return all;
    }
    const auto culprit = static_cast<std::size_t>(kept.task);
    if (kept.status == Status::interrupted || culprit >= places.size()) return all;
    places.erase(places.begin() + kept.task);
  }
  return all;
}

nlohmann::ordered_json Runner::measure(std::string_view kind, const Json& identity, bool timed,
                                       const std::function<Json()>& work) {
  if (!keeper_) return work();
  keeper_->set_seconds(longest_silence);
  const Keeper::Kept kept = keeper_->get(kind, identity, timed, [&](Pulse&) { return work(); });
  return kept.status == Status::ok ? kept.result : Json();
}

std::string misfit(const Catalogue& catalogue, const Scene& scene, const std::string& name) {
  if (catalogue.scheme(name) && catalogue.pair(name, *scene.model)) return {};
  std::vector<std::string> names;
  for (const SchemeInfo* each : catalogue.schemes_for(*scene.model)) names.emplace_back(each->name);
  if (!catalogue.scheme(name)) {
    std::vector<std::string> all;
    for (const SchemeInfo& each : catalogue.schemes) all.emplace_back(each.name);
    const std::string near = nearest(name, all);
    return fmt::format("found the unknown name '{}', expected {}", name,
                       near.empty() ? fmt::format("one of {}", fmt::join(names, ", ")) : near);
  }
  const std::string_view why = catalogue.refusal(name, *scene.model);
  return fmt::format(
      "found '{}', which does not run on scene '{}' (model {}, load {}){}{}, expected one of {}", name,
      scene.name, scene.model_name, scene.model->load_class(), why.empty() ? "" : ": ", why,
      fmt::join(names, ", "));
}

std::vector<const SchemeInfo*> select(const Catalogue& catalogue, const Scene& scene,
                                      const StudyOptions& options, std::string_view option) {
  if (options.integrators.empty()) return catalogue.schemes_for(*scene.model);
  std::vector<const SchemeInfo*> chosen;
  for (const std::string& name : options.integrators) {
    if (const std::string why = misfit(catalogue, scene, name); !why.empty())
      throw UsageError(fmt::format("{}: {}", option, why));
    chosen.push_back(catalogue.scheme(name));
  }
  return chosen;
}

namespace {

/// The least number of equal steps, at most `most`, that meets every break; 1 if there is none.
long count_that_meets(double t_end, const std::vector<double>& breaks, long most) {
  for (long count = 1; count <= most; ++count)
    if (!plan_steps(t_end, t_end / static_cast<double>(count), breaks).misses_break) return count;
  return 1;
}

}  // namespace

bool is_of_high_order(const Scene& scene, const SchemeInfo& scheme) {
  return scheme.stepping == Stepping::fixed &&
         scheme.order_for(scene.model->load_class()).value_or(0.0) >= 6.0;
}

std::vector<double> step_ladder(const Scene& scene, const SchemeInfo& scheme, int count, double ratio) {
  const double high = is_of_high_order(scene, scheme) ? 8.0 : 1.0;
  const double first = std::max(8.0, std::ceil(scene.t_end / (0.5 * high * scene.model->time_scale())));
  const auto unit = static_cast<double>(
      count_that_meets(scene.t_end, scene.model->breaks(), std::lround(std::min(4.0 * first, 1e4))));
  std::vector<double> steps;
  double last = 0.0;
  for (int k = 0; k < count; ++k) {
    last = std::max(last + unit, unit * std::round(first * std::pow(2.0, ratio * k) / unit));
    steps.push_back(scene.t_end / last);
  }
  return steps;
}

std::vector<Setting> settings(const SchemeInfo& scheme, const StudyOptions& options,
                              const std::vector<double>& steps, const std::vector<double>& tols) {
  std::vector<Setting> list;
  if (scheme.stepping == Stepping::closed_form) return {Setting{}};
  const bool fixed = scheme.stepping == Stepping::fixed;
  const bool is_explicit = scheme.stages > 0 && !options.explicit_steps.empty();
  const std::vector<double>& given = !fixed        ? options.tols
                                     : is_explicit ? options.explicit_steps
                                                   : options.steps;
  for (double value : given.empty() ? (fixed ? steps : tols) : given) {
    Setting setting;
    (fixed ? setting.step : setting.tol) = value;
    list.push_back(setting);
  }
  return list;
}

double count_evaluations(const Cost& cost) {
  return static_cast<double>(std::max({cost.steps, cost.rhs, cost.moments, cost.newton_iterations}));
}

std::vector<InvariantSummary> summarise_invariants(const AnyModel& model, const Trace& trace,
                                                   double evaluations) {
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
      // Divided by the scale before it is squared, which very small or large values would not survive.
      double square = 0.0;
      for (std::size_t i = 0; i < size; ++i)
        square += std::pow((value[i] - summary.initial[i]) / info.scale, 2);
      const double drift = size == 1 ? (value[0] - summary.initial[0]) / info.scale : std::sqrt(square);
      summary.times.push_back(trace.t[k]);
      summary.drift.push_back(drift);
      summary.final.assign(value, value + size);
      summary.max_drift = std::isnan(drift) ? drift : std::max(summary.max_drift, std::abs(drift));
    }
    if (!summary.times.empty())
      summary.measured =
          measure_drift(summary.times, summary.drift, summary.times.front(), rounding_level(evaluations));
    summary.slope = summary.measured.slope;
    offset += size;
    summaries.push_back(std::move(summary));
  }
  return summaries;
}

void thin(InvariantSummary& summary) {
  std::vector<double> times, drift;
  double largest = 0.0, next = 0.0;
  for (std::size_t k = 0; k < summary.times.size(); ++k) {
    largest = std::max(largest, std::abs(summary.drift[k]));
    const double t = summary.times[k];
    if (t <= 0.0 || (t < next && k + 1 < summary.times.size())) continue;
    times.push_back(t);
    drift.push_back(largest);
    next = t * std::pow(10.0, 1.0 / 12.0);
  }
  summary.times = std::move(times);
  summary.drift = std::move(drift);
}

}  // namespace gnomon
