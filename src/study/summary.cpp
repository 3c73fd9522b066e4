#include "src/study/summary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "src/study/present.hpp"

namespace gnomon {
namespace {

long& count_of(std::vector<std::pair<Status, long>>& counts, Status status) {
  for (auto& [each, count] : counts)
    if (each == status) return count;
  return counts.emplace_back(status, 0).second;
}

}  // namespace

void RunCounts::add(const std::string& part, const SceneStudy& study) {
  if (parts_.empty() || parts_.back().name != part) parts_.push_back({part, {}});
  Part& counted = parts_.back();
  for (const Row& row : study.rows) {
    ++count_of(counted.counts, row.result.status);
    if (row.result.status == Status::crashed)
      failures_.push_back(fmt::format("crashed: {} / {}, {}: {}", study.scene.name, row.scheme->name,
                                      row.setting.text(), row.result.message));
  }
}

output::Table RunCounts::table() const {
  std::vector<std::pair<Status, long>> all;
  for (const Part& part : parts_)
    for (const auto& [status, count] : part.counts) count_of(all, status) += count;
  std::ranges::sort(all, {}, [](const auto& each) { return static_cast<int>(each.first); });
  output::Table table;
  table.caption = "How the runs ended";
  table.columns = {{"part", "part", output::Align::left}, {"runs", "runs"}};
  for (const auto& [status, count] : all) {
    const std::string name(to_string(status));
    table.columns.push_back({name, name});
  }
  const auto add_row = [&](const std::string& name, std::vector<std::pair<Status, long>> counts) {
    long runs = 0;
    for (const auto& [status, count] : counts) runs += count;
    std::vector<output::Cell> cells{name, output::count_cell(runs)};
    for (const auto& [status, count] : all) cells.push_back(output::count_cell(count_of(counts, status)));
    table.rows.push_back(std::move(cells));
  };
  for (const Part& part : parts_) add_row(part.name, part.counts);
  add_row("all", all);
  table.notes = failures_;
  return table;
}

void Fastest::add(const Comparison& study) {
  if (levels_.empty()) levels_ = study.levels;
  const MetricInfo metric = study.scene.model->metrics()[0];
  std::vector<output::Cell> cells{study.scene.name, fmt::format("{} [{}]", metric.name, metric.unit)};
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    const CostRow* best = nullptr;
    for (const CostRow& row : study.costs) {
      if (level >= row.seconds.size() || !row.seconds[level]) continue;
      if (!best || row.seconds[level]->cost < best->seconds[level]->cost) best = &row;
    }
    cells.push_back(best ? output::Cell(fmt::format("{} {} us", best->scheme->name,
                                                    microseconds_cell(best->seconds[level]).text))
                         : output::Cell());
  }
  rows_.push_back(std::move(cells));
}

output::Table Fastest::table() const {
  output::Table table;
  table.caption = "The least CPU time to an error, and whose it is";
  table.columns = {{"scene", "scene", output::Align::left}, {"error", "error", output::Align::left}};
  for (const double level : levels_)
    table.columns.push_back(
        {fmt::format("fastest_at_{:.0e}", level), fmt::format("{:.0e}", level), output::Align::left});
  table.rows = rows_;
  table.notes = {
      "closed forms included where they exist; ≤: already the loosest setting reaches the error, °: "
      "fewer than two tighter ones confirm it"};
  return table;
}

}  // namespace gnomon
