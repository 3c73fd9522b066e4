#pragma once
// Tables for papers.

#include <string>
#include <string_view>
#include <vector>

#include "src/output/table.hpp"

namespace gnomon::output {

/// Any text as LaTeX that sets it as it is: control sequences, braces and signs escaped, quotes and dashes
/// kept apart from ligatures; numbers with an exponent, as "1.20e-05", become powers of ten; other letters
/// stay UTF-8.
std::string latex_text(std::string_view text);

/// A table environment in the style of booktabs: caption, rules, notes below; a longtable where there are
/// more than 40 rows. Throws std::invalid_argument if a row's length is not the number of columns.
std::string to_latex(const Table& table);

/// Several of them, the packages that they need in a comment at the top.
std::string latex_document(const std::vector<Table>& tables);

}  // namespace gnomon::output
