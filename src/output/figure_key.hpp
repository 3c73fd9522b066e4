#pragma once
// The key of a figure: a sample of each curve with its name.

#include <string>
#include <vector>

#include "src/output/figure_layout.hpp"

namespace gnomon::output {

struct KeyEntry {
  std::string label;
  int style = 0;
  bool line = false;
};

/// One entry for each name and style; `curves` are those of each panel (see curves_of).
std::vector<KeyEntry> key_entries(const Figure& figure, const std::vector<std::vector<Curve>>& curves);

/// The width of the longest name.
double widest(const std::vector<KeyEntry>& entries);

/// The width of an entry whose name has the width `text`.
double key_entry_width(double text);

/// A key of several columns, filled column by column.
struct KeyGrid {
  std::size_t rows = 0;
  std::vector<double> left;  ///< of each column
  double width = 0.0;
};

/// The key with the fewest rows that is not wider than `width`, else of one column.
KeyGrid key_grid(const std::vector<KeyEntry>& entries, double width);

/// One entry of the key with its left end at `at`.
void add_key_entry(Decoration& decoration, const KeyEntry& entry, Point at);

}  // namespace gnomon::output
