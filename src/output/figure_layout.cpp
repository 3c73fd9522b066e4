#include "src/output/figure_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "src/output/figure_curves.hpp"
#include "src/output/figure_key.hpp"
#include "src/output/figure_naming.hpp"
#include "src/output/figure_notes.hpp"
#include "src/output/text.hpp"

namespace gnomon::output {
namespace {

constexpr double title_size = 17.0;
constexpr double failure_distance = 12.0;  // of crosses that stand below each other
constexpr const char* grey = "#555555";

/// How the curves of a figure are named.
struct Naming {
  enum class Kind { beside_frame, at_ends, along, key_right, key_below };
  Kind kind;
  std::size_t panel = 0;  ///< where the names stand, unless they are a key
  bool room = false;      ///< the axis is longer than the data, so that names have a place
};

/// The part of the figure that is common to all panels, and what is needed to place them.
struct Frame {
  std::vector<KeyEntry> entries;
  double left = 0.0;     // for tick labels and the label of the y axis
  double bottom = 60.0;  // for tick labels and the label of the x axis
  double note = 0.0;     // for the notes below all
};

/// False if a key does not fit at the right.
bool place_panels_alone(Drawing& drawing, const Frame& frame, Naming::Kind naming, double top) {
  constexpr double narrowest = 330.0, closest = 19.0;
  const double bottom = frame.note + frame.bottom;
  const auto entries = static_cast<double>(frame.entries.size());
  double right = 24.0;
  if (naming == Naming::Kind::beside_frame) right = widest(frame.entries) + 26.0;
  if (naming == Naming::Kind::key_right) right = key_entry_width(widest(frame.entries)) + 25.0;
  drawing.panels.front().frame = {frame.left, bottom, drawing.width - right, top};
  if (drawing.width - right - frame.left < narrowest) return false;
  if (naming != Naming::Kind::key_right) return true;
  if (entries * closest > top - bottom) return false;
  double y = top - 8.0;
  for (const KeyEntry& entry : frame.entries) {
    add_key_entry(drawing.decoration, entry, {drawing.width - right + 16.0, y});
    y -= std::min(line_height + 1.0, (top - bottom) / entries);
  }
  return true;
}

/// One panel, or two in a row, above the key if there is one. Sets the height of the drawing.
void place_panels_in_rows(Drawing& drawing, const Figure& figure, const Frame& frame, bool key,
                          double title_height) {
  const std::size_t count = figure.panels.size();
  const std::size_t columns = count > 1 ? 2 : 1;
  const std::size_t rows = (count + columns - 1) / columns;
  const KeyGrid grid = key ? key_grid(frame.entries, drawing.width - 40.0) : KeyGrid{};
  const double key_height = key ? static_cast<double>(grid.rows) * line_height + 16.0 : 8.0;
  const double height = columns == 1 ? 440.0 : key ? 370.0 : 430.0;

  const bool titled = std::any_of(figure.panels.begin(), figure.panels.end(),
                                  [](const Panel& panel) { return !panel.title.empty(); });
  const double row_height = height + (titled ? 24.0 : 8.0) + frame.bottom;
  drawing.height = title_height + static_cast<double>(rows) * row_height + key_height + frame.note;
  bool narrow_gap = true;
  for (std::size_t p = 1; p < count; p += 2) narrow_gap = narrow_gap && !drawing.panels[p].y_labels;
  const double gap = narrow_gap ? 26.0 : frame.left + 10.0;
  const double width =
      columns == 1 ? drawing.width - frame.left - 24.0 : (drawing.width - frame.left - gap - 24.0) / 2.0;
  for (std::size_t p = 0; p < count; ++p) {
    const double left = frame.left + static_cast<double>(p % columns) * (width + gap);
    const double top =
        drawing.height - title_height - static_cast<double>(p / columns) * row_height - (titled ? 24.0 : 8.0);
    drawing.panels[p].frame = {left, top - height, left + width, top};
  }
  for (std::size_t e = 0; key && e < frame.entries.size(); ++e) {
    const double x = 0.5 * (drawing.width - grid.width) + grid.left[e / grid.rows];
    const double y = frame.note + key_height - 16.0 - static_cast<double>(e % grid.rows) * line_height;
    add_key_entry(drawing.decoration, frame.entries[e], {x, y});
  }
}

}  // namespace

Point to_pixels(const DrawnPanel& panel, Point data) {
  return {panel.frame.left + panel.x.position(data.x) * (panel.frame.right - panel.frame.left),
          panel.frame.bottom + panel.y.position(data.y) * (panel.frame.top - panel.frame.bottom)};
}

namespace {

Occupied occupied_by_curves(const DrawnPanel& panel, const Box& area) {
  Occupied occupied(area);
  for (const Curve& curve : panel.curves) {
    for (const auto& piece : curve.pieces) {
      for (std::size_t i = 1; i < piece.size(); ++i) {
        occupied.add_line(to_pixels(panel, piece[i - 1]), to_pixels(panel, piece[i]));
      }
    }
    for (const Bar& bar : curve.bars)
      occupied.add_line(to_pixels(panel, {bar.low, bar.at.y}), to_pixels(panel, {bar.high, bar.at.y}));
    for (const auto* points : {&curve.filled, &curve.hollow}) {
      for (const Point& point : *points) {
        const Point at = to_pixels(panel, point);
        occupied.add_box({at.x - 6.0, at.y - 6.0, at.x + 6.0, at.y + 6.0});
      }
    }
  }
  for (std::size_t k = 1; k < panel.front.size(); ++k)
    occupied.add_line(to_pixels(panel, panel.front[k - 1]), to_pixels(panel, panel.front[k]));
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

/// Whose cross has a place, and where: at the top, those of one place below each other as far as there is
/// room.
std::vector<std::pair<const Failure*, Point>> failure_places(const Panel& data, const Axis& x,
                                                             const Box& frame) {
  std::vector<std::pair<const Failure*, Point>> places;
  for (const Failure& failure : data.failures) {
    const bool unknown = std::isnan(failure.x);
    if (!unknown && !can_be_drawn(failure.x, data.log_x)) continue;
    const double position = unknown ? 0.0 : x.position(failure.x);
    if (position < 0.0 || position > 1.0) continue;
    Point at{frame.left + position * (frame.right - frame.left), frame.top - 10.0};
    if (unknown) at.x = frame.left + 8.0;
    for (const auto& [whose, other] : places)
      if (std::abs(other.x - at.x) < failure_distance) at.y = std::min(at.y, other.y - failure_distance);
    if (at.y < 0.4 * frame.bottom + 0.6 * frame.top) continue;
    places.emplace_back(&failure, at);
  }
  return places;
}

/// The part of the height that crosses need, with some air below them.
double failure_room(const Panel& data, const Axis& x, bool several) {
  const Box nominal = several ? Box{0.0, 0.0, 430.0, 370.0} : Box{0.0, 0.0, 600.0, 440.0};
  double room = 0.0;
  for (const auto& [whose, at] : failure_places(data, x, nominal))
    room = std::max(room, (nominal.top - at.y + 8.0) / nominal.top);
  return room;
}

void add_failures(DrawnPanel& panel, const Panel& data, Occupied& occupied) {
  for (const auto& [failure, at] : failure_places(data, panel.x, panel.frame)) {
    panel.decoration.marks.push_back({at, 2, style_of(failure->style).colour});
    occupied.add_box({at.x - 6.0, at.y - 6.0, at.x + 6.0, at.y + 6.0});
  }
}

/// The front as steps from the top of the frame to its right side.
void add_front(DrawnPanel& panel, const Panel& data) {
  std::vector<Point> corners;
  for (const FrontPoint& point : data.front)
    if (can_be_drawn(point.x, data.log_x) && can_be_drawn(point.y, data.log_y))
      corners.push_back({point.x, point.y});
  if (corners.empty()) return;
  std::sort(corners.begin(), corners.end(),
            [](const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  double y = panel.y.range.high;
  for (const Point& corner : corners) {
    if (corner.y >= y) continue;
    panel.front.push_back({corner.x, y});
    y = corner.y;
    panel.front.push_back({corner.x, y});
  }
  panel.front.push_back({panel.x.range.high, y});
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

/// The range longer at its high end by a part of it.
std::optional<Range> with_room(std::optional<Range> range, bool log, double part) {
  if (!range) return range;
  const double low = range->low;
  const double high = range->high;
  // Factors that are not too large each, for ranges near those of double.
  range->high =
      log ? std::min(1e300, high * std::pow(high, part) / std::pow(low, part)) : high + part * (high - low);
  return range;
}

/// The axes, with room for names and above all data for crosses.
void make_axes(Drawing& drawing, const Figure& figure, Naming naming, double widest_name) {
  const bool several = figure.panels.size() > 1;
  double failures = 0.0;
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    const Panel& data = figure.panels[p];
    const bool names = naming.room && (!several || naming.panel == p);
    const double room = names ? std::min(0.3, widest_name / (several ? 500.0 : 700.0)) : 0.0;
    drawing.panels[p].x = make_axis(data.log_x, with_room(x_range(figure, p), data.log_x, room), data.x_range,
                                    (several ? 6 : 8) + (data.log_x ? 2 : 0));
    failures = std::max(failures, failure_room(data, drawing.panels[p].x, several));
  }
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    const Panel& data = figure.panels[p];
    DrawnPanel& panel = drawing.panels[p];
    panel.y = make_axis(data.log_y, with_room(y_range(figure, p), data.log_y, failures / (1.0 - failures)),
                        data.y_range, several ? 9 : 12);
    panel.y_labels = p % 2 == 0 || !shares_y_axis(figure.panels[p - 1], data);
  }
}

/// Names the curves within the frame of a panel, if that is the way. False if there is no place for them.
bool name_curves(DrawnPanel& panel, Naming::Kind naming, Occupied& occupied) {
  switch (naming) {
    case Naming::Kind::at_ends:
      return name_at_ends(panel, occupied);
    case Naming::Kind::along:
      return name_along(panel, occupied);
    default:
      return true;
  }
}

/// The drawing with the curves named in one way; none if there is no place for all the names.
std::optional<Drawing> drawing_with(const Figure& figure, const std::vector<std::vector<Curve>>& curves,
                                    Naming naming) {
  using Kind = Naming::Kind;
  Drawing drawing;
  Frame frame;
  frame.entries = key_entries(figure, curves);
  const double title_height = figure.title.empty() ? 0.0 : 30.0;
  const bool several = figure.panels.size() > 1;
  if (several) drawing.width = 1000.0;

  drawing.panels.resize(figure.panels.size());
  for (std::size_t p = 0; p < figure.panels.size(); ++p) drawing.panels[p].curves = curves[p];
  make_axes(drawing, figure, naming, widest(frame.entries));
  int characters = 1;
  for (const DrawnPanel& panel : drawing.panels) characters = std::max(characters, widest_label(panel.y));
  frame.left = 46.0 + 0.6 * text_size * characters;
  const std::vector<PlacedNote> notes = notes_of(figure, curves, drawing.width - frame.left - 16.0);
  frame.note = height_of(notes);
  if (several || naming.kind == Kind::key_below) {
    place_panels_in_rows(drawing, figure, frame, naming.kind == Kind::key_below, title_height);
  } else {
    const double above = title_height + (figure.panels.front().title.empty() ? 16.0 : 28.0);
    if (!place_panels_alone(drawing, frame, naming.kind, drawing.height - above)) return std::nullopt;
  }

  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    DrawnPanel& panel = drawing.panels[p];
    add_front(panel, figure.panels[p]);
    Occupied occupied = occupied_by_curves(panel, panel.frame);
    add_failures(panel, figure.panels[p], occupied);
    add_levels(panel, figure.panels[p]);
    const bool named = naming.panel == p;
    if (named && naming.kind == Kind::beside_frame && !name_beside_frame(panel, occupied))
      return std::nullopt;
    const auto lines = add_reference_lines(panel, figure.panels[p], occupied);
    name_reference_lines(panel, lines, occupied);
    if (named && !name_curves(panel, naming.kind, occupied)) return std::nullopt;
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
  add_notes(drawing.decoration, notes, drawing.panels.front().frame.left);
  return drawing;
}

/// Ways to name the curves, the best first.
std::vector<Naming> namings(const Figure& figure, const std::vector<std::vector<Curve>>& curves) {
  using Kind = Naming::Kind;
  const bool map = std::ranges::any_of(figure.panels, [](const Panel& panel) {
    return std::ranges::any_of(panel.series, &Series::marks_only);
  });
  if (map && figure.panels.size() == 1) return {{Kind::key_right}, {Kind::key_below}};
  if (map) return {{Kind::key_below}};
  if (figure.panels.size() == 1)
    return {{Kind::beside_frame},   {Kind::at_ends, 0, true}, {Kind::along},
            {Kind::along, 0, true}, {Kind::key_right},        {Kind::key_below}};
  std::vector<Naming> ways;
  if (figure.panels.size() == 2) {
    // The names of one panel do for both if it shows every curve.
    const std::size_t all = key_entries(figure, curves).size();
    for (const bool room : {false, true})
      for (const std::size_t p : {1U, 0U})
        if (curves[p].size() == all) ways.push_back({Kind::along, p, room});
  }
  ways.push_back({Kind::key_below});
  return ways;
}

}  // namespace

Drawing lay_out(const Figure& figure) {
  std::vector<std::string> left_out;
  std::vector<std::vector<Curve>> curves;
  for (const Panel& panel : figure.panels) curves.push_back(curves_of(panel, left_out));

  std::optional<Drawing> drawing;
  if (!figure.panels.empty())
    for (const Naming& naming : namings(figure, curves))
      if (!drawing) drawing = drawing_with(figure, curves, naming);
  if (!drawing) drawing.emplace();
  drawing->left_out.insert(drawing->left_out.begin(), left_out.begin(), left_out.end());
  return *drawing;
}

}  // namespace gnomon::output
