#pragma once
#include <string>
#include <vector>

#include "src/output/table.hpp"
#include "src/study/converge.hpp"
#include "src/study/study_file.hpp"

namespace gnomon {

/// Observed orders in the first metric, scenes by schemes, the declared order in brackets where the observed
/// one is more than 0.1 away from it.
output::Table order_matrix(const std::vector<Convergence>& studies);

/// Puts generated text between the marks `<!-- begin NAME -->` and `<!-- end NAME -->` of a document; a
/// document without them comes back unchanged.
std::string replace_section(const std::string& document, const std::string& name, const std::string& text);

/// Rows of other programs below those of ours, with their source, in a table of drifts.
void add_published(const DriftPlan& plan, output::Table& drifts);

}  // namespace gnomon
