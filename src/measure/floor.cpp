#include "src/measure/floor.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "src/measure/statistics.hpp"

namespace gnomon {
namespace {

using Values = std::span<const double>;  // natural logarithms, from the largest step to the smallest

/// The level of these points as the logarithm of an error, if they do not fall.
std::optional<double> flat_level(Values steps, Values errors, double steepest) {
  const std::size_t count = steps.size();
  const double slope = theil_sen_slope(steps, errors);
  const bool falls = slope > steepest || theil_sen_slope(steps.subspan(1), errors.subspan(1)) > steepest ||
                     theil_sen_slope(steps.first(count - 1), errors.first(count - 1)) > steepest;
  if (falls) return std::nullopt;
  // Roundoff grows as the steps shrink: its least value is the floor.
  const double growth = std::min(slope, 0.0);
  std::vector<double> at_first;
  for (std::size_t i = 0; i < count; ++i) at_first.push_back(errors[i] - growth * (steps[i] - steps[0]));
  return median(at_first);
}

/// Whether the last three of these points fall steeply.
bool has_fallen(Values steps, Values errors, double steepest) {
  const std::size_t n = steps.size();
  if (n < 3) return false;
  for (std::size_t i = n - 2; i < n; ++i)
    if ((errors[i - 1] - errors[i]) / (steps[i - 1] - steps[i]) <= steepest) return false;
  return true;
}

}  // namespace

std::optional<ErrorFloor> find_floor(std::vector<OrderPoint> points, const OrderOptions& options) {
  const ObservedOrder order = observe_order(points, options);
  std::erase_if(points, [&](const OrderPoint& point) {
    return !point.usable || !(point.step > 0.0) || !std::isfinite(point.step) || !(point.error > 0.0) ||
           !(point.error < 0.1 * options.scale) || !std::isfinite(point.error);
  });
  std::ranges::stable_sort(points, std::ranges::greater{}, &OrderPoint::step);
  const auto doubled = std::ranges::unique(points, {}, &OrderPoint::step);
  points.erase(doubled.begin(), doubled.end());
  std::vector<double> steps, errors;
  for (const OrderPoint& point : points) {
    steps.push_back(std::log(point.step));
    errors.push_back(std::log(point.error));
  }
  const double steepest = 2.0 * options.window_tolerance;
  for (std::size_t first = 2; first + 4 <= points.size(); ++first) {
    const Values x = Values(steps).subspan(first), y = Values(errors).subspan(first);
    const auto level = flat_level(x, y, steepest);
    if (!level || y.front() > *level + std::log(3.0)) continue;
    if (!has_fallen(Values(steps).first(first + 1), Values(errors).first(first + 1), steepest)) continue;
    const auto [least, most] = std::ranges::minmax(y);
    const double fall = std::ranges::max(Values(errors).first(first)) - *level;
    if (fall < std::log(10.0) || fall < most - least) continue;
    const bool behind_window = order.observed && points[first].step <= order.step_to;
    if (!behind_window && (y.size() < 6 || fall < 2.0 * (most - least))) continue;
    if (*level <= std::log(2.0 * options.bound)) return std::nullopt;
    std::size_t typical = points.size() - 1;
    while (errors[typical] < *level - std::log(2.0)) --typical;
    return ErrorFloor{std::exp(*level), static_cast<int>(y.size()), points[first].step, points.back().step,
                      points[typical].step};
  }
  return std::nullopt;
}

}  // namespace gnomon
