#include "src/study/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/measure/work.hpp"

namespace gnomon {
namespace {

std::vector<double> default_tols(bool quick) {
  std::vector<double> tols;
  for (int k = quick ? 3 : 5; k <= (quick ? 12 : 26); ++k)
    tols.push_back(std::pow(10.0, quick ? -k : -0.5 * k));
  return tols;
}

constexpr double loosest_tol = 0.1;

std::vector<Setting> work_ladder(const Scene& scene, const SchemeInfo& scheme, const StudyOptions& options) {
  // High orders fall to roundoff within a few doublings, from larger steps.
  const std::vector<double> steps = is_of_high_order(scene, scheme)
                                        ? step_ladder(scene, scheme, options.quick ? 13 : 17, 0.5)
                                        : step_ladder(scene, scheme, options.quick ? 8 : 11, 1.0);
  return settings(scheme, options, steps, default_tols(options.quick));
}

/// Errors against the cost by which the setting for a level is chosen, CPU time where the study is timed and
/// else evaluations, and beside them both costs of the same settings.
struct Costs {
  std::vector<WorkPoint> curve;
  std::vector<double> seconds, evaluations;
};

bool is_timed(const Comparison& study) {
  return std::ranges::any_of(study.rows, [](const Row& row) { return row.timing.has_value(); });
}

/// Of the runs that say something: not of those that a limit stopped or that were left untimed.
Costs ladder_of(const Comparison& study, const SchemeInfo& scheme) {
  const bool timed = is_timed(study);
  Costs costs;
  for (const Row& row : study.rows) {
    const Status status = row.result.status;
    if (row.scheme != &scheme || status == Status::time_limit || status == Status::step_limit) continue;
    if (timed && status == Status::ok && !row.timing) continue;
    const auto evaluations = static_cast<double>(row.evaluations());
    const double seconds = row.timing ? row.timing->median : std::nan("");
    costs.curve.push_back({row.error.empty() ? std::nan("") : row.error[0], timed ? seconds : evaluations});
    costs.seconds.push_back(seconds);
    costs.evaluations.push_back(evaluations);
  }
  return costs;
}

}  // namespace

CostRow costs_of(const Comparison& study, const SchemeInfo& scheme, const std::vector<double>& levels) {
  const Costs costs = ladder_of(study, scheme);
  CostRow row{&scheme, {}, {}};
  for (const double level : levels) {
    auto setting = level_setting(costs.curve, level);
    // A closed form has one setting and no looser one.
    if (setting && scheme.stepping == Stepping::closed_form) setting->upper_bound = setting->few = false;
    const auto there = [&](const std::vector<double>& list) -> std::optional<LevelCost> {
      if (!setting || !(list[setting->place] > 0.0)) return std::nullopt;
      return cost_there(*setting, list);
    };
    row.seconds.push_back(there(costs.seconds));
    row.evaluations.push_back(there(costs.evaluations));
  }
  return row;
}

namespace {

/// Sought at twenty levels a decade.
std::vector<Cheapest> cheapest_of(const Comparison& study) {
  std::vector<Cheapest> list;
  if (!is_timed(study)) return list;
  std::vector<std::vector<WorkPoint>> curves;
  for (const CostRow& cost : study.costs) curves.push_back(ladder_of(study, *cost.scheme).curve);
  for (int k = 20; k <= 240; ++k) {
    const double level = std::pow(10.0, -0.05 * k);
    const SchemeInfo* best = nullptr;
    double least = 0.0;
    for (std::size_t s = 0; s < curves.size(); ++s)
      if (const auto cost = cost_at(curves[s], level); cost && (!best || *cost < least)) {
        best = study.costs[s].scheme;
        least = *cost;
      }
    if (!best) break;
    if (list.empty() || list.back().scheme != best) list.push_back({best, level, level});
    list.back().to = level;
  }
  return list;
}

/// The Pareto front among all rows, by one of their costs; not finite where a row has none.
template <class CostOf>
std::vector<bool> front_of(const Comparison& study, CostOf&& cost_of_row) {
  std::vector<WorkPoint> points;
  for (const Row& row : study.rows)
    points.push_back({row.error.empty() ? std::nan("") : row.error[0], cost_of_row(row)});
  return pareto_front(points);
}

bool is_default_ladder(const SchemeInfo& scheme, const StudyOptions& options) {
  if (scheme.stepping == Stepping::closed_form) return false;
  if (scheme.stepping == Stepping::adaptive) return options.tols.empty();
  return options.steps.empty() && !(scheme.stages > 0 && !options.explicit_steps.empty());
}

/// Puts looser settings before those of the default ladders whose loosest one already reaches the loosest
/// level, until one does not or fails, which is left out: what a level costs must not depend on where a
/// ladder begins.
void loosen(Runner& runner, Comparison& study, const std::vector<const SchemeInfo*>& schemes,
            const StudyOptions& options) {
  const double level = study.levels.front();
  std::vector<const SchemeInfo*> open;
  for (const SchemeInfo* scheme : schemes)
    if (is_default_ladder(*scheme, options)) open.push_back(scheme);
  const auto loosest = [&](const SchemeInfo* scheme) {
    return std::ranges::find(study.rows, scheme, &Row::scheme);
  };
  while (!open.empty() && !runner.stopped()) {
    std::vector<RunPlan> plans;
    for (const SchemeInfo* scheme : open) {
      const auto row = loosest(scheme);
      if (row == study.rows.end() || row->result.status != Status::ok || row->error.empty() ||
          !(row->error[0] <= level))
        continue;
      if (const auto setting = looser(study.scene, row->setting)) plans.push_back({scheme, *setting});
    }
    if (plans.empty()) return;
    open.clear();
    for (Row& row : runner.run_each(study.scene, study.reference, plans, options, [](const RunPlan&) {})) {
      if (row.result.status != Status::ok || !row.result.flags.empty()) continue;
      open.push_back(row.scheme);
      study.rows.insert(loosest(row.scheme), std::move(row));
    }
  }
}

}  // namespace

std::optional<Setting> looser(const Scene& scene, const Setting& setting) {
  if (setting.tol) {
    if (*setting.tol > 0.5 * loosest_tol) return std::nullopt;
    return Setting{std::nullopt, std::min(10.0 * *setting.tol, loosest_tol)};
  }
  const std::vector<double> breaks = scene.model->breaks();
  const StepPlan plan = plan_steps(scene.t_end, *setting.step, breaks);
  // Half the number of steps, fewer where only that meets the breaks as this one does.
  for (long count = plan.count / 2; count >= 1; --count) {
    const double step = scene.t_end / static_cast<double>(count);
    if (plan.misses_break || !plan_steps(scene.t_end, step, breaks).misses_break)
      return Setting{step, std::nullopt};
  }
  return std::nullopt;
}

std::size_t compare_runs(const Catalogue& catalogue, const Scene& scene, const StudyOptions& options) {
  std::size_t runs = 0;
  for (const SchemeInfo* scheme : select(catalogue, scene, options))
    runs += work_ladder(scene, *scheme, options).size();
  return runs + (options.timing ? 1 : 0);
}

Comparison compare(Runner& runner, Scene scene, const StudyOptions& options, output::Progress& progress) {
  Comparison study;
  study.scene = std::move(scene);
  study.levels = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12};
  const auto schemes = select(runner.catalogue(), study.scene, options);
  study.reference = runner.reference(study.scene, options);
  std::vector<RunPlan> plans;
  for (const SchemeInfo* scheme : schemes)
    for (const Setting& setting : work_ladder(study.scene, *scheme, options))
      plans.push_back({scheme, setting});
  study.rows = runner.run_each(study.scene, study.reference, plans, options, [&](const RunPlan& plan) {
    progress.begin(fmt::format("{} / {}  {}", study.scene.name, plan.scheme->name, plan.setting.text()));
  });
  loosen(runner, study, schemes, options);
  study.interrupted = runner.stopped();
  if (study.interrupted) return study;
  if (options.timing) {
    progress.begin(fmt::format("{} / timing {} runs, interleaved", study.scene.name, study.rows.size()));
    runner.time(study.scene, study.rows, options);
  }
  study.interrupted = runner.stopped();
  for (const SchemeInfo* scheme : schemes) study.costs.push_back(costs_of(study, *scheme, study.levels));
  study.cheapest = cheapest_of(study);
  study.front_in_time =
      front_of(study, [](const Row& row) { return row.timing ? row.timing->median : std::nan(""); });
  study.front_in_evaluations =
      front_of(study, [](const Row& row) { return static_cast<double>(row.evaluations()); });
  return study;
}

}  // namespace gnomon
