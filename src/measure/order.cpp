#include "src/measure/order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>

#include "src/measure/statistics.hpp"

namespace gnomon {
namespace {

constexpr double roundoff_level = 1e-10;  // of the quantity's scale; errors may scatter from here down

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

// What an order is accurate to at best.
double accuracy(double order) { return std::max(0.1, 0.02 * order); }

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

// From the parabola of least squares. A change counts beyond three standard errors of its coefficient and
// beyond what an order is accurate to; below six points, where standard errors mean little, beyond twice that
// if the local slopes all move one way.
bool slopes_move(LogPoints points) {
  const auto n = static_cast<double>(points.size());
  double middle = 0.0;
  for (const LogPoint& p : points) middle += p.step / n;
  double x2 = 0.0, x3 = 0.0;
  for (const LogPoint& p : points) {
    x2 += std::pow(p.step - middle, 2) / n;
    x3 += std::pow(p.step - middle, 3) / n;
  }
  // Orthogonal polynomials 1, x, x^2 - x3 / x2 x - x2 over the points.
  const auto square = [&](double x) { return x * x - x3 / x2 * x - x2; };
  double mean = 0.0, xe = 0.0, qe = 0.0, qq = 0.0;
  for (const LogPoint& p : points) {
    const double x = p.step - middle, q = square(x);
    mean += p.error / n;
    xe += x * p.error / (n * x2);
    qe += q * p.error;
    qq += q * q;
  }
  const double curvature = qe / qq;
  double rest = 0.0;
  for (const LogPoint& p : points) {
    const double x = p.step - middle;
    rest += std::pow(p.error - mean - xe * x - curvature * square(x), 2);
  }
  const std::size_t last = points.size() - 1;
  const double reach =
      0.5 * (points[0].step + points[1].step) - 0.5 * (points[last - 1].step + points[last].step);
  const double size = std::abs(2.0 * curvature * reach), least = accuracy(xe);
  if (points.size() >= 6) return size > least && std::abs(curvature) > 3.0 * std::sqrt(rest / (n - 3.0) / qq);
  const std::vector<double> slopes = local_slopes(points);
  const bool one_way =
      std::ranges::is_sorted(slopes) || std::ranges::is_sorted(slopes, std::ranges::greater{});
  return one_way && size > 2.0 * least;
}

// Begins the points from `first` on earlier, as long as the local slopes move the same way.
std::size_t where_movement_begins(LogPoints points, std::size_t first) {
  const auto local = [&](std::size_t k) { return slope(points[k], points[k + 1]); };
  const bool down = local(first) > local(first + 1);
  while (first > 0 && (local(first - 1) > local(first)) == down) --first;
  return first;
}

// How many of the run's `count` points from `first` on have slopes that move: all of them; or all but the
// last one or two, where these are at roundoff and hide by their scatter that the slopes have been moving one
// way, five of them at least and the last three by more than twice what an order is accurate to. 0 if they do
// not.
std::size_t moving(LogPoints points, std::size_t first, std::size_t count, double roundoff) {
  if (slopes_move(points.subspan(first, count))) return count;
  for (std::size_t left = count - 1; left >= 3 && left + 2 >= count; --left) {
    if (points[first + left].error > std::log(roundoff)) break;
    const std::size_t begin = where_movement_begins(points, first), end = first + left;
    const std::vector<double> slopes = local_slopes(points.subspan(begin, end - begin));
    const bool one_way =
        std::ranges::is_sorted(slopes) || std::ranges::is_sorted(slopes, std::ranges::greater{});
    if (!one_way || slopes.size() < 5) continue;
    if (std::abs(slopes[slopes.size() - 3] - slopes.back()) > 2.0 * accuracy(slopes.back())) return left;
  }
  return 0;
}

// The medians of the two local slopes at either end.
double first_slope(LogPoints points) { return median(local_slopes(points.first(3))); }
double last_slope(LogPoints points) { return median(local_slopes(points.last(3))); }

// The longest run with one slope, at the smallest steps if several are as long; with the errors that are at
// `roundoff` one whose local slopes do not move.
std::optional<Window> find_window(LogPoints points, double tolerance, std::size_t min_points,
                                  std::optional<double> roundoff = {}) {
  for (std::size_t count = points.size(); count >= min_points; --count) {
    for (std::size_t first = points.size() - count + 1; first-- > 0;) {
      const LogPoints run = points.subspan(first, count);
      const double order = median(pairwise_slopes(run));
      const auto fits = [&](double local) { return std::abs(local - order) <= tolerance; };
      // A slope within the tolerance of zero is a floor.
      if (order <= tolerance || !std::ranges::all_of(local_slopes(run), fits)) continue;
      if (roundoff && moving(points, first, count, *roundoff) > 0) continue;
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

// Why there is no order although there is a window, and where the local slopes go; empty if there is one.
struct Objection {
  std::string text;
  double early = ObservedOrder::none, late = ObservedOrder::none;
};

// The order goes over into another one before a floor: two or more successive local slopes lie on one side of
// it, down to an error so far above the floor that this cannot bend them. `tail` begins with the window's
// last point.
Objection left_above_floor(LogPoints tail, double order, double tolerance) {
  constexpr double far = 50.0;
  const std::vector<double> slopes = local_slopes(tail);
  const auto flat = std::ranges::find_if(slopes, [&](double local) { return local < 0.5 * order; });
  if (flat == slopes.end()) return {};
  std::vector<double> floor;
  for (const LogPoint& point : tail.subspan(static_cast<std::size_t>(flat - slopes.begin()) + 1))
    floor.push_back(point.error);
  const double least = median(floor) + std::log(far);
  std::size_t count = 0;
  for (; count < slopes.size() && tail[count + 1].error > least; ++count)
    if (!((slopes[0] > order) == (slopes[count] > order) && std::abs(slopes[count] - order) > tolerance))
      return {};
  if (count < 2) return {};
  return {fmt::format("order {:.2f} is left for {:.2f} above the floor", order, slopes[count - 1]), order,
          slopes[count - 1]};
}

// At roundoff, and not the first after it: some larger step had an error less than three times that of the
// window, which is therefore no convergence that goes on.
bool scatters_at_floor(LogPoints tail, const Window& window, double roundoff) {
  const LogPoints run = tail.subspan(window.first, window.count);
  const double largest = std::ranges::max(run, {}, &LogPoint::error).error;
  if (window.first == 0 || largest > std::log(roundoff)) return false;
  std::vector<double> errors;
  for (const LogPoint& point : run) errors.push_back(point.error);
  return std::ranges::min(tail.first(window.first), {}, &LogPoint::error).error <=
         median(errors) + std::log(3.0);
}

// What the points at smaller steps have against the window. `tail` begins with the window's last point;
// errors up to `roundoff` may scatter.
Objection contradiction(LogPoints tail, double order, double tolerance, std::size_t min_points,
                        double roundoff) {
  const auto other = find_window(tail, tolerance, min_points);
  if (other && !scatters_at_floor(tail, *other, roundoff)) {
    if (std::abs(other->order - order) <= tolerance) return {};
    const double late = last_slope(tail.subspan(other->first, other->count));
    return {fmt::format("order {:.2f} turns into {:.2f} below step {:.3g}", order, other->order,
                        std::exp(tail[other->first].step)),
            order, late};
  }
  if (tail.size() < 3) return {};
  const std::vector<double> slopes = local_slopes(tail);
  const double overall = slope(tail.front(), tail.back());
  const auto shallow = [&](double local) { return local < 0.5 * order; };
  const auto above = [&](double local) { return local > order + tolerance; };
  const auto below = [&](double local) { return local < order - tolerance; };
  if (Objection left = left_above_floor(tail, order, tolerance); !left.text.empty()) return left;
  // Too few to tell a floor's beginning from another order, unless they fall faster.
  if (tail.size() < min_points && !std::ranges::all_of(slopes, above)) return {};
  if (shallow(overall) || twice_running(slopes, shallow)) return {};  // the floor
  if (std::abs(overall - order) <= tolerance) return {};
  // Near roundoff a few errors may do anything, more of them scatter.
  const bool scatters = std::ranges::any_of(slopes, above) && std::ranges::any_of(slopes, below);
  const bool near = std::ranges::min(tail, {}, &LogPoint::error).error <= std::log(roundoff);
  if (near && (scatters || tail.size() <= min_points)) return {};
  return {
      fmt::format("order {:.2f} is left for {:.2f} at the smallest steps, which is no floor", order, overall),
      order, last_slope(tail)};
}

// A run whose local slopes move, unless two thirds of it are steady: they have come to rest there.
Objection restlessness(LogPoints all, const Window& wide, const std::optional<Window>& steady,
                       double tolerance, std::size_t min_points, double roundoff) {
  const std::size_t end = wide.first + wide.count;
  if (steady) {
    const bool within =
        steady->first >= wide.first && steady->count < wide.count && steady->first + steady->count <= end;
    if (!within || 3 * steady->count >= 2 * wide.count) return {};
  }
  const std::size_t clean = moving(all, wide.first, wide.count, roundoff);
  const LogPoints run = all.subspan(wide.first, clean > 0 ? clean : wide.count);
  const double early = first_slope(all.subspan(where_movement_begins(all, wide.first)));
  double late = last_slope(run);
  if (const auto other = find_window(all.subspan(end - 1), tolerance, min_points))
    late = last_slope(all.subspan(end - 1 + other->first, other->count));
  return {fmt::format("the local slopes move from {:.2f} to {:.2f}", early, late), early, late};
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

// From the largest step on the local slopes come closer and closer to the declared order, from one side,
// until the error is at roundoff: three of them at least, the last two less than half as far from it as the
// first.
bool approaches_until_roundoff(LogPoints points, double declared, double roundoff) {
  const std::vector<double> slopes = local_slopes(points);
  std::size_t count = slopes.empty() ? 0 : 1;
  const auto off = [&](std::size_t k) { return slopes[k] - declared; };
  while (count < slopes.size() && off(count) * off(0) > 0.0 &&
         std::abs(off(count)) < std::abs(off(count - 1)))
    ++count;
  if (count < 3 || points[count].error > std::log(roundoff)) return false;
  const LogPoints run = points.first(count + 1);
  return std::abs(last_slope(run) - declared) < 0.5 * std::abs(first_slope(run) - declared);
}

// All errors are at roundoff, and not because the last of them fell there.
bool is_at_roundoff(const std::vector<OrderPoint>& points, std::size_t min_points, double unit) {
  std::vector<double> errors;  // from the largest step
  for (const OrderPoint& point : points)
    if (point.usable && std::isfinite(point.error)) errors.push_back(point.error);
  if (errors.size() < min_points || std::ranges::max(errors) > roundoff_level * unit) return false;
  const auto third = static_cast<std::ptrdiff_t>(errors.size() / 3 + 1);
  const double largest = median({errors.begin(), errors.begin() + third});
  const double smallest = median({errors.end() - third, errors.end()});
  return largest <= 10.0 * std::max(smallest, std::numeric_limits<double>::epsilon() * unit);
}

OrderFinding compare(const ObservedOrder& order, const std::optional<double>& declared) {
  if (!declared) return OrderFinding::observed;
  const bool off = std::abs(*order.observed - *declared) > accuracy(*declared);
  const bool outside = *declared < order.interval[0] || *declared > order.interval[1];
  return off && outside ? OrderFinding::differs : OrderFinding::as_declared;
}

}  // namespace

std::string_view to_string(OrderFinding finding) {
  switch (finding) {
    case OrderFinding::observed:
      return "observed";
    case OrderFinding::as_declared:
      return "as declared";
    case OrderFinding::differs:
      return "differs";
    case OrderFinding::approaching:
      return "approaching";
    case OrderFinding::exact:
      return "exact";
    case OrderFinding::roundoff:
      return "roundoff";
    case OrderFinding::none:
      return "none";
  }
  return "none";
}

ObservedOrder observe_order(std::vector<OrderPoint> points, const OrderOptions& options) {
  const auto coarser = [](const auto& a, const auto& b) { return larger(a.step, b.step); };
  std::stable_sort(points.begin(), points.end(), coarser);

  const std::vector<OrderPoint> given = points;
  ObservedOrder result;
  result.dropped = take_out_unfit(points, options);
  std::vector<LogPoint> logs;
  for (const OrderPoint& point : points) logs.push_back({std::log(point.step), std::log(point.error)});
  const LogPoints all(logs);
  const auto min_points = static_cast<std::size_t>(std::max(options.min_points, 3));

  const double unit = std::isfinite(options.scale) ? options.scale : 1.0;
  const auto wide = find_window(all, options.window_tolerance, min_points);
  if (!wide) {
    if (!is_at_roundoff(given, min_points, unit)) {
      result.verdict = "not asymptotic: " + why_no_window(all, options, min_points);
      if (options.declared && approaches_until_roundoff(all, *options.declared, roundoff_level * unit)) {
        result.finding = OrderFinding::approaching;
        result.verdict += fmt::format("; approaching {:g} until roundoff", *options.declared);
      }
    } else if (options.declared) {
      result.finding = OrderFinding::roundoff;
      result.verdict = "not asymptotic: the error is at roundoff at every step";
    } else {
      result.finding = OrderFinding::exact;
      result.verdict = "exact: the error is at roundoff at every step";
    }
    return result;
  }
  const double roundoff = roundoff_level * unit;
  const auto window = find_window(all, options.window_tolerance, min_points, roundoff);
  Objection objection = restlessness(all, *wide, window, options.window_tolerance, min_points, roundoff);
  const std::size_t last = window ? window->first + window->count - 1 : 0;
  if (window && objection.text.empty())
    objection =
        contradiction(all.subspan(last), window->order, options.window_tolerance, min_points, roundoff);
  const Window& doubtful = window ? *window : *wide;
  if (may_be_floor(all.first(doubtful.first + 1), doubtful, options.window_tolerance, min_points))
    objection = {fmt::format("slope {:.2f} of {} points follows a steeper one: a floor?", doubtful.order,
                             doubtful.count)};
  if (!objection.text.empty()) {
    result.verdict = "not asymptotic: " + objection.text;
    if (options.declared &&
        std::abs(objection.late - *options.declared) < 0.5 * std::abs(objection.early - *options.declared)) {
      result.finding = OrderFinding::approaching;
      result.verdict += fmt::format("; approaching {:g}", *options.declared);
    }
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
  result.finding = compare(result, options.declared);
  if (result.finding == OrderFinding::differs)
    result.verdict += fmt::format(", differs from the declared {:g}", *options.declared);
  return result;
}

}  // namespace gnomon
