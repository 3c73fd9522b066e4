#include "src/study/present.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/environment.hpp"

namespace gnomon {
namespace {

using output::Align;
using output::Cell;
using output::Table;

std::string unit_of(const MetricInfo& metric) {
  return metric.unit == "1" ? "relative" : std::string(metric.unit);
}

}  // namespace

int style_of_scheme(const Catalogue& catalogue, const SchemeInfo& scheme) {
  for (std::size_t k = 0; k < catalogue.schemes.size(); ++k)
    if (catalogue.schemes[k].name == scheme.name) return static_cast<int>(k);
  return 0;
}

Cell error_cell(const Row& row, std::size_t metric) {
  if (metric >= row.error.size()) return {};
  return row.below_bound[metric] ? output::at_most_cell(row.error[metric])
                                 : output::number_cell(row.error[metric]);
}

Cell microseconds_cell(const std::optional<LevelCost>& cost) {
  if (!cost) return {};
  Cell cell = output::number_cell(1e6 * cost->cost, 3);
  if (cost->upper_bound) cell.text = "≤ " + cell.text;
  return cell;
}

Cell evaluations_cell(const std::optional<LevelCost>& cost) {
  if (!cost) return {};
  Cell cell = output::count_cell(std::llround(cost->cost));
  if (cost->upper_bound) cell.text = "≤ " + cell.text;
  return cell;
}

std::string reference_line(const SceneStudy& study) {
  const ReferenceStates& reference = study.reference;
  if (reference.kind.empty())
    return fmt::format("no reference{}", reference.message.empty() ? "" : ": " + reference.message);
  std::string bounds;
  const std::vector<MetricInfo> metrics = study.scene.model->metrics();
  for (std::size_t k = 0; k < metrics.size(); ++k)
    bounds += fmt::format("{}{} {}", k ? ", " : "", metrics[k].name,
                          output::at_most(reference.bounds.back()[k], 2));
  return fmt::format("reference: {} ({}), error bound: {}", reference.kind, reference.methods.front(),
                     bounds);
}

void name_linear_solver(const SceneStudy& study, const std::vector<const SchemeInfo*>& schemes,
                        Table& table) {
  if (study.rows.empty()) return;
  const LinearSolver solver = study.rows.front().options.linear_solver;
  if (solver == LinearSolver::block) return;
  table.columns.insert(table.columns.begin() + 1, {"linear_solver", "linear solver", Align::left});
  for (std::size_t k = 0; k < table.rows.size(); ++k)
    table.rows[k].insert(table.rows[k].begin() + 1,
                         schemes[k]->uses.linear_solver ? Cell(std::string(to_string(solver))) : Cell{});
}

Table runs_table(const SceneStudy& study, const std::string& caption) {
  Table table;
  table.caption = caption;
  table.columns = {{"integrator", "integrator", Align::left}, {"step_s", "step [s]"}, {"tol", "tolerance"}};
  for (const MetricInfo& metric : study.scene.model->metrics())
    table.columns.push_back(
        {fmt::format("{}_error_{}", metric.name, metric.unit == "1" ? "rel" : metric.unit),
         fmt::format("{} error [{}]", metric.name, unit_of(metric))});
  table.columns.insert(table.columns.end(), {{"steps", "steps"},
                                             {"rhs", "rate evaluations"},
                                             {"moments", "moment evaluations"},
                                             {"cpu_median_s", "CPU time [s]"},
                                             {"cpu_min_s", "least [s]"},
                                             {"cpu_max_s", "most [s]"},
                                             {"status", "status", Align::left},
                                             {"t_s", "time reached [s]"}});
  const std::size_t metrics = study.scene.model->metrics().size();
  bool unstable = false;
  for (const Row& row : study.rows) {
    const RunResult& result = row.result;
    std::vector<Cell> cells{std::string(row.scheme->name),
                            result.step ? output::number_cell(*result.step, 4) : Cell{},
                            row.setting.tol ? output::number_cell(*row.setting.tol, 2) : Cell{}};
    for (std::size_t k = 0; k < metrics; ++k) cells.push_back(error_cell(row, k));
    const bool closed = row.scheme->stepping == Stepping::closed_form;
    cells.push_back(closed ? Cell{} : output::count_cell(result.cost.steps));
    cells.push_back(output::count_cell(result.cost.rhs));
    cells.push_back(output::count_cell(result.cost.moments));
    if (row.timing) {
      unstable = unstable || row.timing->unstable;
      Cell median = output::engineering_cell(row.timing->median);
      if (row.timing->unstable) median.text += "*";
      cells.push_back(median);
      cells.push_back(output::engineering_cell(row.timing->min));
      cells.push_back(output::engineering_cell(row.timing->max));
    } else {
      cells.insert(cells.end(), 3, Cell{});
    }
    std::string status(to_string(result.status));
    if (!result.message.empty()) status += ": " + result.message;
    for (const std::string& flag : result.flags) status += "; " + flag;
    cells.push_back(status);
    cells.push_back(output::number_cell(result.t, 6));
    table.rows.push_back(std::move(cells));
  }
  std::vector<const SchemeInfo*> schemes;
  for (const Row& row : study.rows) schemes.push_back(row.scheme);
  name_linear_solver(study, schemes, table);
  table.notes.push_back(reference_line(study));
  if (unstable) table.notes.push_back(unstable_note);
  return table;
}

Table comparison_table(const Comparison& study, const std::string& caption) {
  Table table = runs_table(study, caption);
  if (study.front_in_evaluations.size() != study.rows.size()) return table;  // interrupted
  const auto status = std::ranges::find(table.columns, "status", &output::Column::key);
  const auto at = status - table.columns.begin();
  table.columns.insert(status, {"pareto", "Pareto front", Align::left});
  for (std::size_t k = 0; k < study.rows.size(); ++k) {
    const bool time = study.front_in_time[k], evaluations = study.front_in_evaluations[k];
    Cell cell;
    if (time || evaluations) cell = time && evaluations ? "time, evaluations" : time ? "time" : "evaluations";
    table.rows[k].insert(table.rows[k].begin() + at, cell);
  }
  table.notes.push_back(
      "Pareto front: no other run here is as exact for less CPU time, or fewer evaluations");
  return table;
}

Table orders_table(const Convergence& study) {
  Table table;
  table.caption = fmt::format("Observed order, {}", study.scene.name);
  table.columns = {{"integrator", "integrator", Align::left},
                   {"metric", "error", Align::left},
                   {"observed", "observed order"},
                   {"low", "quartile"},
                   {"high", "quartile"},
                   {"expected", "declared"},
                   {"points", "points"},
                   {"verdict", "verdict", Align::left},
                   {"floor", "floor"},
                   {"floor_kind", "kind of floor", Align::left}};
  for (const OrderRow& row : study.orders) {
    const ObservedOrder& order = row.order;
    const double none = std::nan("");
    table.rows.push_back(
        {std::string(row.scheme->name), row.metric, output::number_cell(order.observed.value_or(none), 3),
         output::number_cell(order.observed ? order.interval[0] : none, 3),
         output::number_cell(order.observed ? order.interval[1] : none, 3),
         output::number_cell(row.expected.value_or(none), 2), output::count_cell(order.points), order.verdict,
         output::number_cell(row.floor ? row.floor->level : none, 2),
         row.floor_kind ? Cell(std::string(to_string(*row.floor_kind))) : Cell{}});
  }
  if (std::ranges::any_of(study.orders, [](const OrderRow& row) { return row.floor.has_value(); }))
    table.notes.push_back(
        "floor: where the error stops falling with the step; Newton: a run with a hundredth of the Newton "
        "tolerance falls below it");
  table.notes.push_back(reference_line(study));
  return table;
}

Table costs_table(const Comparison& study) {
  Table table;
  const MetricInfo metric = study.scene.model->metrics()[0];
  table.caption = fmt::format("CPU microseconds (rate evaluations) to reach {} {} error [{}], {}",
                              std::string_view("aeiou").find(metric.name.front()) < 5 ? "an" : "a",
                              metric.name, metric.unit, study.scene.name);
  table.columns = {{"integrator", "integrator", Align::left}};
  for (std::size_t k = 0; k < study.levels.size(); k += 2) {
    const double level = study.levels[k];
    table.columns.push_back({fmt::format("cpu_us_at_{:.0e}", level), fmt::format("{:.0e}", level)});
    table.columns.push_back({fmt::format("rhs_at_{:.0e}", level), "(rates)"});
  }
  for (const CostRow& cost : study.costs) {
    std::vector<Cell> cells{std::string(cost.scheme->name)};
    for (std::size_t k = 0; k < study.levels.size(); k += 2) {
      cells.push_back(microseconds_cell(cost.seconds[k]));
      cells.push_back(evaluations_cell(cost.evaluations[k]));
    }
    table.rows.push_back(std::move(cells));
  }
  std::vector<const SchemeInfo*> schemes;
  for (const CostRow& cost : study.costs) schemes.push_back(cost.scheme);
  name_linear_solver(study, schemes, table);
  table.notes.push_back(reference_line(study));
  if (!study.cheapest.empty()) {
    std::string text = "cheapest in CPU time, from an error of 0.1 down:";
    for (const Cheapest& each : study.cheapest)
      text += fmt::format("{} {} to {:.1e} {}", &each == &study.cheapest.front() ? "" : ",",
                          each.scheme->name, each.to, metric.unit);
    table.notes.push_back(text);
  }
  table.notes.push_back(levels_note);
  return table;
}

Table drift_table(const DriftStudy& study) {
  Table table;
  table.caption =
      fmt::format("Drift of the invariants, {} to t = {:g} s", study.scene.name, study.scene.t_end);
  table.columns = {{"integrator", "integrator", Align::left},
                   {"setting", "setting", Align::left},
                   {"invariant", "invariant", Align::left},
                   {"max_drift", "largest drift"},
                   {"oscillation", "oscillation"},
                   {"slope_per_s", "slope [1/s]"},
                   {"slope_error_per_s", "its error [1/s]"},
                   {"growth", "growth exponent"},
                   {"verdict", "verdict", Align::left},
                   {"error", fmt::format("{} error [{}]", study.scene.model->metrics()[0].name,
                                         study.scene.model->metrics()[0].unit)},
                   {"status", "status", Align::left}};
  for (const DriftRow& row : study.drifts) {
    const Row& run = study.rows[row.row];
    const bool ok = run.result.status == Status::ok;
    std::string status(to_string(run.result.status));
    if (!run.result.message.empty()) status += ": " + run.result.message;
    table.rows.push_back({std::string(run.scheme->name), run.setting.text(), row.invariant.info.name,
                          output::number_cell(row.drift.max_abs), output::number_cell(row.drift.oscillation),
                          output::number_cell(row.drift.slope), output::number_cell(row.drift.slope_error, 2),
                          output::number_cell(row.drift.growth, 2),
                          std::string(ok ? to_string(row.drift.verdict) : "failed"), error_cell(run, 0),
                          status});
  }
  table.notes.push_back("drift relative to the invariant's scale, at jittered times");
  table.notes.push_back(reference_line(study));
  return table;
}

Table drift_runs_table(const DriftStudy& study) {
  Table table;
  table.caption = fmt::format("Runs by step, {} to t = {:g} s", study.scene.name, study.scene.t_end);
  table.columns = {{"integrator", "integrator", Align::left}, {"setting", "setting", Align::left}};
  const std::vector<InvariantInfo> infos = study.scene.model->invariant_info();
  for (const InvariantInfo& info : infos) {
    table.columns.push_back({info.name + "_max_drift", info.name + " drift"});
    table.columns.push_back({info.name + "_verdict", "verdict", Align::left});
  }
  table.columns.insert(
      table.columns.end(),
      {{"status", "status", Align::left}, {"reason", "reason", Align::left}, {"t_s", "time reached [s]"}});
  for (const InvariantInfo& info : infos)
    table.columns.push_back({info.name + "_h_scaling", info.name + " h-scaling"});
  for (std::size_t k = 0; k < study.rows.size(); ++k) {
    const RunResult& result = study.rows[k].result;
    std::vector<Cell> cells{std::string(study.rows[k].scheme->name), study.rows[k].setting.text()};
    for (const InvariantInfo& info : infos) {
      const auto row = std::ranges::find_if(study.drifts, [&](const DriftRow& each) {
        return each.row == k && each.invariant.info.name == info.name;
      });
      if (row == study.drifts.end()) {
        cells.insert(cells.end(), 2, Cell{});
        continue;
      }
      cells.push_back(output::number_cell(row->drift.max_abs, 2));
      cells.emplace_back(std::string(result.status == Status::ok ? to_string(row->drift.verdict) : "failed"));
    }
    cells.emplace_back(std::string(to_string(result.status)));
    cells.push_back(result.message.empty() ? Cell{} : Cell(result.message));
    cells.push_back(output::number_cell(result.t, 6));
    for (const InvariantInfo& info : infos) {
      const auto scaling = h_scaling(study, *study.rows[k].scheme, info.name);
      cells.push_back(scaling ? output::number_cell(scaling->exponent, 3) : Cell{});
    }
    table.rows.push_back(std::move(cells));
  }
  table.notes.push_back(
      "h-scaling: exponent s of the largest drift (bounded) or its slope (secular) ~ h^s over the scheme's "
      "steps that ended well");
  table.notes.push_back(
      "largest drift relative to the invariant's scale, at jittered times; of a run that failed, up to the "
      "time "
      "it reached");
  return table;
}

}  // namespace gnomon
