#pragma once
// What of a panel's data can be drawn: points, markers and ranges.

#include <optional>
#include <string>
#include <vector>

#include "src/output/figure.hpp"
#include "src/output/figure_layout.hpp"

namespace gnomon::output {

/// Whether any point of the series can be drawn in this panel.
bool has_points(const Series& series, const Panel& panel);

/// Whether the curve has two points in one piece.
bool has_line(const Curve& curve);

/// Whether each of its points has a marker, that is, whether it has few.
bool has_markers_everywhere(const Curve& curve);

/// The drawable series of a panel, in order; the others are named in `left_out`, and so are reference lines
/// far from the data. A curve of many points gets markers at a few of them only. Throws std::invalid_argument
/// if lengths of a series differ.
std::vector<Curve> curves_of(const Panel& panel, std::vector<std::string>& left_out);

/// Whether two panels have the same kind of y axis, so that they are drawn with the same range.
bool shares_y_axis(const Panel& a, const Panel& b);

/// The range of the data on the axes of panel `p`; for y of all panels that share its axis, with reference
/// lines.
std::optional<Range> x_range(const Figure& figure, std::size_t p);
std::optional<Range> y_range(const Figure& figure, std::size_t p);

}  // namespace gnomon::output
