#pragma once
// Figures like those of a study, for tests.

#include "src/output/figure.hpp"

namespace gnomon::test {

/// Twelve schemes: error against CPU time; some end at the reference's bound, one is a single point.
output::Figure work_precision();
/// Error against CPU time and against evaluations, with guides.
output::Figure work_precision_in_two_panels();
/// Four schemes of orders 1, 2, 4, 4 with guides.
output::Figure convergence();
/// |energy error| against time for seven schemes, many points each.
output::Figure drift();

}  // namespace gnomon::test
