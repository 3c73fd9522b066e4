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

namespace {
Cell marked(Cell cell, const LevelCost& cost) {
  if (cost.upper_bound) cell.text = "≤ " + cell.text;
  if (cost.few) cell.text += "°";
  return cell;
}
}  // namespace

Cell microseconds_cell(const std::optional<LevelCost>& cost) {
  return cost ? marked(output::number_cell(1e6 * cost->cost, 3), *cost) : Cell{};
}

Cell evaluations_cell(const std::optional<LevelCost>& cost) {
  return cost ? marked(output::count_cell(std::llround(cost->cost)), *cost) : Cell{};
}

std::string reference_line(const Scene& scene, const ReferenceStates& reference) {
  if (reference.kind.empty())
    return fmt::format("no reference{}", reference.message.empty() ? "" : ": " + reference.message);
  std::string bounds;
  const std::vector<MetricInfo> metrics = scene.model->metrics();
  for (std::size_t k = 0; k < metrics.size(); ++k)
    bounds += fmt::format("{}{} {}", k ? ", " : "", metrics[k].name,
                          output::at_most(reference.bounds.back()[k], 2));
  return fmt::format("reference: {} ({}), error bound: {}", reference.kind, reference.methods.front(),
                     bounds);
}

std::string reference_line(const SceneStudy& study) { return reference_line(study.scene, study.reference); }

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

Cell order_cell(const ObservedOrder& order, const std::optional<double>& declared) {
  switch (order.finding) {
    case OrderFinding::approaching:
      return {fmt::format("→ {:g}", declared.value_or(0.0)), ""};
    case OrderFinding::exact:
    case OrderFinding::roundoff:
      return {std::string(to_string(order.finding)), ""};
    default:
      break;
  }
  if (!order.observed) return {};
  Cell cell = output::number_cell(*order.observed, 3);
  if (order.finding == OrderFinding::differs) cell.text += fmt::format(" ({:g})", declared.value_or(0.0));
  return cell;
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
    table.rows.push_back({std::string(row.scheme->name), row.metric,
                          order.finding == OrderFinding::exact || order.finding == OrderFinding::roundoff
                              ? order_cell(order, row.expected)
                              : output::number_cell(order.observed.value_or(none), 3),
                          output::number_cell(order.observed ? order.interval[0] : none, 3),
                          output::number_cell(order.observed ? order.interval[1] : none, 3),
                          output::number_cell(row.expected.value_or(none), 2),
                          output::count_cell(order.points), order.verdict,
                          output::number_cell(row.floor ? row.floor->level : none, 2),
                          row.floor_kind ? Cell(std::string(to_string(*row.floor_kind))) : Cell{}});
  }
  table.notes.push_back(
      "observed order: exact, roundoff: the error is at roundoff at every step, of a scheme without or with "
      "a "
      "declared order; — not asymptotic; it differs from the declared one by more than 0.1, 2 % and its "
      "quartiles where the verdict says so");
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

}  // namespace gnomon
