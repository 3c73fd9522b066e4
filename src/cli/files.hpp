#pragma once
#include <optional>
#include <string>
#include <vector>

#include "src/output/figure.hpp"
#include "src/output/table.hpp"
#include "src/study/json.hpp"

namespace gnomon::cli {

/// Writes `folder/name`.md, .csv (of the first table), .tex, .json and, where there is a figure, .svg, .png
/// and .pdf. Characters of the name that do not belong into that of a file are replaced. Returns the names of
/// the files; a figure that could not be drawn gives a message on standard error.
std::vector<std::string> write_study(const std::string& folder, const std::string& name,
                                     const std::vector<output::Table>& tables, const Document& document,
                                     const std::optional<output::Figure>& figure, const std::string& heading);

}  // namespace gnomon::cli
