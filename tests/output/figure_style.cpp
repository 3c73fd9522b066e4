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
