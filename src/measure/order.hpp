#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

/// One run of a convergence study.
struct OrderPoint {
  double step = 0.0;    ///< step size or element length, > 0
  double error = 0.0;   ///< >= 0, in the unit of OrderOptions
  bool usable = true;   ///< false: a failed run, a missed break of the data, ..
  std::string why_not;  ///< the reason when it is not usable
};

struct OrderOptions {
  double bound = 0.0;  ///< error bound of the reference; errors up to ten times it are dropped
  double floor =
      0.0;  ///< measured floor of roundoff or Newton tolerance, 0 if unknown; errors up to it are dropped
  double scale = std::numeric_limits<double>::infinity();  ///< size of the quantity (pi for an angle); errors
                                                           ///< of a tenth of it and more are pre-asymptotic
  double window_tolerance = 0.25;  ///< how far a local slope may lie from the slope of its window
  int min_points = 4;              ///< of a window; fewer than 3 count as 3
};

struct DroppedPoint {
  double step = 0.0;
  double error = 0.0;
  std::string reason;
};

struct ObservedOrder {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::optional<double> observed;  ///< Theil-Sen slope of log error against log step, if a window exists
  std::array<double, 2> interval{none, none};  ///< quartiles of the window's pairwise slopes
  int points = 0;                              ///< in the window
  double step_from = none;                     ///< largest step of the window
  double step_to = none;                       ///< smallest step of the window
  std::vector<DroppedPoint> dropped;           ///< every other point, from the largest step to the smallest
  std::string verdict;                         ///< one line; "not asymptotic: .." when there is no order
};

/// Order of convergence, observed in the asymptotic range only. After dropping unusable points and those at
/// the floor or above a tenth of the scale, the window is the longest run of successive points whose local
/// slopes all lie within `window_tolerance` of the run's Theil-Sen slope (Theil 1950, Sen 1968), the one at
/// the smaller steps if several are as long. A flat run is a floor, not an order. No order is given when the
/// smaller steps beyond the window contradict it: when they converge at another order, or leave it without
/// reaching a floor (two successive local slopes below half the order). Points may come in any order.
ObservedOrder observe_order(std::vector<OrderPoint> points, const OrderOptions& options);

}  // namespace gnomon
