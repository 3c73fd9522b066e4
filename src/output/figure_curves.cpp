#include "src/output/figure_curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "src/output/figure_axis.hpp"
#include "src/output/text.hpp"

namespace gnomon::output {
namespace {

constexpr std::size_t most_points_with_markers = 40;
constexpr int markers_on_long_curve = 9;
constexpr std::size_t longest_label = 36;

bool is_drawn(const Series& series, const Panel& panel, std::size_t i) {
  return can_be_drawn(series.x[i], panel.log_x) && can_be_drawn(series.y[i], panel.log_y);
}

bool is_hollow(const Series& series, std::size_t i) { return !series.hollow.empty() && series.hollow[i]; }

bool has_bar(const Series& series, const Panel& panel, std::size_t i) {
  return !series.x_bars.empty() && can_be_drawn(series.x_bars[i].low, panel.log_x) &&
         can_be_drawn(series.x_bars[i].high, panel.log_x) && series.x_bars[i].low < series.x_bars[i].high;
}

void check_lengths(const Series& series) {
  const bool hollow_fits = series.hollow.empty() || series.hollow.size() == series.x.size();
  const bool bars_fit = series.x_bars.empty() || series.x_bars.size() == series.x.size();
  if (series.x.size() == series.y.size() && hollow_fits && bars_fit) return;
  throw std::invalid_argument(fmt::format("series '{}': {} values of x, {} of y, {} of hollow, {} bars",
                                          series.label, series.x.size(), series.y.size(),
                                          series.hollow.size(), series.x_bars.size()));
}

/// Points of a long curve that get a marker: nearest to places equally spaced along the x axis, shifted from
/// style to style so that markers of curves that lie on each other do not.
std::vector<std::size_t> marked_points(const Series& series, const Panel& panel,
                                       const std::vector<std::size_t>& drawn) {
  const auto along = [&](std::size_t i) { return panel.log_x ? std::log10(series.x[i]) : series.x[i]; };
  const auto [low, high] = std::minmax_element(
      drawn.begin(), drawn.end(), [&](std::size_t a, std::size_t b) { return along(a) < along(b); });
  const double start = along(*low);
  const double span = along(*high) - start;
  const double shift = 0.1 + 0.8 * std::fmod(0.381966 * (series.style % 1000 + 1000), 1.0);
  std::vector<std::size_t> marked;
  for (int k = 0; k < markers_on_long_curve; ++k) {
    const double wanted = start + (k + shift) / markers_on_long_curve * span;
    const std::size_t nearest =
        *std::min_element(drawn.begin(), drawn.end(), [&](std::size_t a, std::size_t b) {
          return std::abs(along(a) - wanted) < std::abs(along(b) - wanted);
        });
    if (marked.empty() || marked.back() != nearest) marked.push_back(nearest);
  }
  return marked;
}

std::string shortened(const std::string& label) {
  return display_columns(label) <= longest_label ? label : first_columns(label, longest_label - 1) + "…";
}

Curve curve_of(const Series& series, const Panel& panel) {
  Curve curve;
  curve.label = shortened(plain_text(series.label));
  curve.style = style_of(series.style);
  std::vector<std::size_t> drawn;
  bool broken = true;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!is_drawn(series, panel, i)) {
      broken = true;
      continue;
    }
    if (i > 0 && is_hollow(series, i - 1) && is_hollow(series, i)) broken = true;
    if (broken || series.marks_only) curve.pieces.emplace_back();
    broken = false;
    curve.pieces.back().push_back({series.x[i], series.y[i]});
    drawn.push_back(i);
  }
  if (drawn.size() > most_points_with_markers && !series.marks_only) {
    curve.line_width = 1.3;
    drawn = marked_points(series, panel, drawn);
  }
  for (const std::size_t i : drawn) {
    if (has_bar(series, panel, i))
      curve.bars.push_back({{series.x[i], series.y[i]}, series.x_bars[i].low, series.x_bars[i].high});
    (is_hollow(series, i) ? curve.hollow : curve.filled).push_back({series.x[i], series.y[i]});
  }
  return curve;
}

std::optional<Range> drawn_range(const Panel& panel, bool of_x) {
  std::optional<Range> range;
  for (const Series& series : panel.series) {
    for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
      if (!is_drawn(series, panel, i)) continue;
      const double value = of_x ? series.x[i] : series.y[i];
      range = united(range, Range{value, value});
      if (of_x && i < series.x_bars.size() && has_bar(series, panel, i))
        range = united(range, series.x_bars[i]);
    }
  }
  for (const Failure& failure : panel.failures)
    if (of_x && can_be_drawn(failure.x, panel.log_x)) range = united(range, Range{failure.x, failure.x});
  return range;
}

/// Near enough to the data not to squeeze them: two decades, or the extent of the data.
bool is_near(double y, const std::optional<Range>& data, bool log) {
  if (!can_be_drawn(y, log)) return false;
  if (!data) return true;
  if (log) return y >= data->low / 100.0 && y <= data->high * 100.0;
  const double extent = data->high - data->low;
  return y >= data->low - extent && y <= data->high + extent;
}

}  // namespace

bool has_points(const Series& series, const Panel& panel) {
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (is_drawn(series, panel, i)) return true;
  }
  return false;
}

bool has_line(const Curve& curve) {
  return std::any_of(curve.pieces.begin(), curve.pieces.end(),
                     [](const std::vector<Point>& piece) { return piece.size() > 1; });
}

bool has_markers_everywhere(const Curve& curve) {
  std::size_t points = 0;
  for (const auto& piece : curve.pieces) points += piece.size();
  return curve.filled.size() + curve.hollow.size() == points;
}

std::vector<Curve> curves_of(const Panel& panel, std::vector<std::string>& left_out) {
  std::vector<Curve> curves;
  for (const Series& series : panel.series) {
    check_lengths(series);
    if (has_points(series, panel)) {
      curves.push_back(curve_of(series, panel));
    } else {
      left_out.push_back(fmt::format("{}: no {} values", series.label,
                                     panel.log_x || panel.log_y ? "positive, finite" : "finite"));
    }
  }
  const auto data = drawn_range(panel, false);
  for (const ReferenceLine& line : panel.reference_lines) {
    if (!panel.y_range && !is_near(line.y, data, panel.log_y)) {
      left_out.push_back(fmt::format("{}: {:.3g} is far from the data", line.label, line.y));
    }
  }
  return curves;
}

bool shares_y_axis(const Panel& a, const Panel& b) {
  const auto fixed = [](const Panel& panel) { return panel.y_range.value_or(Range{0.0, 0.0}); };
  return a.y_label == b.y_label && a.log_y == b.log_y && fixed(a).low == fixed(b).low &&
         fixed(a).high == fixed(b).high;
}

std::optional<Range> x_range(const Figure& figure, std::size_t p) {
  return drawn_range(figure.panels[p], true);
}

std::optional<Range> y_range(const Figure& figure, std::size_t p) {
  std::optional<Range> range;
  for (const Panel& panel : figure.panels) {
    if (!shares_y_axis(panel, figure.panels[p])) continue;
    const auto data = drawn_range(panel, false);
    range = united(range, data);
    for (const ReferenceLine& line : panel.reference_lines) {
      if (is_near(line.y, data, panel.log_y)) range = united(range, Range{line.y, line.y});
    }
  }
  return range;
}

}  // namespace gnomon::output
