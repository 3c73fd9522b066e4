#include "src/output/figure_layout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/output/figure_curves.hpp"
#include "src/output/figure_script.hpp"
#include "src/output/text.hpp"
#include "tests/catch.hpp"
#include "tests/output/sample_figures.hpp"

using namespace gnomon::output;
using namespace gnomon::test;

namespace {

std::vector<Text> all_texts(const Drawing& drawing) {
  std::vector<Text> texts = drawing.decoration.texts;
  for (const DrawnPanel& panel : drawing.panels) {
    texts.insert(texts.end(), panel.decoration.texts.begin(), panel.decoration.texts.end());
  }
  std::erase_if(texts, [](const Text& text) { return text.text.empty(); });
  return texts;
}

Box box_of(const Text& text) {
  const double width = text_width(text.text, text.size);
  const double half = 0.5 * text.size;
  if (text.upwards)
    return {text.at.x - half, text.at.y - 0.5 * width, text.at.x + half, text.at.y + 0.5 * width};
  const double left = text.at.x - (text.anchor == Anchor::centre ? 0.5 : 0.0) * width;
  return {left, text.at.y - half, left + width, text.at.y + half};
}

bool overlap(const Box& a, const Box& b) {
  return a.left < b.right && b.left < a.right && a.bottom < b.top && b.bottom < a.top;
}

/// Boxes of the labels of the ticks, which gnuplot places.
std::vector<Box> tick_boxes(const DrawnPanel& panel) {
  const auto width_of = [](const std::string& label) {
    const std::size_t power = label.find("^{");
    if (power == std::string::npos) return text_width(label, text_size);
    return text_width(label.substr(0, power), text_size) +
           text_width(label.substr(power + 2, label.size() - power - 3), 0.8 * text_size);
  };
  const Box& frame = panel.frame;
  std::vector<Box> boxes;
  for (const Tick& tick : panel.x.ticks) {
    if (tick.label.empty()) continue;
    const double x = frame.left + panel.x.position(tick.value) * (frame.right - frame.left);
    const double half = 0.5 * width_of(tick.label);
    boxes.push_back({x - half, frame.bottom - 30.0, x + half, frame.bottom - 12.0});
  }
  for (const Tick& tick : panel.y.ticks) {
    if (tick.label.empty() || !panel.y_labels) continue;
    const double y = frame.bottom + panel.y.position(tick.value) * (frame.top - frame.bottom);
    boxes.push_back({frame.left - 8.0 - width_of(tick.label), y - 7.0, frame.left - 8.0, y + 7.0});
  }
  return boxes;
}

/// Pairs of texts, or of a text and the label of a tick, that lie on each other.
std::vector<std::string> overlaps(const Drawing& drawing) {
  std::vector<std::pair<std::string, Box>> boxes;
  for (const Text& text : all_texts(drawing)) boxes.emplace_back(text.text, box_of(text));
  for (const DrawnPanel& panel : drawing.panels)
    for (const Box& box : tick_boxes(panel)) boxes.emplace_back("a tick", box);
  std::vector<std::string> pairs;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (overlap(boxes[i].second, boxes[j].second))
        pairs.push_back(boxes[i].first + " on " + boxes[j].first);
  return pairs;
}

void check_texts(const Drawing& drawing) {
  for (const Text& text : all_texts(drawing)) {
    CAPTURE(text.text);
    const Box box = box_of(text);
    CHECK(box.left >= 0.0);
    CHECK(box.bottom >= 0.0);
    CHECK(box.right <= drawing.width);
    CHECK(box.top <= drawing.height);
    CHECK(text.size >= 11.0 * 96.0 / 72.0);  // eleven points
  }
  CHECK(overlaps(drawing) == std::vector<std::string>{});
}

/// Curves of eight points that fall from the high to the low end of y, each a little lower, and failed runs.
Figure many_curves(std::size_t panels, int count, Range x, Range y) {
  Figure figure;
  figure.title = "many curves";
  figure.hollow_note = "hollow: at or below the bound of the reference";
  figure.front_note = "Pareto front";
  figure.failure_note =
      "12 runs failed: blanes-moan-rkn6-exact-drift 4, blanes-moan-rkn6-exact-drift-again 4, mclachlan8 4";
  const auto between = [](Range range, double part) {
    return std::pow(10.0, std::log10(range.low) + part * (std::log10(range.high) - std::log10(range.low)));
  };
  for (std::size_t p = 0; p < panels; ++p) {
    Panel panel;
    panel.title = "a panel";
    panel.x_label = "CPU time [s]";
    panel.y_label = "orientation error at t = 10 s [rad]";
    for (int c = 0; c < count; ++c) {
      Series series = {"blanes-moan-scheme-" + std::to_string(c), {}, {}, {}, c};
      for (int k = 0; k < 8; ++k) {
        series.x.push_back(between(x, k / 7.0));
        series.y.push_back(between(y, 1.0 - (0.8 * k / 7.0 + 0.2 * c / count)));
        series.hollow.push_back(k == 7);
      }
      panel.series.push_back(series);
    }
    panel.front = {{between(x, 0.2), between(y, 0.5)}, {between(x, 0.6), between(y, 0.1)}};
    for (int k = 0; k < 12; ++k)
      panel.failures.push_back(
          {k < 4 ? std::numeric_limits<double>::quiet_NaN() : between(x, k % 4 / 4.0), k, "failed"});
    figure.panels.push_back(panel);
  }
  return figure;
}

Text text_named(const Drawing& drawing, const std::string& name, const std::vector<Text>& texts) {
  const auto found =
      std::find_if(texts.begin(), texts.end(), [&](const Text& text) { return text.text == name; });
  CAPTURE(name, drawing.width);
  REQUIRE(found != texts.end());
  return *found;
}

std::size_t times_named(const std::vector<Text>& texts, const std::string& name) {
  return static_cast<std::size_t>(
      std::count_if(texts.begin(), texts.end(), [&](const Text& text) { return text.text == name; }));
}

}  // namespace

TEST_CASE("output: text in figures is large enough, inside and apart") {
  check_texts(lay_out(work_precision()));
  check_texts(lay_out(work_precision_in_two_panels()));
  check_texts(lay_out(convergence()));
  check_texts(lay_out(drift()));
  Figure four = work_precision_in_two_panels();
  four.panels.push_back(convergence().panels.front());
  four.panels.push_back({});
  for (Panel& panel : four.panels) panel.title = "panel title";
  check_texts(lay_out(four));
  Figure one = convergence();
  one.panels.front().series.resize(1);
  check_texts(lay_out(one));
}

TEST_CASE("output: text of many curves and of extreme ranges stays apart", "[long]") {
  const std::vector<std::pair<Range, Range>> ranges = {{{1e-3, 1e2}, {1e-14, 1e0}},
                                                       {{0.05, 0.5}, {1e-27, 1e290}},
                                                       {{1e-299, 1e299}, {1e-299, 1e299}},
                                                       {{1.0, 1.001}, {3.0, 3.0}}};
  for (const std::size_t panels : {1U, 2U})
    for (const int count : {1, 8, 16, 40, 90})
      for (const auto& [x, y] : ranges) {
        CAPTURE(panels, count, x.low, y.low);
        const Figure figure = many_curves(panels, count, x, y);
        const Drawing drawing = lay_out(figure);
        check_texts(drawing);
        const std::vector<Text> texts = all_texts(drawing);
        for (const Series& series : figure.panels[0].series) CHECK(times_named(texts, series.label) == 1);
      }
  // It would be seen.
  Drawing squeezed = lay_out(many_curves(1, 40, {1.0, 2.0}, {1.0, 2.0}));
  for (Text& text : squeezed.decoration.texts) text.at.y *= 0.5;
  CHECK(overlaps(squeezed).size() > 10);
}

TEST_CASE("output: a key too long for the right side stands below in columns") {
  const Drawing drawing = lay_out(many_curves(1, 40, {1e-3, 1.0}, {1e-9, 1.0}));
  const Text first = text_named(drawing, "blanes-moan-scheme-0", drawing.decoration.texts);
  const Text last = text_named(drawing, "blanes-moan-scheme-39", drawing.decoration.texts);
  CHECK(first.at.y < drawing.panels.front().frame.bottom - 50.0);
  CHECK(last.at.x > first.at.x + 100.0);
  CHECK(drawing.height > 700.0);
  CHECK(drawing.panels.front().frame.top - drawing.panels.front().frame.bottom >= 400.0);
}

TEST_CASE("output: a few curves of two panels are named in one of them, without a key") {
  Figure figure = work_precision_in_two_panels();
  for (Panel& panel : figure.panels)
    panel.series = {panel.series[1], panel.series[3], panel.series[5], panel.series[8]};
  const Drawing drawing = lay_out(figure);
  check_texts(drawing);
  for (const char* name : {"munjiza-half-impulse", "rkmk4", "cvode-bdf", "arkode-erk8"}) {
    const Text text = text_named(drawing, name, drawing.panels[1].decoration.texts);
    CHECK(text.at.x > drawing.panels[1].frame.left);
    CHECK(text.at.x < drawing.panels[1].frame.right);
    CHECK(times_named(drawing.decoration.texts, name) == 0);
  }
  CHECK(text_named(drawing, "rkmk4", drawing.panels[1].decoration.texts).colour == style_of(3).text_colour);
  // One panel cannot name a curve it does not show.
  figure.panels[1].series.pop_back();
  const Drawing left = lay_out(figure);
  CHECK(times_named(left.panels[0].decoration.texts, "arkode-erk8") == 1);
}

TEST_CASE("output: a Pareto front is drawn as steps behind the curves") {
  Figure figure = convergence();
  figure.front_note = "Pareto front";
  CHECK(times_named(all_texts(lay_out(figure)), "Pareto front") == 0);
  Panel& panel = figure.panels.front();
  panel.front = {{0.02, 1e-9}, {0.005, 1e-5}, {0.01, 1e-5}, {-1.0, 1e-3}};
  const Drawing drawing = lay_out(figure);
  check_texts(drawing);
  CHECK(times_named(all_texts(drawing), "Pareto front") == 1);
  const DrawnPanel& drawn = drawing.panels.front();
  const std::vector<Point> wanted = {
      {0.005, drawn.y.range.high}, {0.005, 1e-5}, {0.02, 1e-5}, {0.02, 1e-9}, {drawn.x.range.high, 1e-9}};
  REQUIRE(drawn.front.size() == wanted.size());
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    CHECK(drawn.front[k].x == wanted[k].x);
    CHECK(drawn.front[k].y == wanted[k].y);
  }
  const std::string script = gnuplot_script(drawing, "a.svg", "a.png", "a.pdf");
  CHECK(script.find("plot $panel0_front using 1:2 with lines") != std::string::npos);
  CHECK(gnuplot_script(lay_out(convergence()), "a.svg", "a.png", "a.pdf").find("_front") ==
        std::string::npos);
}

TEST_CASE("output: curves that reach the right end are named beside the frame, in their colours") {
  const Drawing drawing = lay_out(convergence());
  const DrawnPanel& panel = drawing.panels.front();
  const auto& texts = panel.decoration.texts;
  for (const char* name : {"munjiza", "munjiza-half-impulse", "munjiza-stage-moments", "rkmk4"}) {
    CHECK(text_named(drawing, name, texts).at.x > panel.frame.right);
  }
  CHECK(text_named(drawing, "munjiza", texts).colour == style_of(0).text_colour);
  CHECK(text_named(drawing, "munjiza", texts).at.y > text_named(drawing, "rkmk4", texts).at.y);
  CHECK(text_named(drawing, "order 4", texts).at.x < panel.frame.right);
  CHECK(drawing.left_out.empty());
}

TEST_CASE("output: a few curves are named at their ends or along them, many in a key") {
  Figure figure = work_precision();
  auto& series = figure.panels.front().series;
  series = {series[1], series[3], series[5], series[8]};
  const Drawing few = lay_out(figure);
  for (const char* name : {"munjiza-half-impulse", "rkmk4", "cvode-bdf", "arkode-erk8"}) {
    const Text text = text_named(few, name, few.panels.front().decoration.texts);
    CHECK(text.at.x < few.panels.front().frame.right);
  }
  CHECK(times_named(few.decoration.texts, "rkmk4") == 0);

  const Drawing more = lay_out(work_precision());
  for (const char* name : {"munjiza", "arkode-erk8", "exact-free-top"})
    CHECK(text_named(more, name, more.panels.front().decoration.texts).at.x <
          more.panels.front().frame.right);

  // There is no place for twenty names about one point.
  series.assign(20, {"", {1.0}, {1e-3}, {}, 0});
  for (std::size_t k = 0; k < series.size(); ++k) series[k].label = "scheme-number-" + std::to_string(k);
  const Drawing many = lay_out(figure);
  check_texts(many);
  for (const Series& each : series) {
    CHECK(text_named(many, each.label, many.decoration.texts).at.x > many.panels.front().frame.right);
    CHECK(times_named(many.panels.front().decoration.texts, each.label) == 0);
  }
}

TEST_CASE("output: panels share names or a key and, side by side, the y axis") {
  const Drawing drawing = lay_out(work_precision_in_two_panels());
  REQUIRE(drawing.panels.size() == 2);
  CHECK(times_named(all_texts(drawing), "rkmk4") == 1);
  CHECK(times_named(all_texts(drawing), "exact-free-top") == 1);
  const Drawing many = lay_out(many_curves(2, 40, {1e-3, 1.0}, {1e-9, 1.0}));
  CHECK(text_named(many, "blanes-moan-scheme-7", many.decoration.texts).at.y < many.panels[0].frame.bottom);
  CHECK(drawing.panels[0].y.range.low == drawing.panels[1].y.range.low);
  CHECK(drawing.panels[0].y.range.high == drawing.panels[1].y.range.high);
  CHECK(drawing.panels[0].y_labels);
  CHECK_FALSE(drawing.panels[1].y_labels);
  CHECK(drawing.panels[0].frame.right < drawing.panels[1].frame.left);

  Figure different = work_precision_in_two_panels();
  different.panels[1].y_label = "momentum error";
  CHECK(lay_out(different).panels[1].y_labels);
}

TEST_CASE("output: what cannot be drawn is left out and named") {
  const double nan_value = std::numeric_limits<double>::quiet_NaN();
  Figure figure = convergence();
  Panel& panel = figure.panels.front();
  panel.series.push_back({"empty", {}, {}, {}, 4});
  panel.series.push_back({"zeros", {1.0, 2.0}, {0.0, -1.0}, {}, 5});
  panel.series.push_back({"failed", {1.0, nan_value}, {nan_value, 1.0}, {}, 6});
  panel.reference_lines.push_back({1e-28, "far below"});
  const Drawing drawing = lay_out(figure);
  CHECK(drawing.panels.front().curves.size() == 4);
  REQUIRE(drawing.left_out.size() == 4);
  CHECK(drawing.left_out[0] == "empty: no positive, finite values");
  CHECK(drawing.left_out[1] == "zeros: no positive, finite values");
  CHECK(drawing.left_out[2] == "failed: no positive, finite values");
  CHECK(drawing.left_out[3] == "far below: 1e-28 is far from the data");
  CHECK(drawing.panels.front().y.range.low > 1e-15);
  CHECK(times_named(all_texts(drawing), "zeros") == 0);

  panel.log_y = false;  // then zero and negative values have a place
  CHECK(lay_out(figure).panels.front().curves.size() == 5);
}

TEST_CASE("output: values that cannot be drawn and neighbours at the bound break a line") {
  Panel panel;
  const double nan_value = std::numeric_limits<double>::quiet_NaN();
  panel.series = {{"a", {1, 2, 3, 4, 5}, {1, 2, nan_value, 4, 5}, {}, 0},
                  {"b", {1, 2, 3, 4}, {4, 3, 2, 2}, {false, false, true, true}, 1}};
  std::vector<std::string> left_out;
  const auto curves = curves_of(panel, left_out);
  REQUIRE(curves.size() == 2);
  REQUIRE(curves[0].pieces.size() == 2);
  CHECK(curves[0].pieces[0].size() == 2);
  CHECK(curves[0].pieces[1].size() == 2);
  CHECK(curves[0].filled.size() == 4);
  REQUIRE(curves[1].pieces.size() == 2);
  CHECK(curves[1].pieces[0].size() == 3);
  CHECK(curves[1].pieces[1].size() == 1);
  CHECK(curves[1].filled.size() == 2);
  CHECK(curves[1].hollow.size() == 2);
}

TEST_CASE("output: a map has a marker at every point, no line and a key") {
  Figure figure;
  figure.panels.emplace_back();
  Series series;
  series.label = "survives";
  series.marks_only = true;
  for (int k = 0; k < 100; ++k) {
    series.x.push_back(1.0 + k % 5);
    series.y.push_back(std::pow(2.0, -0.05 * k));
    series.hollow.push_back(k % 2 == 1);
  }
  figure.panels[0].series.push_back(series);
  const Drawing map = lay_out(figure);
  REQUIRE(map.panels[0].curves.size() == 1);
  const Curve& curve = map.panels[0].curves[0];
  CHECK(curve.filled.size() == 50);
  CHECK(curve.hollow.size() == 50);
  CHECK_FALSE(has_line(curve));
  const auto is_name = [](const Text& text) { return text.text == "survives"; };
  CHECK(std::ranges::count_if(map.decoration.texts, is_name) == 1);
  check_texts(map);
  // As a curve it has a line and few markers.
  figure.panels[0].series[0].marks_only = false;
  const Drawing line = lay_out(figure);
  CHECK(has_line(line.panels[0].curves[0]));
  CHECK(line.panels[0].curves[0].filled.size() + line.panels[0].curves[0].hollow.size() < 20);
}

TEST_CASE("output: long curves have few markers, at different places") {
  std::vector<std::string> left_out;
  const auto curves = curves_of(drift().panels.front(), left_out);
  REQUIRE(curves.size() == 7);
  for (const Curve& curve : curves) {
    CHECK(curve.filled.size() >= 8);
    CHECK(curve.filled.size() <= 9);
    CHECK(curve.pieces.front().size() == 200);
    CHECK_FALSE(has_markers_everywhere(curve));
  }
  CHECK(curves[0].filled.front().x != curves[1].filled.front().x);
}

TEST_CASE("output: lengths that differ are refused") {
  Figure figure = convergence();
  figure.panels.front().series[1].y.pop_back();
  CHECK_THROWS_AS(lay_out(figure), std::invalid_argument);
  figure = convergence();
  figure.panels.front().series[1].hollow.pop_back();
  CHECK_THROWS_AS(lay_out(figure), std::invalid_argument);
}

TEST_CASE("output: labels cannot break out of the script") {
  CHECK(quoted("it's") == "'it''s'");
  CHECK(quoted("a\nsystem('x')") == "'a system(''x'')'");
  Figure figure = convergence();
  figure.panels.front().series[0].label = "'; system('false'); '\nexit 3";
  const std::string script = gnuplot_script(lay_out(figure), "a.svg", "a.png", "a.pdf");
  CHECK(script.find("\nexit") == std::string::npos);
  CHECK(script.find("'''; system(''false''); '' exit 3'") != std::string::npos);
}

TEST_CASE("output: failed runs are crosses at the top, error bars span what they are given") {
  Figure figure = convergence();
  figure.failure_note = "a run that failed";
  const Drawing without = lay_out(figure);
  CHECK(times_named(all_texts(without), "a run that failed") == 0);
  Panel& panel = figure.panels.front();
  const double x = panel.series[0].x[1];
  panel.failures = {{x, 1, "a"}, {x, 2, "b"}, {panel.series[0].x[2], 3, "c"}, {-1.0, 4, "no place"}};
  Series& series = panel.series[0];
  for (const double at : series.x) series.x_bars.push_back({0.9 * at, 1.2 * at});
  series.x_bars[1] = {0.0, 0.0};
  const Drawing drawing = lay_out(figure);
  check_texts(drawing);
  CHECK(times_named(all_texts(drawing), "a run that failed") == 1);
  const DrawnPanel& drawn = drawing.panels.front();
  std::vector<Mark> crosses;
  for (const Mark& mark : drawn.decoration.marks)
    if (mark.type == 2) crosses.push_back(mark);
  REQUIRE(crosses.size() == 3);
  CHECK(crosses[0].colour == style_of(1).colour);
  CHECK(crosses[0].at.x == crosses[1].at.x);
  CHECK(crosses[0].at.y - crosses[1].at.y >= 10.0);
  CHECK(crosses[2].at.y == crosses[0].at.y);
  for (const Mark& cross : crosses) {
    CHECK(cross.at.y < drawn.frame.top);
    CHECK(cross.at.y > drawn.frame.top - 40.0);
  }
  // Above all data, which have their own place below.
  for (const Series& each : panel.series)
    for (std::size_t k = 0; k < each.x.size(); ++k)
      CHECK(to_pixels(drawn, {each.x[k], each.y[k]}).y < crosses[1].at.y - 6.0);
  const double position = drawn.frame.left + drawn.x.position(x) * (drawn.frame.right - drawn.frame.left);
  CHECK(std::abs(crosses[0].at.x - position) <= 1e-9);
  REQUIRE(drawn.curves[0].bars.size() == drawn.curves[0].filled.size() + drawn.curves[0].hollow.size() - 1);
  for (const Bar& bar : drawn.curves[0].bars) {
    CHECK(bar.low == 0.9 * bar.at.x);
    CHECK(bar.high == 1.2 * bar.at.x);
  }
  CHECK(drawn.curves[1].bars.empty());
  const std::string script = gnuplot_script(drawing, "a.svg", "a.png", "a.pdf");
  CHECK(script.find("with xerrorbars") != std::string::npos);
  CHECK(gnuplot_script(without, "a.svg", "a.png", "a.pdf").find("with xerrorbars") == std::string::npos);
  // One whose place is not known stands at the left edge.
  panel.failures = {{std::numeric_limits<double>::quiet_NaN(), 1, "crashed"}};
  const Drawing crashed = lay_out(figure);
  const auto& marks = crashed.panels.front().decoration.marks;
  const auto cross =
      std::find_if(marks.begin(), marks.end(), [](const Mark& mark) { return mark.type == 2; });
  REQUIRE(cross != marks.end());
  CHECK(cross->at.x < crashed.panels.front().frame.left + 12.0);
  // As many bars as values, or none.
  series.x_bars.pop_back();
  CHECK_THROWS_AS(lay_out(figure), std::invalid_argument);
}
