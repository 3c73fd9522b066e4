#include "src/output/figure_script.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <vector>

#include "src/output/text.hpp"

namespace gnomon::output {
namespace {

constexpr const char* font = "DejaVu Sans";

/// Size of a filled marker (the hollow one's number is one less) so that all look equally large, and alike in
/// both formats: gnuplot's SVG and Cairo terminals draw the same size differently.
struct MarkerSize {
  int filled;
  double svg;
  double png;
};
constexpr std::array<MarkerSize, 6> marker_sizes = {{{7, 0.62, 1.0},      // circle
                                                     {5, 0.55, 0.9},      // square
                                                     {9, 0.60, 1.2},      // triangle up
                                                     {13, 0.57, 1.25},    // diamond
                                                     {11, 0.60, 1.2},     // triangle down
                                                     {15, 0.58, 1.15}}};  // pentagon

using Output = std::back_insert_iterator<std::string>;

std::string screen(const Drawing& drawing, Point at) {
  return fmt::format("screen {:.6f},{:.6f}", at.x / drawing.width, at.y / drawing.height);
}

void write_data(Output out, const std::string& name, const std::vector<std::vector<Point>>& pieces) {
  fmt::format_to(out, "${} << END_OF_DATA\n", name);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    if (p > 0) fmt::format_to(out, "\n");
    for (const Point& point : pieces[p]) fmt::format_to(out, "{:.17g} {:.17g}\n", point.x, point.y);
  }
  fmt::format_to(out, "END_OF_DATA\n");
}

std::string data_name(std::size_t panel, std::size_t curve, const char* part) {
  return fmt::format("panel{}_curve{}_{}", panel, curve, part);
}

void write_all_data(Output out, const Drawing& drawing) {
  for (std::size_t p = 0; p < drawing.panels.size(); ++p) {
    const auto& curves = drawing.panels[p].curves;
    for (std::size_t c = 0; c < curves.size(); ++c) {
      write_data(out, data_name(p, c, "line"), curves[c].pieces);
      if (!curves[c].filled.empty()) write_data(out, data_name(p, c, "filled"), {curves[c].filled});
      if (!curves[c].hollow.empty()) write_data(out, data_name(p, c, "hollow"), {curves[c].hollow});
      if (curves[c].bars.empty()) continue;
      fmt::format_to(out, "${} << END_OF_DATA\n", data_name(p, c, "bars"));
      for (const Bar& bar : curves[c].bars)
        fmt::format_to(out, "{:.17g} {:.17g} {:.17g} {:.17g}\n", bar.at.x, bar.at.y, bar.low, bar.high);
      fmt::format_to(out, "END_OF_DATA\n");
    }
  }
  for (std::size_t p = 0; p < drawing.panels.size(); ++p)
    if (!drawing.panels[p].front.empty())
      write_data(out, fmt::format("panel{}_front", p), {drawing.panels[p].front});
  // A panel without data is drawn as an empty frame: a plot of one undefined value.
  fmt::format_to(out, "$nothing << END_OF_DATA\nNaN NaN\nEND_OF_DATA\n");
}

void write_decoration(Output out, const Drawing& drawing, const Decoration& decoration) {
  for (const Stroke& stroke : decoration.strokes) {
    fmt::format_to(out, "set arrow from {} to {} nohead front lw {} dt {} lc rgb '{}'\n",
                   screen(drawing, stroke.from), screen(drawing, stroke.to), stroke.width, stroke.dash,
                   stroke.colour);
  }
  for (const Mark& mark : decoration.marks) {
    fmt::format_to(out, "set label '' at {} front point pt {} ps size{} lc rgb '{}'\n",
                   screen(drawing, mark.at), mark.type, mark.type, mark.colour);
  }
  for (const Text& text : decoration.texts) {
    if (text.text.empty()) continue;
    const char* anchor = text.anchor == Anchor::left    ? "left"
                         : text.anchor == Anchor::right ? "right"
                                                        : "center";
    fmt::format_to(out, "set label {} at {} {}{} noenhanced front font ',{}' textcolor rgb '{}'\n",
                   quoted(text.text), screen(drawing, text.at), anchor, text.upwards ? " rotate by 90" : "",
                   text.size, text.colour);
  }
}

void write_axis(Output out, const Axis& axis, char name, bool labels) {
  fmt::format_to(out, "{} logscale {}\n", axis.log ? "set" : "unset", name);
  fmt::format_to(out, "set {}range [{:.17g}:{:.17g}] noextend\n", name, axis.range.low, axis.range.high);
  fmt::format_to(out, "set {}tics in scale 0.9,0.45 font ',15' (", name);
  for (std::size_t i = 0; i < axis.ticks.size(); ++i) {
    const Tick& tick = axis.ticks[i];
    const bool minor = tick.label.empty();
    fmt::format_to(out, "{}'{}' {:.17g} {}", i == 0 ? "" : ", ", labels ? tick.label : "", tick.value,
                   minor ? 1 : 0);
  }
  fmt::format_to(out, ")\n");
}

void write_plot(Output out, const DrawnPanel& panel, std::size_t p) {
  const char* separator = "plot ";
  const auto element = [&](const std::string& data, const std::string& look, const std::string& title,
                           const char* columns = "1:2") {
    fmt::format_to(out, "{}${} using {} with {} title {} noenhanced", separator, data, columns, look,
                   quoted(title));
    separator = ", \\\n  ";
  };
  if (!panel.front.empty())
    element(fmt::format("panel{}_front", p),
            fmt::format("lines lw {} lc rgb '{}'", front_width, front_colour), "Pareto front");
  if (panel.curves.empty()) element("nothing", "points pt 7 lc rgb '#ffffff'", "");
  for (std::size_t c = 0; c < panel.curves.size(); ++c) {
    const Curve& curve = panel.curves[c];
    const SeriesStyle& style = curve.style;
    element(data_name(p, c, "line"),
            fmt::format("lines lw {} dt {} lc rgb '{}'", curve.line_width, style.dash, style.colour),
            curve.label);
  }
  for (std::size_t c = 0; c < panel.curves.size(); ++c) {
    const Curve& curve = panel.curves[c];
    if (curve.bars.empty()) continue;
    element(data_name(p, c, "bars"),
            fmt::format("xerrorbars pt 0 ps 0 lw 0.9 lc rgb '{}'", curve.style.colour), curve.label,
            "1:2:3:4");
  }
  // Markers stand above all lines; a hollow one hides what is below it.
  for (std::size_t c = 0; c < panel.curves.size(); ++c) {
    const Curve& curve = panel.curves[c];
    const SeriesStyle& style = curve.style;
    const auto points = [&](int type, const std::string& colour) {
      return fmt::format("points pt {} ps size{} lw 1.5 lc rgb '{}'", type, type, colour);
    };
    if (!curve.filled.empty()) {
      element(data_name(p, c, "filled"), points(style.filled_marker, style.colour), curve.label);
    }
    if (!curve.hollow.empty()) {
      element(data_name(p, c, "hollow"), points(style.filled_marker, "#ffffff"), curve.label);
      element(data_name(p, c, "hollow"), points(style.hollow_marker, style.colour), curve.label);
    }
  }
  fmt::format_to(out, "\n");
}

void write_panels(Output out, const Drawing& drawing, double MarkerSize::*size) {
  for (const MarkerSize& marker : marker_sizes) {
    fmt::format_to(out, "size{} = {}\nsize{} = {}\n", marker.filled, marker.*size, marker.filled - 1,
                   marker.*size);
  }
  fmt::format_to(out, "size2 = {}\nset errorbars 0.5\n", marker_sizes.front().*size);
  fmt::format_to(
      out, "set multiplot\nunset key\nset clip one\nset clip two\nset border 31 lw 1 lc rgb '#333333'\n");
  fmt::format_to(out, "set grid xtics ytics nomxtics nomytics back lt 1 lw 0.6 dt solid lc rgb '#dcdcdc'\n");
  for (std::size_t p = 0; p < drawing.panels.size(); ++p) {
    const DrawnPanel& panel = drawing.panels[p];
    fmt::format_to(out, "unset label\nunset arrow\n");
    fmt::format_to(out, "set lmargin at screen {:.6f}\nset rmargin at screen {:.6f}\n",
                   panel.frame.left / drawing.width, panel.frame.right / drawing.width);
    fmt::format_to(out, "set bmargin at screen {:.6f}\nset tmargin at screen {:.6f}\n",
                   panel.frame.bottom / drawing.height, panel.frame.top / drawing.height);
    write_axis(out, panel.x, 'x', true);
    write_axis(out, panel.y, 'y', panel.y_labels);
    write_decoration(out, drawing, panel.decoration);
    if (p == 0) write_decoration(out, drawing, drawing.decoration);
    write_plot(out, panel, p);
  }
  fmt::format_to(out, "unset multiplot\nunset output\n");
}

}  // namespace

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : plain_text(text)) {
    if (c == '\'') result += '\'';
    result += c;
  }
  return result + '\'';
}

std::string gnuplot_script(const Drawing& drawing, const std::string& svg_path, const std::string& png_path,
                           const std::string& pdf_path) {
  std::string script;
  const Output out = std::back_inserter(script);
  fmt::format_to(out, "reset session\nset encoding utf8\n");
  write_all_data(out, drawing);
  fmt::format_to(out, "set terminal svg size {:.0f},{:.0f} enhanced font '{},15' background '#ffffff'\n",
                 drawing.width, drawing.height, font);
  fmt::format_to(out, "set output {}\n", quoted(svg_path));
  write_panels(out, drawing, &MarkerSize::svg);
  fmt::format_to(out,
                 // Cairo takes font sizes as points of 1/72 inch with 96 pixels to the inch, SVG as pixels:
                 // 0.75 makes them equal.
                 "set terminal pngcairo size {:.0f},{:.0f} enhanced font '{},15' fontscale 1.5 linewidth 2 "
                 "pointscale 2 dashlength 2 background '#ffffff'\n",
                 2.0 * drawing.width, 2.0 * drawing.height, font);
  fmt::format_to(out, "set output {}\n", quoted(png_path));
  write_panels(out, drawing, &MarkerSize::png);
  fmt::format_to(out, "if (strstrt(GPVAL_TERMINALS, 'pdfcairo') == 0) {{ exit }}\n");
  // 96 pixels to the inch: units of 1/72 inch are 0.75 of a pixel, and fonts have that factor twice. Lines
  // are half as wide there as in the PNG's terminal, and dashes shorter.
  fmt::format_to(out,
                 "set terminal pdfcairo size {:.4f}in,{:.4f}in enhanced font '{},15' fontscale 0.5625 "
                 "linewidth 1.5 pointscale 0.75 dashlength 1.82 background '#ffffff'\n",
                 drawing.width / 96.0, drawing.height / 96.0, font);
  fmt::format_to(out, "set output {}\n", quoted(pdf_path));
  write_panels(out, drawing, &MarkerSize::png);
  return script;
}

}  // namespace gnomon::output
