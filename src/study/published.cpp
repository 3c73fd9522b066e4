#include "src/study/published.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/study/present.hpp"

namespace gnomon {

output::Table order_matrix(const std::vector<Convergence>& studies) {
  output::Table table;
  if (!studies.empty())
    table.caption =
        fmt::format("Observed order of the {} error", studies.front().scene.model->metrics()[0].name);
  table.columns = {{"scene", "scene", output::Align::left}, {"load", "load", output::Align::left}};
  std::vector<const SchemeInfo*> schemes;
  for (const Convergence& study : studies)
    for (const OrderRow& row : study.orders)
      if (std::find(schemes.begin(), schemes.end(), row.scheme) == schemes.end())
        schemes.push_back(row.scheme);
  for (const SchemeInfo* scheme : schemes)
    table.columns.push_back({std::string(scheme->name), std::string(scheme->name)});
  for (const Convergence& study : studies) {
    std::vector<output::Cell> cells{study.scene.name, std::string(study.scene.model->load_class())};
    for (const SchemeInfo* scheme : schemes) {
      const auto row = std::find_if(study.orders.begin(), study.orders.end(),
                                    [&](const OrderRow& each) { return each.scheme == scheme; });
      cells.push_back(row == study.orders.end() ? output::Cell() : order_cell(row->order, row->expected));
    }
    table.rows.push_back(std::move(cells));
  }
  table.notes.push_back(std::string("windowed robust slope; ") + order_marks);
  return table;
}

std::string replace_section(const std::string& document, const std::string& name, const std::string& text) {
  const std::string begin = fmt::format("<!-- begin {} -->", name),
                    end = fmt::format("<!-- end {} -->", name);
  const std::size_t from = document.find(begin), to = document.find(end);
  if (from == std::string::npos || to == std::string::npos || to < from) return document;
  return document.substr(0, from + begin.size()) + "\n" + text + document.substr(to);
}

void add_published(const DriftPlan& plan, output::Table& drifts) {
  if (plan.published.empty()) return;
  for (const PublishedDrift& each : plan.published) {
    std::vector<output::Cell> cells(drifts.columns.size());
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const std::string& key = drifts.columns[k].key;
      if (key == "integrator") cells[k] = each.name + " (published)";
      if (key == "invariant") cells[k] = each.invariant;
      if (key == "max_drift") cells[k] = output::number_cell(each.max_drift);
    }
    drifts.rows.push_back(std::move(cells));
  }
  drifts.notes.push_back("published: " + plan.source);
}

}  // namespace gnomon
