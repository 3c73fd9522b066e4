#pragma once
// The lines below a figure that say what its marks mean.

#include <string>
#include <vector>

#include "src/output/figure_layout.hpp"

namespace gnomon::output {

/// The place of one line of text below the axes.
struct PlacedNote {
  std::string text;
  double left = 0.0;
  std::size_t line = 0;  ///< from the top
  int mark = 0;          ///< of the sample before it; 0: none
  bool steps = false;    ///< the sample is one of the grey steps
};

/// The notes of a figure in lines not wider than `width`, as many side by side as fit; long ones are broken
/// between words.
std::vector<PlacedNote> notes_of(const Figure& figure, const std::vector<std::vector<Curve>>& curves,
                                 double width);

/// The height that notes need; 0 for none.
double height_of(const std::vector<PlacedNote>& notes);

/// Adds them at the bottom of a drawing, with their left ends at `left`.
void add_notes(Decoration& decoration, const std::vector<PlacedNote>& notes, double left);

}  // namespace gnomon::output
