#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/study/present.hpp"

namespace gnomon {
namespace {

using output::Align;
using output::Cell;
using output::Table;

/// One column a time at which errors are looked at.
std::vector<output::Column> error_columns(const DriftStudy& study) {
  const MetricInfo metric = study.scene.model->metrics()[0];
  std::vector<output::Column> columns;
  for (const ErrorsBefore& before : study.before)
    columns.push_back(
        {fmt::format("error_at_{:g}_s", before.scene.t_end),
         fmt::format("{} error at t = {:g} s [{}]", metric.name, before.scene.t_end, metric.unit)});
  if (study.error_at_end)
    columns.push_back({"error", fmt::format("{} error [{}]", metric.name, metric.unit)});
  return columns;
}

std::vector<Cell> error_cells(const DriftStudy& study, std::size_t row) {
  std::vector<Cell> cells;
  for (const ErrorsBefore& before : study.before)
    cells.push_back(row < before.rows.size() ? error_cell(before.rows[row], 0) : Cell{});
  if (study.error_at_end) cells.push_back(error_cell(study.rows[row], 0));
  return cells;
}

/// By how much at most the runs that end earlier step in another way, relative to the step.
double step_difference(const DriftStudy& study) {
  double difference = 0.0;
  for (const ErrorsBefore& before : study.before)
    for (std::size_t k = 0; k < std::min(before.rows.size(), study.rows.size()); ++k) {
      const auto &one = before.rows[k].result.step, &other = study.rows[k].result.step;
      if (one && other) difference = std::max(difference, std::abs(*one / *other - 1.0));
    }
  return difference;
}

void add_error_notes(const DriftStudy& study, Table& table) {
  for (const ErrorsBefore& before : study.before)
    table.notes.push_back(
        fmt::format("at t = {:g} s: {}", before.scene.t_end, reference_line(before.scene, before.reference)));
  if (!study.before.empty()) {
    const double difference = step_difference(study);
    table.notes.push_back(
        "errors before the end: of runs with the same settings that end there" +
        (difference > 1e-9
             ? fmt::format("; their steps differ by up to {:.2g} %, to meet that time", 100.0 * difference)
             : ""));
  }
  if (!study.error_at_end) return;
  table.notes.push_back(reference_line(study));
  if (study.reference.kind.empty() && study.before.empty())
    table.notes.back() += "; --error-at shows the errors at earlier times";
}

}  // namespace

std::string undecided_note(const DriftStudy& study) {
  std::string text;
  for (const DriftRow& row : study.drifts) {
    const Row& run = study.rows[row.row];
    const std::string why = why_undecided(row.drift);
    if (why.empty() || run.result.status != Status::ok) continue;
    text += fmt::format("{}{}, {}, {}: {}", text.empty() ? "undecided: " : "; ", run.scheme->name,
                        run.setting.text(), row.invariant.info.name, why);
  }
  return text;
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
                   {"verdict", "verdict", Align::left}};
  for (output::Column& column : error_columns(study)) table.columns.push_back(std::move(column));
  table.columns.push_back({"status", "status", Align::left});
  for (const DriftRow& row : study.drifts) {
    const Row& run = study.rows[row.row];
    const bool ok = run.result.status == Status::ok;
    std::string status(to_string(run.result.status));
    if (!run.result.message.empty()) status += ": " + run.result.message;
    table.rows.push_back({std::string(run.scheme->name), run.setting.text(), row.invariant.info.name,
                          output::number_cell(row.drift.max_abs), output::number_cell(row.drift.oscillation),
                          output::number_cell(row.drift.slope), output::number_cell(row.drift.slope_error, 2),
                          output::number_cell(row.drift.growth, 2),
                          std::string(ok ? to_string(row.drift.verdict) : "failed")});
    for (Cell& cell : error_cells(study, row.row)) table.rows.back().push_back(std::move(cell));
    table.rows.back().emplace_back(status);
  }
  table.notes.push_back("drift relative to the invariant's scale, at jittered times");
  table.notes.push_back(verdict_marks);
  if (const std::string note = undecided_note(study); !note.empty()) table.notes.push_back(note);
  add_error_notes(study, table);
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
  for (output::Column& column : error_columns(study)) table.columns.push_back(std::move(column));
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
    for (Cell& cell : error_cells(study, k)) cells.push_back(std::move(cell));
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
      "steps that ended well; of three steps or more, drifts above 1e-11");
  table.notes.push_back(verdict_marks);
  if (const std::string note = undecided_note(study); !note.empty()) table.notes.push_back(note);
  table.notes.push_back(
      "largest drift relative to the invariant's scale, at jittered times; of a run that failed, up to the "
      "time it reached");
  add_error_notes(study, table);
  return table;
}

}  // namespace gnomon
