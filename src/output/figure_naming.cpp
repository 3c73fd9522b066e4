#include "src/output/figure_naming.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/output/figure_curves.hpp"
#include "src/output/text.hpp"

namespace gnomon::output {
namespace {

constexpr std::size_t most_names_at_ends = 8;
constexpr std::size_t most_names_along = 24;
constexpr std::size_t most_anchors = 16;

std::pair<Point, Point> ends(const DrawnPanel& panel, const Curve& curve) {
  const Point first = to_pixels(panel, curve.pieces.front().front());
  const Point last = to_pixels(panel, curve.pieces.back().back());
  return {first, last};
}

}  // namespace

bool name_beside_frame(DrawnPanel& panel, Occupied& occupied) {
  std::vector<Point> right_ends;
  std::vector<double> wanted;
  for (const Curve& curve : panel.curves) {
    const auto [first, last] = ends(panel, curve);
    const Point end = last.x >= first.x ? last : first;
    if (end.y < panel.frame.bottom || end.y > panel.frame.top) return false;
    right_ends.push_back(end);
    wanted.push_back(end.y);
  }
  const auto heights = spread(wanted, 17.0, panel.frame.bottom + 4.0, panel.frame.top - 4.0, 50.0);
  if (!heights) return false;
  std::vector<Stroke> leaders;
  std::vector<Text> names;
  Occupied trial = occupied;
  for (std::size_t c = 0; c < panel.curves.size(); ++c) {
    const Curve& curve = panel.curves[c];
    const Point at = {panel.frame.right + 12.0, (*heights)[c]};
    const double gap = has_markers_everywhere(curve) ? 8.0 : 0.0;
    const Point from = {right_ends[c].x + gap, right_ends[c].y};
    const bool near = panel.frame.right - right_ends[c].x <= 0.08 * (panel.frame.right - panel.frame.left);
    if (!near) {
      // Where the leader leaves the frame.
      const double part = (panel.frame.right - 1.0 - from.x) / (at.x - from.x);
      const Point out = {panel.frame.right - 1.0, from.y + part * (at.y - from.y)};
      if (!trial.is_free_along({from.x + 6.0, from.y}, out)) return false;
      trial.add_line({from.x + 6.0, from.y}, out);
    }
    leaders.push_back({from, {at.x - 3.0, at.y}, curve.style.colour, 0.7, "solid"});
    names.push_back({at, Anchor::left, curve.label, text_size, curve.style.text_colour});
  }
  occupied = trial;
  panel.decoration.strokes.insert(panel.decoration.strokes.end(), leaders.begin(), leaders.end());
  panel.decoration.texts.insert(panel.decoration.texts.end(), names.begin(), names.end());
  return true;
}

bool name_at_ends(DrawnPanel& panel, Occupied& occupied) {
  if (panel.curves.size() > most_names_at_ends) return false;
  std::vector<LineEnds> lines;
  for (const Curve& curve : panel.curves) {
    const auto [first, last] = ends(panel, curve);
    lines.push_back({first, last, text_width(curve.label, text_size)});
  }
  const auto places = labels_at_ends(occupied, lines, text_size + 2.0);
  if (!places) return false;
  for (std::size_t c = 0; c < panel.curves.size(); ++c) {
    const Curve& curve = panel.curves[c];
    panel.decoration.texts.push_back(
        {(*places)[c], Anchor::left, curve.label, text_size, curve.style.text_colour});
  }
  return true;
}

bool name_along(DrawnPanel& panel, Occupied& occupied) {
  if (panel.curves.size() > most_names_along) return false;
  std::vector<LabelledLine> lines;
  for (const Curve& curve : panel.curves) {
    std::vector<Point> points;
    for (const auto& piece : curve.pieces)
      for (const Point& point : piece) {
        const Point at = to_pixels(panel, point);
        if (at.x >= panel.frame.left && at.x <= panel.frame.right && at.y >= panel.frame.bottom &&
            at.y <= panel.frame.top)
          points.push_back(at);
      }
    LabelledLine line;
    line.text_width = text_width(curve.label, text_size);
    const std::size_t count = std::min(most_anchors, points.size());
    for (std::size_t k = 0; k < count; ++k)
      line.anchors.push_back(points[count == 1 ? 0 : k * (points.size() - 1) / (count - 1)]);
    if (line.anchors.empty()) return false;
    lines.push_back(std::move(line));
  }
  const auto places = labels_along(occupied, lines, text_size + 2.0);
  if (!places) return false;
  for (std::size_t c = 0; c < panel.curves.size(); ++c) {
    const Curve& curve = panel.curves[c];
    const LabelPlace& place = (*places)[c];
    panel.decoration.texts.push_back(
        {place.text, Anchor::left, curve.label, text_size, curve.style.text_colour});
    if (place.leader)
      panel.decoration.strokes.push_back({place.from, place.to, curve.style.colour, 0.8, "solid"});
  }
  return true;
}

}  // namespace gnomon::output
