#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "src/output/figure_style.hpp"
#include "src/study/present.hpp"
#include "src/study/static_refine.hpp"
#include "src/study/vary_output.hpp"

namespace gnomon {
namespace {

using output::Cell;

std::string quantity(const StaticRefinePlan& plan) {
  return fmt::format("{} of {}", fmt::join(plan.components, ", "), plan.probe);
}

std::string row_label(const StaticRefinePlan& plan, std::size_t row) {
  return plan.rows.values[row] + (plan.row_set.empty() ? "" : ", " + plan.row_set[row]);
}

}  // namespace

output::Table static_refine_table(const StaticRefinement& study) {
  const StaticRefinePlan& plan = study.plan;
  output::Table table;
  table.caption =
      fmt::format("Static error of {} [{}] over {}, {}{}{}", quantity(plan), study.unit, plan.columns.key,
                  plan.scene, plan.set.empty() ? "" : ", ", fmt::join(plan.set, ", "));
  table.columns = {{"value", plan.rows.key}};
  for (const std::string& value : plan.columns.values) table.columns.push_back({"error_at_" + value, value});
  if (!study.orders.empty()) table.columns.push_back({"order", "order"});
  std::vector<Cell> bounds{"bound of the reference"};
  for (const double bound : study.bounds)
    bounds.push_back(std::isfinite(bound) ? output::at_most_cell(bound, 2) : Cell{});
  if (!study.orders.empty()) bounds.emplace_back();
  table.rows.push_back(std::move(bounds));
  for (std::size_t row = 0; row < study.errors.size(); ++row) {
    std::vector<Cell> cells{row_label(plan, row)};
    for (const StaticError& each : study.errors[row]) {
      if (each.error)
        cells.push_back(each.below_bound ? output::at_most_cell(*each.error, 2)
                                         : output::number_cell(*each.error));
      else if (each.status == Status::interrupted)
        cells.emplace_back();
      else
        cells.emplace_back(std::string(to_string(each.status)), "");
    }
    if (!study.orders.empty()) cells.push_back(order_cell(study.orders[row], plan.orders[row]));
    table.rows.push_back(std::move(cells));
  }
  table.notes.push_back(fmt::format("against {}; bound of the reference: its distance from {}",
                                    fmt::join(plan.reference, ", "), fmt::join(plan.coarser, ", ")));
  if (!study.orders.empty()) table.notes.emplace_back(order_marks);
  for (std::size_t row = 0; row < study.orders.size(); ++row)
    table.notes.push_back(
        fmt::format("{} = {}: {}", plan.rows.key, plan.rows.values[row], study.orders[row].verdict));
  if (!plan.meaning.empty()) table.notes.push_back(plan.meaning);
  return table;
}

output::Figure static_refine_figure(const StaticRefinement& study) {
  const StaticRefinePlan& plan = study.plan;
  output::Figure figure;
  figure.title = fmt::format("{}: static error of {}", plan.scene, quantity(plan));
  figure.hollow_note = "hollow: at or below the bound of the reference";
  output::Panel panel = varied_panel(plan.columns);
  panel.log_x = true;
  panel.y_label = fmt::format("error [{}]", study.unit);
  for (std::size_t row = 0; row < study.errors.size(); ++row) {
    output::Series series;
    series.label = fmt::format("{} = {}", plan.rows.key, row_label(plan, row));
    series.style = static_cast<int>(row);
    for (std::size_t k = 0; k < study.errors[row].size(); ++k) {
      const StaticError& each = study.errors[row][k];
      series.x.push_back(varied_x(plan.columns, k));
      series.y.push_back(each.error.value_or(std::nan("")));
      series.hollow.push_back(each.below_bound);
    }
    panel.series.push_back(std::move(series));
  }
  figure.panels.push_back(std::move(panel));
  output::settle_styles(figure);
  return figure;
}

nlohmann::ordered_json static_refine_json(const StaticRefinement& study) {
  const auto number = [](double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
  };
  const StaticRefinePlan& plan = study.plan;
  nlohmann::ordered_json json{{"scene", plan.scene},
                              {"set", plan.set},
                              {"probe", plan.probe},
                              {"components", plan.components},
                              {"unit", study.unit},
                              {"reference", plan.reference},
                              {"coarser", plan.coarser},
                              {"bounds", nlohmann::ordered_json::array()},
                              {"errors", nlohmann::ordered_json::array()}};
  for (std::size_t k = 0; k < study.bounds.size(); ++k)
    json["bounds"].push_back(
        {{plan.columns.key, plan.columns.values[k]}, {"bound", number(study.bounds[k])}});
  for (std::size_t row = 0; row < study.errors.size(); ++row)
    for (std::size_t k = 0; k < study.errors[row].size(); ++k) {
      const StaticError& each = study.errors[row][k];
      json["errors"].push_back({{plan.rows.key, plan.rows.values[row]},
                                {plan.columns.key, plan.columns.values[k]},
                                {"status", to_string(each.status)},
                                {"error", number(each.error.value_or(std::nan("")))},
                                {"below_bound", each.below_bound}});
    }
  for (std::size_t row = 0; row < study.orders.size(); ++row)
    json["orders"].push_back({{plan.rows.key, plan.rows.values[row]},
                              {"expected", plan.orders[row]},
                              {"observed", number(study.orders[row].observed.value_or(std::nan("")))},
                              {"verdict", study.orders[row].verdict}});
  return json;
}

}  // namespace gnomon
