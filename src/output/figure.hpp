#pragma once
// Figures as data, drawn by gnuplot (5.4 or later) as SVG, PNG and PDF.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gnomon::output {

struct Range {
  double low = 0.0;
  double high = 1.0;
};

struct Series {
  std::string label;            ///< shortened if longer than 36 characters
  std::vector<double> x;        ///< drawn in the given order
  std::vector<double> y;        ///< same length; a value that cannot be drawn breaks the line
  std::vector<bool> hollow;     ///< points drawn hollow (failed, or at the reference's bound), with no line
                                ///< between two of them; empty: none
  int style = 0;                ///< see style_of: the scheme's position in the catalogue
  std::vector<Range> x_bars{};  ///< error bars along x, such as the least and the most of repeated times;
                                ///< same length; empty: none
  bool marks_only = false;      ///< a marker at every point and no line: a map; named in a key
};

/// A horizontal line, such as the error bound of the reference. Left out if it is far below the data.
struct ReferenceLine {
  double y = 0.0;
  std::string label;
};

/// A thin dotted horizontal line across part of the axis in the colour of a series, such as its floor.
struct Level {
  double y = 0.0;
  Range x;
  int style = 0;  ///< as of Series
};

/// A short line of slope `slope` on log-log axes, "order 4", put where there is no data.
struct Guide {
  double slope = 1.0;
  std::string label;
};

/// A run that failed has no y: a cross at the top of the frame, above all data.
struct Failure {
  double x = 0.0;     ///< not a number where it is not known: at the left edge of the frame
  int style = 0;      ///< as of Series
  std::string label;  ///< whose it is and why; not drawn
};

/// A corner of a Pareto front: nothing has a smaller y for the same x or less.
struct FrontPoint {
  double x = 0.0;
  double y = 0.0;
};

struct Panel {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool log_x = true;
  bool log_y = true;
  std::optional<Range> x_range;  ///< from the data if not given
  std::optional<Range> y_range;
  std::vector<ReferenceLine> reference_lines;
  std::vector<Guide> guides;
  std::vector<Failure> failures;
  std::vector<Level> levels{};
  std::vector<FrontPoint> front{};  ///< in any order; drawn as grey steps behind the curves
  std::vector<Series> series;
};

/// One panel, or several (two in a row) that share the names of their curves. All text is plain: nothing in
/// it is markup. Panels whose y axes have the same label and scale get the same y range, and those that stand
/// in one row show its labels once.
struct Figure {
  std::string title;
  std::string caption;         ///< not drawn; the title of the SVG document, which screen readers read
  std::string hollow_note;     ///< what hollow points mean; drawn below the axes if there are any
  std::string failure_note{};  ///< what crosses mean; drawn below the axes if there are any
  std::string floor_note{};    ///< what levels mean; drawn below the axes if there are any
  std::string front_note{};    ///< what the grey steps mean; drawn below the axes if there are any
  std::vector<Panel> panels;
};

struct FigureResult {
  bool written = false;
  bool has_pdf = false;               ///< also as PDF; not where gnuplot lacks the terminal pdfcairo
  std::string message;                ///< why nothing was written
  std::vector<std::string> left_out;  ///< what could not be drawn, e.g. a series without positive data
  explicit operator bool() const { return written; }
};

/// Draw `figure` into `stem`.svg (900 x 600 px, more for several panels or many curves), `stem`.png (twice
/// the pixels) and, where gnuplot has the terminal pdfcairo, `stem`.pdf; where it has not, an older PDF of
/// that name is removed. Each file is written whole or not at all; parent folders are made. If `gnuplot` (a
/// name looked up in PATH, or an absolute path) is missing or fails, nothing is written and the message says
/// why. The same data give the same bytes with the same gnuplot and fonts. Throws std::invalid_argument if
/// lengths of a series differ.
FigureResult write_figure(const Figure& figure, const std::filesystem::path& stem,
                          const std::string& gnuplot = "gnuplot");

}  // namespace gnomon::output
