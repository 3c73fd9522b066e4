#include "src/output/figure_style.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <set>

namespace gnomon::output {
namespace {

struct Hue {
  const char* colour;
  const char* text;
};

// Okabe and Ito, "Color Universal Design" (2008): https://jfly.uni-koeln.de/color/
constexpr std::array<Hue, 7> hues = {{{"#0072B2", "#00588A"},
                                      {"#D55E00", "#A84A00"},
                                      {"#009E73", "#00704F"},
                                      {"#000000", "#000000"},
                                      {"#CC79A7", "#9C3F73"},
                                      {"#E69F00", "#8A5F00"},
                                      {"#56B4E9", "#1F6F9F"}}};

struct Marker {
  int filled;
  int hollow;
};

// Circle, square, triangle up, diamond, triangle down, pentagon.
constexpr std::array<Marker, 6> markers = {{{7, 6}, {5, 4}, {9, 8}, {13, 12}, {11, 10}, {15, 14}}};

constexpr std::array<const char*, 5> dashes = {"solid", "(11,4)", "(11,4,2,4)", "(4,3)", "(11,4,2,4,2,4)"};

std::size_t cyclic(int index, std::size_t period) {
  const int count = static_cast<int>(period);
  return static_cast<std::size_t>((index % count + count) % count);
}

}  // namespace

SeriesStyle style_of(int index) {
  const Hue hue = hues[cyclic(index, hues.size())];
  const Marker marker = markers[cyclic(index, markers.size())];
  return {hue.colour, hue.text, marker.filled, marker.hollow, dashes[cyclic(index, dashes.size())]};
}

void settle_styles(Figure& figure) {
  constexpr int count = 30;
  std::map<int, int> settled;
  std::set<int> taken;
  const auto settle = [&](int& style) {
    const auto [place, is_new] = settled.try_emplace(style, static_cast<int>(cyclic(style, count)));
    int& own = place->second;
    for (int tries = 0; is_new && tries < count && taken.contains(own); ++tries) own = (own + 1) % count;
    taken.insert(own);
    style = own;
  };
  for (Panel& panel : figure.panels)
    for (Series& series : panel.series) settle(series.style);
  for (Panel& panel : figure.panels) {
    for (Failure& failure : panel.failures) settle(failure.style);
    for (Level& level : panel.levels) settle(level.style);
  }
}

}  // namespace gnomon::output
