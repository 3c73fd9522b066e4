#include "src/measure/order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "src/measure/statistics.hpp"

namespace gnomon {
namespace {

struct LogPoint {
  double step;  // natural logarithms
  double error;
};
using LogPoints = std::span<const LogPoint>;  // from the largest step to the smallest

struct Window {
  std::size_t first;
  std::size_t count;
  double order;
};

double slope(const LogPoint& a, const LogPoint& b) { return (a.error - b.error) / (a.step - b.step); }

std::vector<double> pairwise_slopes(LogPoints points) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = i + 1; j < points.size(); ++j) slopes.push_back(slope(points[i], points[j]));
  return slopes;
}

std::vector<double> local_slopes(LogPoints points) {
  std::vector<double> slopes;
  for (std::size_t i = 1; i < points.size(); ++i) slopes.push_back(slope(points[i - 1], points[i]));
  return slopes;
}

// The longest run with one slope, at the smallest steps if several are as long.
std::optional<Window> find_window(LogPoints points, double tolerance, std::size_t min_points) {
  for (std::size_t count = points.size(); count >= min_points; --count) {
    for (std::size_t first = points.size() - count + 1; first-- > 0;) {
      const LogPoints run = points.subspan(first, count);
      const double order = median(pairwise_slopes(run));
      const auto fits = [&](double local) { return std::abs(local - order) <= tolerance; };
      // A slope within the tolerance of zero is a floor.
      if (order > tolerance && std::ranges::all_of(local_slopes(run), fits))
        return Window{first, count, order};
    }
  }
  return std::nullopt;
}

// Two successive values that satisfy the condition.
template <class Condition>
bool twice_running(const std::vector<double>& values, Condition condition) {
  const auto both = [&](double a, double b) { return condition(a) && condition(b); };
  return std::adjacent_find(values.begin(), values.end(), both) != values.end();
}

// A short or nearly flat window behind convergence at more than twice its order may be the scatter of a
// floor. `head` ends with the window's first point.
bool may_be_floor(LogPoints head, const Window& window, double tolerance, std::size_t min_points) {
  const auto steep = [&](double local) { return local > 2.0 * window.order; };
  const bool weak = window.count < min_points + 2 || window.order < 2.0 * tolerance;
  return weak && twice_running(local_slopes(head), steep);
}

// Why the points at smaller steps contradict the window; empty if they do not. `tail` begins with the
// window's last point.
std::string contradiction(LogPoints tail, double order, double tolerance, std::size_t min_points) {
  if (const auto other = find_window(tail, tolerance, min_points)) {
    if (std::abs(other->order - order) <= tolerance) return {};
    return fmt::format("order {:.2f} turns into {:.2f} below step {:.3g}", order, other->order,
                       std::exp(tail[other->first].step));
  }
  if (tail.size() < min_points) return {};  // too few to tell a floor's beginning from another order
  const auto shallow = [&](double local) { return local < 0.5 * order; };
  const double overall = slope(tail.front(), tail.back());
  if (shallow(overall) || twice_running(local_slopes(tail), shallow)) return {};  // the floor
  if (std::abs(overall - order) <= tolerance) return {};
  return fmt::format("order {:.2f} is left for {:.2f} at the smallest steps, which is no floor", order,
                     overall);
}

// Largest first; what is no number comes last.
bool larger(double a, double b) { return std::isnan(b) ? !std::isnan(a) : a > b; }

std::string reason_to_drop(const OrderPoint& point, const OrderOptions& options) {
  if (!point.usable) return point.why_not.empty() ? "not usable" : point.why_not;
  if (!std::isfinite(point.step) || point.step <= 0.0) return "the step is not a positive number";
  if (!std::isfinite(point.error) || point.error < 0.0) return "the error is not a number";
  if (point.error == 0.0) return "the error is zero: below every floor";
  if (point.error <= 10.0 * options.bound) return "within ten times the reference's error bound";
  if (point.error <= options.floor) return "below the floor";
  if (point.error >= 0.1 * options.scale) return "pre-asymptotic: the error is a tenth of the scale or more";
  return {};
}

// Takes the points that cannot count out of `points` and returns them with the reason.
std::vector<DroppedPoint> take_out_unfit(std::vector<OrderPoint>& points, const OrderOptions& options) {
  std::vector<DroppedPoint> dropped;
  std::vector<OrderPoint> kept;
  for (const OrderPoint& point : points) {
    std::string reason = reason_to_drop(point, options);
    if (reason.empty() && !kept.empty() && kept.back().step == point.step) reason = "the step occurs twice";
    if (reason.empty())
      kept.push_back(point);
    else
      dropped.push_back({point.step, point.error, reason});
  }
  points = kept;
  return dropped;
}

std::string why_no_window(LogPoints points, const OrderOptions& options, std::size_t min_points) {
  if (points.size() < min_points)
    return fmt::format("{} of the points can count, {} are needed", points.size(), min_points);
  if (median(pairwise_slopes(points)) <= options.window_tolerance)
    return "the error does not fall with the step";
  return fmt::format("no {} successive points share a slope to within {}", min_points,
                     options.window_tolerance);
}

}  // namespace

ObservedOrder observe_order(std::vector<OrderPoint> points, const OrderOptions& options) {
  const auto coarser = [](const auto& a, const auto& b) { return larger(a.step, b.step); };
  std::stable_sort(points.begin(), points.end(), coarser);

  ObservedOrder result;
  result.dropped = take_out_unfit(points, options);
  std::vector<LogPoint> logs;
  for (const OrderPoint& point : points) logs.push_back({std::log(point.step), std::log(point.error)});
  const LogPoints all(logs);
  const auto min_points = static_cast<std::size_t>(std::max(options.min_points, 3));

  const auto window = find_window(all, options.window_tolerance, min_points);
  if (!window) {
    result.verdict = "not asymptotic: " + why_no_window(all, options, min_points);
    return result;
  }
  const std::size_t last = window->first + window->count - 1;
  std::string objection =
      contradiction(all.subspan(last), window->order, options.window_tolerance, min_points);
  if (may_be_floor(all.first(window->first + 1), *window, options.window_tolerance, min_points))
    objection = fmt::format("slope {:.2f} of {} points follows a steeper one: a floor?", window->order,
                            window->count);
  if (!objection.empty()) {
    result.verdict = "not asymptotic: " + objection;
    return result;
  }

  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i < window->first) result.dropped.push_back({points[i].step, points[i].error, "before the window"});
    if (i > last) result.dropped.push_back({points[i].step, points[i].error, "beyond the window"});
  }
  std::stable_sort(result.dropped.begin(), result.dropped.end(), coarser);
  const std::vector<double> slopes = pairwise_slopes(all.subspan(window->first, window->count));
  result.observed = window->order;
  result.interval = {quantile(slopes, 0.25), quantile(slopes, 0.75)};
  result.points = static_cast<int>(window->count);
  result.step_from = points[window->first].step;
  result.step_to = points[last].step;
  result.verdict = fmt::format("order {:.2f} from {} points", window->order, window->count);
  return result;
}

}  // namespace gnomon
