#include "src/output/figure_style.hpp"

#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "tests/catch.hpp"

using namespace gnomon::output;

namespace {

/// Contrast against white, 1 to 21 (WCAG 2.1, "contrast ratio").
double contrast_on_white(const std::string& colour) {
  const auto linear = [&](std::size_t at) {
    const double c = std::stoi(colour.substr(at, 2), nullptr, 16) / 255.0;
    return c <= 0.03928 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  return 1.05 / (0.2126 * linear(1) + 0.7152 * linear(3) + 0.0722 * linear(5) + 0.05);
}

}  // namespace

TEST_CASE("output: styles differ with and without colour") {
  std::set<std::pair<std::string, int>> with_colour;
  std::set<std::pair<int, std::string>> without_colour;
  for (int i = 0; i < 42; ++i) {
    const SeriesStyle style = style_of(i);
    with_colour.insert({style.colour, style.filled_marker});
    if (i < 30) without_colour.insert({style.filled_marker, style.dash});
    CHECK(style.hollow_marker == style.filled_marker - 1);
  }
  CHECK(with_colour.size() == 42);
  CHECK(without_colour.size() == 30);
}

TEST_CASE("output: a style depends on its number alone, any number has one") {
  CHECK(style_of(3).colour == style_of(3).colour);
  CHECK(style_of(210).dash == style_of(0).dash);
  CHECK(style_of(210).colour == style_of(0).colour);
  CHECK(style_of(210).filled_marker == style_of(0).filled_marker);
  CHECK(style_of(-1).colour == style_of(209).colour);
}

TEST_CASE("output: names are dark enough to read, curves to see") {
  for (int i = 0; i < 7; ++i) {
    CAPTURE(i);
    CHECK(contrast_on_white(style_of(i).text_colour) >= 4.5);
    CHECK(contrast_on_white(style_of(i).colour) >= 2.0);
  }
  CHECK(contrast_on_white("#F0E442") < 1.5);  // the palette's yellow, which is left out
}

TEST_CASE("output: no two curves of a figure look alike, and one scheme is the same in all panels") {
  Figure figure;
  figure.panels.resize(2);
  // 25 and 67 have a colour and a marker in common, 5 and 35 shape and dashes.
  for (const int style : {25, 67, 5, 35, 65, 3}) figure.panels[0].series.push_back({"", {}, {}, {}, style});
  for (const int style : {67, 99, 3}) figure.panels[1].series.push_back({"", {}, {}, {}, style});
  figure.panels[1].failures = {{1.0, 35, ""}, {1.0, 99, ""}};
  settle_styles(figure);
  const auto& first = figure.panels[0].series;
  const auto& second = figure.panels[1].series;
  CHECK(first[0].style == 25);
  CHECK(first[1].style == 7);
  CHECK(first[2].style == 5);
  CHECK(first[3].style == 6);
  CHECK(first[4].style == 8);
  CHECK(first[5].style == 3);
  CHECK(second[0].style == first[1].style);
  CHECK(second[1].style == 9);
  CHECK(second[2].style == first[5].style);
  CHECK(figure.panels[1].failures[0].style == first[3].style);
  CHECK(figure.panels[1].failures[1].style == 9);
}
