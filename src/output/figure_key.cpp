#include "src/output/figure_key.hpp"

#include <algorithm>

#include "src/output/figure_curves.hpp"
#include "src/output/text.hpp"

namespace gnomon::output {
namespace {

constexpr double key_sample = 40.0;

}  // namespace

double key_entry_width(double text) { return key_sample + 7.0 + text; }

std::vector<KeyEntry> key_entries(const Figure& figure, const std::vector<std::vector<Curve>>& curves) {
  std::vector<KeyEntry> entries;
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    std::size_t drawn = 0;
    for (const Series& series : figure.panels[p].series) {
      if (!has_points(series, figure.panels[p])) continue;
      const Curve& curve = curves[p][drawn++];
      const auto known = std::find_if(entries.begin(), entries.end(), [&](const KeyEntry& entry) {
        return entry.label == curve.label && entry.style == series.style;
      });
      KeyEntry& entry = known != entries.end() ? *known : entries.emplace_back();
      entry.label = curve.label;
      entry.style = series.style;
      entry.line = entry.line || has_line(curve);
    }
  }
  return entries;
}

double widest(const std::vector<KeyEntry>& entries) {
  double width = 0.0;
  for (const KeyEntry& entry : entries) width = std::max(width, text_width(entry.label, text_size));
  return width;
}

void add_key_entry(Decoration& decoration, const KeyEntry& entry, Point at) {
  const SeriesStyle style = style_of(entry.style);
  if (entry.line) {
    decoration.strokes.push_back({at, {at.x + key_sample, at.y}, style.colour, 1.8, style.dash});
  }
  decoration.marks.push_back({{at.x + 0.5 * key_sample, at.y}, style.filled_marker, style.colour});
  decoration.texts.push_back({{at.x + key_sample + 7.0, at.y}, Anchor::left, entry.label, text_size});
}

KeyGrid key_grid(const std::vector<KeyEntry>& entries, double width) {
  KeyGrid grid;
  for (std::size_t rows = 1; rows <= entries.size(); ++rows) {
    grid = {rows, {}, 0.0};
    for (std::size_t first = 0; first < entries.size(); first += rows) {
      const auto begin = entries.begin() + static_cast<std::ptrdiff_t>(first);
      const auto end = begin + static_cast<std::ptrdiff_t>(std::min(rows, entries.size() - first));
      grid.left.push_back(grid.width + (first == 0 ? 0.0 : 26.0));
      grid.width = grid.left.back() + key_entry_width(widest({begin, end}));
    }
    if (grid.width <= width) break;
  }
  return grid;
}

}  // namespace gnomon::output
