#pragma once
// How a series looks: colour, marker and dashes that can be told apart in print and by colour-blind readers.

#include <string>

#include "src/output/figure.hpp"

namespace gnomon::output {

struct SeriesStyle {
  std::string colour;       ///< "#RRGGBB", of lines and markers
  std::string text_colour;  ///< the same hue, dark enough for text on white
  int filled_marker = 7;    ///< gnuplot point type
  int hollow_marker = 6;    ///< the same shape in outline
  std::string dash;         ///< gnuplot dash type: "solid" or "(11,4)"
};

/// The style with a number: seven colours of Okabe and Ito's palette (its yellow is too faint on white), six
/// marker shapes and five dash patterns, each cycling with its own period. The first 42 styles differ in
/// colour or marker, the first 30 in marker or dashes, that is, also without colour.
SeriesStyle style_of(int index);

/// Gives the curves of a figure styles among the first 30: their own, modulo 30, where no curve before has
/// it, else the next one that is free. Curves of one style keep a common one, in every panel.
void settle_styles(Figure& figure);

}  // namespace gnomon::output
