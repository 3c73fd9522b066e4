#pragma once
// A drawing as commands for gnuplot.

#include <string>

#include "src/output/figure_layout.hpp"

namespace gnomon::output {

/// Commands, with the data in them, that draw `drawing` into the three files, the PDF only where gnuplot has
/// the terminal pdfcairo. They need gnuplot 5.4 or later.
std::string gnuplot_script(const Drawing& drawing, const std::string& svg_path, const std::string& png_path,
                           const std::string& pdf_path);

/// Any text as a gnuplot string.
std::string quoted(const std::string& text);

}  // namespace gnomon::output
