#pragma once
// Where labels fit: free places among curves, markers and other labels. Lengths in pixels, y upwards.

#include <cstddef>
#include <optional>
#include <vector>

namespace gnomon::output {

struct Point {
  double x = 0.0;
  double y = 0.0;
};

struct Box {
  double left = 0.0;
  double bottom = 0.0;
  double right = 0.0;
  double top = 0.0;
};

/// What is drawn already, as cells of a few pixels.
class Occupied {
 public:
  /// Nothing is occupied within `area`, everything outside is.
  explicit Occupied(const Box& area);
  void add_line(Point from, Point to);
  void add_box(const Box& box);
  bool is_free(const Box& box) const;
  /// The same area with nothing drawn in it.
  Occupied emptied() const { return Occupied(area_); }
  /// Whether nothing is drawn within about a pixel of a line.
  bool is_free_along(Point from, Point to) const;

 private:
  std::size_t index(std::size_t column, std::size_t row) const { return row * columns_ + column; }

  Box area_;
  std::size_t columns_;
  std::size_t rows_;
  std::vector<bool> cells_;
};

/// Heights for labels that want to stand at `wanted`, kept `gap` apart and within [low, high], each moved as
/// little as that allows and in the same order. None if one would have to move by more than `longest_move`.
std::optional<std::vector<double>> spread(const std::vector<double>& wanted, double gap, double low,
                                          double high, double longest_move);

struct LineEnds {
  Point first;
  Point last;
  double text_width = 0.0;
};

/// Centre-left points of labels next to an end of each line; none if not all fit. Adds the labels found.
std::optional<std::vector<Point>> labels_at_ends(Occupied& occupied, const std::vector<LineEnds>& lines,
                                                 double text_height);

struct LabelledLine {
  std::vector<Point> anchors;  ///< where a label may point to; the first and the last are the best
  double text_width = 0.0;
};

struct LabelPlace {
  Point text;  ///< centre-left
  Point from;  ///< of a leader from the line to the label, if there is one
  Point to;
  bool leader = false;
};

/// A label for each line, close to it or joined to it by a short leader that crosses no other label and no
/// line where it can be avoided. None if not all fit. Adds the labels and leaders found.
std::optional<std::vector<LabelPlace>> labels_along(Occupied& occupied,
                                                    const std::vector<LabelledLine>& lines,
                                                    double text_height);

struct GuidePlace {
  std::vector<Point> from;  ///< one for each slope
  std::vector<Point> to;
  std::vector<Point> labels;  ///< centre-left points
};

/// A fan of lines with the given slopes (in pixels) from a common point, as large as the free space allows.
/// None if there is no place for it or its labels would overlap. Adds the fan to `occupied`.
std::optional<GuidePlace> place_guides(Occupied& occupied, const Box& area, const std::vector<double>& slopes,
                                       const std::vector<double>& text_widths, double text_height);

/// Centre-left point of a label above or, failing that, below a horizontal line at height `y`, as far right
/// as possible; at the right end if it is free nowhere. Adds the label.
Point label_on_horizontal(Occupied& occupied, const Box& area, double y, double text_width,
                          double text_height);

}  // namespace gnomon::output
