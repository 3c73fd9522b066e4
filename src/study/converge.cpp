#include "src/study/converge.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace gnomon {
namespace {

std::vector<double> default_tols() {
  std::vector<double> tols;
  for (int k = 3; k <= 12; ++k) tols.push_back(std::pow(10.0, -k));
  return tols;
}

std::vector<Setting> order_ladder(const Scene& scene, const SchemeInfo& scheme, const StudyOptions& options) {
  return settings(scheme, options, step_ladder(scene, scheme, options.quick ? 17 : 21, 0.5), default_tols());
}

// Runs once more, with a hundredth of the Newton tolerance, at a step of each floor whose scheme iterates.
void tell_floors_apart(Runner& runner, Convergence& study, const StudyOptions& options) {
  struct Question {
    OrderRow* order;
    const Row* row;
    std::size_t metric;
  };
  std::vector<Question> questions;
  std::vector<RunPlan> plans;
  const std::vector<MetricInfo> metrics = study.scene.model->metrics();
  for (OrderRow& order : study.orders) {
    if (!order.floor) continue;
    const auto row = std::ranges::find_if(study.rows, [&](const Row& each) {
      return each.scheme == order.scheme && each.result.step == order.floor->typical_step;
    });
    const auto metric = std::ranges::find(metrics, order.metric, &MetricInfo::name);
    if (row == study.rows.end() || metric == metrics.end()) continue;
    if (row->result.cost.newton_iterations == 0) {
      order.floor_kind = FloorKind::roundoff;
      continue;
    }
    questions.push_back({&order, &*row, static_cast<std::size_t>(metric - metrics.begin())});
    plans.push_back({order.scheme, row->setting});
  }
  if (plans.empty()) return;
  StudyOptions tight = options;
  tight.scheme.newton_tol *= 0.01;
  const std::vector<Row> rows =
      runner.run_each(study.scene, study.reference, plans, tight, [](const RunPlan&) {});
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto& [order, row, metric] = questions[k];
    if (rows[k].result.status != Status::ok || metric >= rows[k].error.size()) continue;
    const FloorKind kind = floor_kind_of(row->error[metric], rows[k].error[metric]);
    // A floor far above roundoff that the tolerance does not move is of another kind.
    if (kind == FloorKind::newton || order->floor->level < 1e-6) order->floor_kind = kind;
  }
}

}  // namespace

OrderRow observed_order(const SceneStudy& study, const SchemeInfo& scheme, std::size_t metric) {
  const MetricInfo info = study.scene.model->metrics()[metric];
  std::vector<OrderPoint> points;
  for (const Row& row : study.rows) {
    if (row.scheme != &scheme) continue;
    OrderPoint point;
    point.step = row.result.step.value_or(0.0);
    point.usable = row.result.status == Status::ok && !row.error.empty();
    if (point.usable)
      point.error = row.error[metric];
    else
      point.why_not =
          row.result.status == Status::ok ? "no reference" : std::string(to_string(row.result.status));
    if (point.usable && !row.result.flags.empty()) {
      point.usable = false;
      point.why_not = row.result.flags.front();
    }
    points.push_back(std::move(point));
  }
  OrderOptions options;
  options.scale = info.saturation;
  if (!study.reference.bounds.empty()) options.bound = study.reference.bounds.back()[metric];
  options.declared = scheme.order_for(study.scene.model->load_class(), info.name);
  return {&scheme, std::string(info.name), observe_order(points, options), options.declared,
          find_floor(points, options)};
}

FloorKind floor_kind_of(double error, double tightened) {
  return tightened < 0.2 * error ? FloorKind::newton : FloorKind::roundoff;
}

std::size_t converge_runs(const Catalogue& catalogue, const Scene& scene, const StudyOptions& options) {
  std::size_t runs = 0;
  for (const SchemeInfo* scheme : select(catalogue, scene, options))
    runs += order_ladder(scene, *scheme, options).size();
  return runs;
}

Convergence converge(Runner& runner, Scene scene, const StudyOptions& options, output::Progress& progress) {
  Convergence study;
  study.scene = std::move(scene);
  const auto schemes = select(runner.catalogue(), study.scene, options);
  study.reference = runner.reference(study.scene, options);
  std::vector<RunPlan> plans;
  for (const SchemeInfo* scheme : schemes)
    for (const Setting& setting : order_ladder(study.scene, *scheme, options))
      plans.push_back({scheme, setting});
  study.rows = runner.run_each(study.scene, study.reference, plans, options, [&](const RunPlan& plan) {
    progress.begin(fmt::format("{} / {}  {}", study.scene.name, plan.scheme->name, plan.setting.text()));
  });
  study.interrupted = runner.stopped();
  // After an interruption the scheme that was underway, and what follows it, have no order.
  for (const SchemeInfo* scheme : schemes) {
    const auto is_of = [&](const auto& each) { return each.scheme == scheme; };
    if (study.interrupted && std::ranges::count_if(study.rows, is_of) < std::ranges::count_if(plans, is_of))
      break;
    if (scheme->stepping == Stepping::fixed)
      for (std::size_t metric = 0; metric < study.scene.model->metrics().size(); ++metric)
        study.orders.push_back(observed_order(study, *scheme, metric));
  }
  if (!study.interrupted) tell_floors_apart(runner, study, options);
  return study;
}

}  // namespace gnomon
