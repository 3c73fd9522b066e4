#pragma once

#include <optional>
#include <vector>

#include "src/measure/order.hpp"

namespace gnomon {

/// The level at which an error stops falling with the step.
struct ErrorFloor {
  double level = 0.0;         ///< median of the errors there; where they grow, their line at `step_from`
  int points = 0;             ///< at least 4
  double step_from = 0.0;     ///< largest step of the floor
  double step_to = 0.0;       ///< smallest step
  double typical_step = 0.0;  ///< smallest step whose error is at least half the level
};

/// The floor of roundoff or of a Newton tolerance that the smallest steps show: the longest run of points up
/// to the smallest step whose Theil-Sen slope, also without its first or its last point, is at most twice the
/// window's tolerance, none of its first points above three times the level, behind points of which two
/// successive local slopes are steeper and which fall further than the floor's own points scatter. Where no
/// order is observed before it, which could tell scatter from a floor, six points and twice that fall are
/// asked for. None where the error falls to the end, never fell, or came down to twice the reference's bound,
/// which hides a floor.
std::optional<ErrorFloor> find_floor(std::vector<OrderPoint> points, const OrderOptions& options);

}  // namespace gnomon
