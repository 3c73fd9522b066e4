#pragma once
// The names of curves beside them.

#include "src/output/figure_layout.hpp"

namespace gnomon::output {

/// Names right of the frame, each at the height of its curve's right end. False, with nothing added, if they
/// do not fit or an end is so far from there that what joins them would cross something.
bool name_beside_frame(DrawnPanel& panel, Occupied& occupied);

/// Names within the frame at an end of each curve. False if they do not fit.
bool name_at_ends(DrawnPanel& panel, Occupied& occupied);

/// Names within the frame near each curve, with short leaders where they do not touch it. False if they do
/// not fit.
bool name_along(DrawnPanel& panel, Occupied& occupied);

}  // namespace gnomon::output
