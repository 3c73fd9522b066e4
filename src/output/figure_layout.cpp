#include "src/output/figure_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "src/output/figure_curves.hpp"
#include "src/output/text.hpp"

namespace gnomon::output {
namespace {

constexpr double text_size = 15.0;
constexpr double title_size = 17.0;
constexpr double line_height = 22.0;
constexpr double key_sample = 40.0;
constexpr const char* grey = "#555555";

enum class Naming { beside_frame, at_ends, key_right, key_below };

struct KeyEntry {
  std::string label;
  int style = 0;
  bool line = false;
};

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

/// One entry of the key with its left end at `at`.
void add_key_entry(Decoration& decoration, const KeyEntry& entry, Point at) {
  const SeriesStyle style = style_of(entry.style);
  if (entry.line) {
    decoration.strokes.push_back({at, {at.x + key_sample, at.y}, style.colour, 1.8, style.dash});
  }
  decoration.marks.push_back({{at.x + 0.5 * key_sample, at.y}, style.filled_marker, style.colour});
  decoration.texts.push_back({{at.x + key_sample + 7.0, at.y}, Anchor::left, entry.label, text_size});
}

/// A key of several columns, filled column by column.
struct KeyGrid {
  std::size_t rows = 0;
  std::vector<double> left;  // of each column
  double width = 0.0;
};

/// The key with the fewest rows that is not wider than `width`, else of one column.
KeyGrid key_grid(const std::vector<KeyEntry>& entries, double width) {
  KeyGrid grid;
  for (std::size_t rows = 1; rows <= entries.size(); ++rows) {
    grid = {rows, {}, 0.0};
    for (std::size_t first = 0; first < entries.size(); first += rows) {
      const auto begin = entries.begin() + static_cast<std::ptrdiff_t>(first);
      const auto end = begin + static_cast<std::ptrdiff_t>(std::min(rows, entries.size() - first));
      grid.left.push_back(grid.width + (first == 0 ? 0.0 : 26.0));
      grid.width = grid.left.back() + key_sample + 7.0 + widest({begin, end});
    }
    if (grid.width <= width) break;
  }
  return grid;
}

/// The part of the figure that is common to all panels, and what is needed to place them.
struct Frame {
  std::vector<KeyEntry> entries;
  double left = 0.0;     // for tick labels and the label of the y axis
  double bottom = 60.0;  // for tick labels and the label of the x axis
  double note = 0.0;
  bool hollow = false;
};

void place_panels_alone(Drawing& drawing, const Frame& frame, Naming naming, double top) {
  double right = 24.0;
  if (naming == Naming::beside_frame) right = widest(frame.entries) + 26.0;
  if (naming == Naming::key_right) right = key_sample + widest(frame.entries) + 32.0;
  drawing.panels.front().frame = {frame.left, frame.note + frame.bottom, drawing.width - right, top};
  if (naming != Naming::key_right) return;
  double y = top - 8.0;
  for (const KeyEntry& entry : frame.entries) {
    add_key_entry(drawing.decoration, entry, {drawing.width - right + 16.0, y});
    y -= std::min(line_height + 1.0, (top - frame.bottom) / static_cast<double>(frame.entries.size()));
  }
}

/// Two panels in a row above the key. Sets the height of the drawing.
void place_panels_in_rows(Drawing& drawing, const Figure& figure, const Frame& frame, double title_height) {
  const std::size_t count = figure.panels.size();
  const std::size_t rows = (count + 1) / 2;
  const KeyGrid grid = key_grid(frame.entries, drawing.width - 40.0);
  const double key_height = static_cast<double>(grid.rows) * line_height + 16.0;

  const bool titled = std::any_of(figure.panels.begin(), figure.panels.end(),
                                  [](const Panel& panel) { return !panel.title.empty(); });
  const double row_height = 370.0 + (titled ? 24.0 : 8.0) + frame.bottom;
  drawing.height = title_height + static_cast<double>(rows) * row_height + key_height + frame.note;
  bool narrow_gap = true;
  for (std::size_t p = 1; p < count; p += 2) narrow_gap = narrow_gap && !drawing.panels[p].y_labels;
  const double gap = narrow_gap ? 26.0 : frame.left + 10.0;
  const double width = (drawing.width - frame.left - gap - 24.0) / 2.0;
  for (std::size_t p = 0; p < count; ++p) {
    const double left = frame.left + static_cast<double>(p % 2) * (width + gap);
    const double top =
        drawing.height - title_height - static_cast<double>(p / 2) * row_height - (titled ? 24.0 : 8.0);
    drawing.panels[p].frame = {left, top - 370.0, left + width, top};
  }
  for (std::size_t e = 0; e < frame.entries.size(); ++e) {
    const double x = 0.5 * (drawing.width - grid.width) + grid.left[e / grid.rows];
    const double y = frame.note + key_height - 16.0 - static_cast<double>(e % grid.rows) * line_height;
    add_key_entry(drawing.decoration, frame.entries[e], {x, y});
  }
}

Point to_pixels(const DrawnPanel& panel, Point data) {
  return {panel.frame.left + panel.x.position(data.x) * (panel.frame.right - panel.frame.left),
          panel.frame.bottom + panel.y.position(data.y) * (panel.frame.top - panel.frame.bottom)};
}

Occupied occupied_by_curves(const DrawnPanel& panel, const Box& area) {
  Occupied occupied(area);
  for (const Curve& curve : panel.curves) {
    for (const auto& piece : curve.pieces) {
      for (std::size_t i = 1; i < piece.size(); ++i) {
        occupied.add_line(to_pixels(panel, piece[i - 1]), to_pixels(panel, piece[i]));
      }
    }
    for (const auto* points : {&curve.filled, &curve.hollow}) {
      for (const Point& point : *points) {
        const Point at = to_pixels(panel, point);
        occupied.add_box({at.x - 6.0, at.y - 6.0, at.x + 6.0, at.y + 6.0});
      }
    }
  }
  return occupied;
}

/// A reference line within the panel.
struct PlacedLine {
  double y;
  std::string label;
};

std::vector<PlacedLine> add_reference_lines(DrawnPanel& panel, const Panel& data, Occupied& occupied) {
  std::vector<PlacedLine> placed;
  for (const ReferenceLine& line : data.reference_lines) {
    if (!can_be_drawn(line.y, data.log_y)) continue;
    const double position = panel.y.position(line.y);
    if (position < 0.0 || position > 1.0) continue;
    const double y = panel.frame.bottom + position * (panel.frame.top - panel.frame.bottom);
    panel.decoration.strokes.push_back({{panel.frame.left, y}, {panel.frame.right, y}, grey, 1.4, "(3,3)"});
    occupied.add_line({panel.frame.left, y}, {panel.frame.right, y});
    placed.push_back({y, plain_text(line.label)});
  }
  return placed;
}

void add_levels(DrawnPanel& panel, const Panel& data) {
  for (const Level& level : data.levels) {
    if (!can_be_drawn(level.y, data.log_y) || !can_be_drawn(level.x.low, data.log_x) ||
        !can_be_drawn(level.x.high, data.log_x))
      continue;
    const double y = panel.y.position(level.y);
    const double low = std::clamp(panel.x.position(level.x.low), 0.0, 1.0);
    const double high = std::clamp(panel.x.position(level.x.high), 0.0, 1.0);
    if (y < 0.0 || y > 1.0 || low >= high) continue;
    panel.decoration.strokes.push_back({to_pixels(panel, {level.x.low, level.y}),
                                        to_pixels(panel, {level.x.high, level.y}),
                                        style_of(level.style).colour, 1.2, "(1,3)"});
  }
}

void name_reference_lines(DrawnPanel& panel, const std::vector<PlacedLine>& lines, Occupied& occupied) {
  for (const PlacedLine& line : lines) {
    const double width = text_width(line.label, text_size);
    const Point at = label_on_horizontal(occupied, panel.frame, line.y, width, text_size + 2.0);
    panel.decoration.texts.push_back({at, Anchor::left, line.label, text_size, grey});
  }
}

/// Returns whether there was a place for the guides, if any.
bool add_guides(DrawnPanel& panel, const Panel& data, Occupied& occupied) {
  if (data.guides.empty()) return true;
  if (!data.log_x || !data.log_y) return false;
  const double x_decade = panel.x.decade() * (panel.frame.right - panel.frame.left);
  const double y_decade = panel.y.decade() * (panel.frame.top - panel.frame.bottom);
  std::vector<double> slopes;
  std::vector<double> widths;
  for (const Guide& guide : data.guides) {
    slopes.push_back(guide.slope * y_decade / x_decade);
    widths.push_back(text_width(plain_text(guide.label), text_size));
  }
  const auto place = place_guides(occupied, panel.frame, slopes, widths, text_size + 2.0);
  if (!place) return false;
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    panel.decoration.strokes.push_back({place->from[i], place->to[i], "#888888", 1.4, "solid"});
    panel.decoration.texts.push_back(
        {place->labels[i], Anchor::left, plain_text(data.guides[i].label), text_size, grey});
  }
  return true;
}

/// Crosses at the top of the frame; those of one place stand below each other, as far as there is room.
void add_failures(DrawnPanel& panel, const Panel& data, Occupied& occupied) {
  constexpr double distance = 12.0;
  std::vector<Point> taken;
  for (const Failure& failure : data.failures) {
    if (!can_be_drawn(failure.x, data.log_x)) continue;
    const double position = panel.x.position(failure.x);
    if (position < 0.0 || position > 1.0) continue;
    Point at{panel.frame.left + position * (panel.frame.right - panel.frame.left), panel.frame.top - 10.0};
    for (const Point& other : taken)
      if (std::abs(other.x - at.x) < distance) at.y = std::min(at.y, other.y - distance);
    if (at.y < 0.5 * (panel.frame.bottom + panel.frame.top)) continue;
    taken.push_back(at);
    panel.decoration.marks.push_back({at, 2, style_of(failure.style).colour});
    occupied.add_box({at.x - 6.0, at.y - 6.0, at.x + 6.0, at.y + 6.0});
  }
}

std::pair<Point, Point> ends(const DrawnPanel& panel, const Curve& curve) {
  const Point first = to_pixels(panel, curve.pieces.front().front());
  const Point last = to_pixels(panel, curve.pieces.back().back());
  return {first, last};
}

/// Names right of the frame, each at the height of its curve's right end. False if they do not fit.
bool name_beside_frame(DrawnPanel& panel) {
  std::vector<Point> right_ends;
  std::vector<double> wanted;
  for (const Curve& curve : panel.curves) {
    const auto [first, last] = ends(panel, curve);
    const Point end = last.x >= first.x ? last : first;
    if (panel.frame.right - end.x > 0.08 * (panel.frame.right - panel.frame.left)) return false;
    if (end.y < panel.frame.bottom || end.y > panel.frame.top) return false;
    right_ends.push_back(end);
    wanted.push_back(end.y);
  }
  const auto heights = spread(wanted, 17.0, panel.frame.bottom + 4.0, panel.frame.top - 4.0, 50.0);
  if (!heights) return false;
  for (std::size_t c = 0; c < panel.curves.size(); ++c) {
    const Curve& curve = panel.curves[c];
    const Point at = {panel.frame.right + 12.0, (*heights)[c]};
    const double gap = has_markers_everywhere(curve) ? 8.0 : 0.0;
    const Point from = {right_ends[c].x + gap, right_ends[c].y};
    panel.decoration.strokes.push_back({from, {at.x - 3.0, at.y}, curve.style.colour, 0.7, "solid"});
    panel.decoration.texts.push_back({at, Anchor::left, curve.label, text_size, curve.style.text_colour});
  }
  return true;
}

/// Names within the frame at an end of each curve. False if they do not fit.
bool name_at_ends(DrawnPanel& panel, Occupied& occupied) {
  if (panel.curves.size() > 8) return false;
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

void add_axis_labels(DrawnPanel& panel, const Panel& data, const Frame& frame) {
  const Box& box = panel.frame;
  auto& texts = panel.decoration.texts;
  const double middle = 0.5 * (box.left + box.right);
  texts.push_back({{middle, box.bottom - 46.0}, Anchor::centre, plain_text(data.x_label), text_size});
  texts.push_back({{middle, box.top + 15.0}, Anchor::centre, plain_text(data.title), text_size});
  if (panel.y_labels) {
    const Point at = {box.left - frame.left + 16.0, 0.5 * (box.bottom + box.top)};
    texts.push_back({at, Anchor::centre, plain_text(data.y_label), text_size, "#000000", true});
  }
  if (panel.curves.empty()) {
    texts.push_back({{middle, 0.5 * (box.bottom + box.top)}, Anchor::centre, "no data", text_size, grey});
  }
}

/// The range of x, longer at the right so that names of the width `text` can stand there within the frame.
std::optional<Range> with_room(std::optional<Range> range, bool log, double text) {
  if (!range) return range;
  const double part = std::min(0.3, text / 700.0);
  const double low = range->low;
  const double high = range->high;
  // Factors that are not too large each, for ranges near those of double.
  range->high =
      log ? std::min(1e300, high * std::pow(high, part) / std::pow(low, part)) : high + part * (high - low);
  return range;
}

/// The drawing with the curves named in one way; none if there is no place for all the names.
std::optional<Drawing> drawing_with(const Figure& figure, const std::vector<std::vector<Curve>>& curves,
                                    Naming naming) {
  Drawing drawing;
  Frame frame;
  frame.entries = key_entries(figure, curves);
  for (const auto& panel : curves) {
    for (const Curve& curve : panel) frame.hollow = frame.hollow || !curve.hollow.empty();
  }
  const bool noted = frame.hollow && !figure.hollow_note.empty();
  const bool failed =
      !figure.failure_note.empty() &&
      std::ranges::any_of(figure.panels, [](const Panel& panel) { return !panel.failures.empty(); });
  const bool levelled =
      !figure.floor_note.empty() && std::any_of(figure.panels.begin(), figure.panels.end(),
                                                [](const Panel& panel) { return !panel.levels.empty(); });
  frame.note = noted || failed || levelled ? 26.0 : 0.0;
  const double title_height = figure.title.empty() ? 0.0 : 30.0;
  const bool several = figure.panels.size() > 1;
  if (several) drawing.width = 1000.0;

  drawing.panels.resize(figure.panels.size());
  int characters = 1;
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    DrawnPanel& panel = drawing.panels[p];
    panel.curves = curves[p];
    const bool shares = p % 2 == 1 && shares_y_axis(figure.panels[p - 1], figure.panels[p]);
    panel.y_labels = !shares;
    const bool log_x = figure.panels[p].log_x;
    const double room = naming == Naming::at_ends ? widest(frame.entries) : 0.0;
    panel.x = make_axis(log_x, with_room(x_range(figure, p), log_x, room), figure.panels[p].x_range,
                        (several ? 6 : 8) + (log_x ? 2 : 0));
    panel.y =
        make_axis(figure.panels[p].log_y, y_range(figure, p), figure.panels[p].y_range, several ? 9 : 12);
    characters = std::max(characters, widest_label(panel.y));
  }
  frame.left = 46.0 + 0.6 * text_size * characters;
  if (several) {
    place_panels_in_rows(drawing, figure, frame, title_height);
  } else {
    const double above = title_height + (figure.panels.front().title.empty() ? 16.0 : 28.0);
    place_panels_alone(drawing, frame, naming, drawing.height - above);
  }

  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    DrawnPanel& panel = drawing.panels[p];
    Occupied occupied = occupied_by_curves(panel, panel.frame);
    add_failures(panel, figure.panels[p], occupied);
    add_levels(panel, figure.panels[p]);
    if (naming == Naming::beside_frame && !name_beside_frame(panel)) return std::nullopt;
    const auto lines = add_reference_lines(panel, figure.panels[p], occupied);
    if (naming == Naming::at_ends && !name_at_ends(panel, occupied)) return std::nullopt;
    name_reference_lines(panel, lines, occupied);
    if (!add_guides(panel, figure.panels[p], occupied)) {
      drawing.left_out.push_back("guide lines: no free place");
    }
    add_axis_labels(panel, figure.panels[p], frame);
  }
  const double middle = 0.5 * (drawing.panels.front().frame.left + drawing.panels.back().frame.right);
  if (!figure.title.empty()) {
    drawing.decoration.texts.push_back(
        {{middle, drawing.height - 20.0}, Anchor::centre, plain_text(figure.title), title_size});
  }
  double left = drawing.panels.front().frame.left;
  const auto note = [&](int mark, const std::string& text) {
    drawing.decoration.marks.push_back({{left + 6.0, 15.0}, mark, grey});
    drawing.decoration.texts.push_back(
        {{left + 18.0, 15.0}, Anchor::left, plain_text(text), text_size, grey});
    left += 18.0 + text_width(plain_text(text), text_size) + 30.0;
  };
  if (noted) note(6, figure.hollow_note);
  if (failed) note(2, figure.failure_note);
  if (levelled)
    drawing.decoration.texts.push_back(
        {{left, 15.0}, Anchor::left, plain_text(figure.floor_note), text_size, grey});
  return drawing;
}

}  // namespace

Drawing lay_out(const Figure& figure) {
  std::vector<std::string> left_out;
  std::vector<std::vector<Curve>> curves;
  for (const Panel& panel : figure.panels) curves.push_back(curves_of(panel, left_out));

  std::optional<Drawing> drawing;
  if (figure.panels.size() == 1) {
    const bool map = std::ranges::any_of(figure.panels.front().series, &Series::marks_only);
    for (const Naming naming : {Naming::beside_frame, Naming::at_ends, Naming::key_right}) {
      if (map && naming != Naming::key_right) continue;
      if (!drawing) drawing = drawing_with(figure, curves, naming);
    }
  } else if (!figure.panels.empty()) {
    drawing = drawing_with(figure, curves, Naming::key_below);
  }
  if (!drawing) drawing.emplace();
  drawing->left_out.insert(drawing->left_out.begin(), left_out.begin(), left_out.end());
  return *drawing;
}

}  // namespace gnomon::output
