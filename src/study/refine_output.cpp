#include "src/study/refine_output.hpp"

#include <fmt/format.h>

#include <cmath>

#include "src/output/figure_style.hpp"
#include "src/study/present.hpp"

namespace gnomon {

using output::Align;

namespace {

const std::string& name_of(const Refinement& study) { return study.meshes.front().scene.name; }

std::string reference_note(const Refinement& study) {
  return study.message.empty() ? reference_line(study.meshes.front()) : "no errors: " + study.message;
}

}  // namespace

output::Table refinement_table(const Refinement& study) {
  output::Table table;
  table.caption = fmt::format("Error in space, {}", name_of(study));
  const std::vector<MetricInfo> metrics = study.meshes.front().scene.model->metrics();
  table.columns = {{"value", study.key}};
  for (const MetricInfo& metric : metrics) {
    table.columns.push_back({fmt::format("{}_error_{}", metric.name, metric.unit),
                             fmt::format("{} error [{}]", metric.name, metric.unit)});
    table.columns.push_back({fmt::format("{}_time_error_{}", metric.name, metric.unit), "of it in time"});
  }
  table.columns.push_back({"rhs", "rate evaluations"});
  table.columns.push_back({"status", "status", Align::left});
  for (std::size_t k = 0; k < study.meshes.size(); ++k) {
    const Row& row = study.meshes[k].rows.front();
    std::vector<output::Cell> cells{output::number_cell(study.values[k], 4)};
    for (std::size_t m = 0; m < metrics.size(); ++m) {
      if (row.error.empty())
        cells.emplace_back();
      else
        cells.push_back(row.below_bound[m] ? output::at_most_cell(row.error[m])
                                           : output::number_cell(row.error[m]));
      cells.push_back(study.time_errors[k].empty() ? output::Cell{}
                                                   : output::number_cell(study.time_errors[k][m], 2));
    }
    cells.push_back(output::count_cell(row.result.cost.rhs));
    std::string status(to_string(row.result.status));
    if (!row.result.message.empty()) status += ": " + row.result.message;
    cells.push_back(status);
    table.rows.push_back(std::move(cells));
  }
  table.notes.push_back(fmt::format("{}, {}; of it in time: change against {}", study.scheme->name,
                                    study.meshes.front().rows.front().setting.text(), study.setting.text()));
  table.notes.push_back(reference_note(study));
  return table;
}

output::Table refinement_orders_table(const Refinement& study) {
  output::Table table;
  table.caption = fmt::format("Observed order in space, {}", name_of(study));
  table.columns = {{"metric", "error", Align::left},
                   {"observed", "observed order"},
                   {"low", "quartile"},
                   {"high", "quartile"},
                   {"points", "points"},
                   {"verdict", "verdict", Align::left}};
  for (const OrderRow& row : study.orders) {
    const ObservedOrder& order = row.order;
    const double none = std::nan("");
    table.rows.push_back({row.metric, output::number_cell(order.observed.value_or(none), 3),
                          output::number_cell(order.observed ? order.interval[0] : none, 3),
                          output::number_cell(order.observed ? order.interval[1] : none, 3),
                          output::count_cell(order.points), order.verdict});
  }
  table.notes.push_back(reference_note(study));
  return table;
}

output::Figure refinement_figure(const Refinement& study) {
  output::Figure figure;
  figure.title = name_of(study);
  figure.hollow_note = "hollow: at or below the error of the finest mesh";
  output::Panel panel{.title = "error in space",
                      .x_label = fmt::format("1 / {}", study.key),
                      .y_label = fmt::format("error at t = {:g} s", study.meshes.front().scene.t_end)};
  const std::vector<MetricInfo> metrics = study.meshes.front().scene.model->metrics();
  for (std::size_t m = 0; m < metrics.size(); ++m) {
    output::Series series;
    series.label = fmt::format("{} [{}]", metrics[m].name, metrics[m].unit);
    series.style = static_cast<int>(m);
    for (std::size_t k = 0; k < study.meshes.size(); ++k) {
      const Row& row = study.meshes[k].rows.front();
      if (row.error.empty()) continue;
      series.x.push_back(1.0 / study.values[k]);
      series.y.push_back(row.error[m]);
      series.hollow.push_back(row.below_bound[m]);
    }
    panel.series.push_back(std::move(series));
  }
  figure.panels.push_back(std::move(panel));
  output::settle_styles(figure);
  return figure;
}

void add_refinement(Document& document, const Refinement& study) {
  const std::vector<MetricInfo> metrics = study.meshes.front().scene.model->metrics();
  for (std::size_t k = 0; k < study.meshes.size(); ++k) {
    document.add(study.meshes[k]);
    nlohmann::ordered_json& run = document.json()["runs"].back();
    run["refine"] = {{study.key, study.values[k]}};
    run["time_error"] = nullptr;
    for (std::size_t m = 0; m < study.time_errors[k].size(); ++m)
      run["time_error"][std::string(metrics[m].name)] = study.time_errors[k][m];
  }
  document.add_orders(name_of(study), study.orders);
}

}  // namespace gnomon
