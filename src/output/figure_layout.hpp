#pragma once
// From a figure's data to what is drawn where.

#include <string>
#include <vector>

#include "src/output/figure.hpp"
#include "src/output/figure_axis.hpp"
#include "src/output/figure_labels.hpp"
#include "src/output/figure_style.hpp"

namespace gnomon::output {

inline constexpr double text_size = 15.0;
inline constexpr double line_height = 22.0;
inline constexpr const char* front_colour = "#b4b4b4";
inline constexpr double front_width = 3.0;

enum class Anchor { left, centre, right };

/// A line of text, vertically centred at `at`.
struct Text {
  Point at;
  Anchor anchor = Anchor::left;
  std::string text;
  double size = 15.0;
  std::string colour = "#000000";
  bool upwards = false;
};

struct Stroke {
  Point from;
  Point to;
  std::string colour = "#000000";
  double width = 1.0;
  std::string dash = "solid";
};

struct Mark {
  Point at;
  int type = 7;
  std::string colour = "#000000";
};

/// An error bar along x at a point, in data coordinates.
struct Bar {
  Point at;
  double low = 0.0;
  double high = 0.0;
};

/// Points in data coordinates.
struct Curve {
  std::string label;
  SeriesStyle style;
  double line_width = 1.8;
  std::vector<std::vector<Point>> pieces;  ///< see Series::y and Series::hollow for where it breaks
  std::vector<Point> filled;               ///< where markers stand
  std::vector<Point> hollow;
  std::vector<Bar> bars;
};

struct Decoration {
  std::vector<Text> texts;
  std::vector<Stroke> strokes;
  std::vector<Mark> marks;
};

struct DrawnPanel {
  Box frame;
  Axis x;
  Axis y;
  bool y_labels = true;
  std::vector<Curve> curves;
  std::vector<Point> front;  ///< corners of the grey steps, in data coordinates
  Decoration decoration;
};

/// Lengths in pixels of the SVG, y upwards from the bottom.
struct Drawing {
  double width = 900.0;
  double height = 600.0;
  std::vector<DrawnPanel> panels;
  Decoration decoration;              ///< title, key and notes
  std::vector<std::string> left_out;  ///< as in FigureResult
};

/// A point of the data in the drawing.
Point to_pixels(const DrawnPanel& panel, Point data);

/// One panel, or one of two, names its curves beside them if all names find a place. Else there is a key: at
/// the right of a single panel if it has room there, else below all, in columns; the drawing gets as high as
/// that needs. Throws std::invalid_argument if lengths of a series differ.
Drawing lay_out(const Figure& figure);

}  // namespace gnomon::output
