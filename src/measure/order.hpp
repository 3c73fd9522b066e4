#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
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
  std::optional<double> declared;  ///< the order that is expected, if any; never changes the observed one
};

/// What the points say of the order.
enum class OrderFinding {
  observed,     ///< an order, and none is declared to compare it with
  as_declared,  ///< within the larger of 0.1 and 2 % of the declared one, or its quartiles hold that
  differs,      ///< an order other than the declared one
  approaching,  ///< no order: the local slopes still move, towards the declared one
  exact,        ///< no order, and none is declared: the error is at roundoff at every step
  roundoff,     ///< the same where one is declared: larger steps might show it
  none          ///< no order
};

std::string_view to_string(OrderFinding finding);

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
  OrderFinding finding = OrderFinding::none;
  std::string verdict;  ///< one line; "exact: .." or "not asymptotic: .." when there is no order
};

/// Order of convergence, observed in the asymptotic range only. After dropping unusable points and those at
/// the floor or above a tenth of the scale, the window is the longest run of successive points whose local
/// slopes all lie within `window_tolerance` of the run's Theil-Sen slope (Theil 1950, Sen 1968), the one at
/// the smaller steps if several are as long. Within it the local slopes must be steady: their change over the
/// run, from the parabola of least squares, is not significant (three standard errors) or at most the larger
/// of 0.1 and 2 % of the order; and it must hold two thirds of the longer run around it whose slopes move, or
/// these have not come to rest; one or two errors at roundoff at its end do not hide that they move. A flat
/// run is a floor, not an order. No order is given when the smaller steps beyond the window contradict it:
/// when they converge at another order, or leave it on one side far above a floor, or leave it without
/// reaching a floor, which shows in two successive local slopes below half the order or, at roundoff, in
/// local slopes on both sides of it. Points may come in any order.
ObservedOrder observe_order(std::vector<OrderPoint> points, const OrderOptions& options);

}  // namespace gnomon
