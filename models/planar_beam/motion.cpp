#include "models/planar_beam/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gnomon::planar_beam {
namespace {

constexpr double pi = std::numbers::pi;

/// Slope of the piece from point k - 1 to k; 0 outside.
double slope_of(const Polyline& line, std::size_t k) {
  if (k == 0 || k >= line.t.size()) return 0.0;
  return (line.value[k] - line.value[k - 1]) / (line.t[k] - line.t[k - 1]);
}

}  // namespace

double Polyline::at(double time) const {
  const auto next = std::upper_bound(t.begin(), t.end(), time);
  if (next == t.begin()) return value.front();
  const std::size_t k = static_cast<std::size_t>(next - t.begin());
  return k == t.size() ? value.back() : value[k - 1] + slope_of(*this, k) * (time - t[k - 1]);
}

double Polyline::slope_before(double time) const {
  return slope_of(*this, static_cast<std::size_t>(std::lower_bound(t.begin(), t.end(), time) - t.begin()));
}

double Polyline::slope_after(double time) const {
  return slope_of(*this, static_cast<std::size_t>(std::upper_bound(t.begin(), t.end(), time) - t.begin()));
}

double Polyline::integral(double time) const {
  double sum = 0.0;
  for (std::size_t k = 1; k < t.size() && t[k - 1] < time; ++k) {
    const double end = std::min(time, t[k]);
    sum += (end - t[k - 1]) * 0.5 * (value[k - 1] + at(end));
  }
  return sum + std::max(0.0, time - t.back()) * value.back();
}

double Motion::value(double t) const {
  if (t <= 0.0) return 0.0;
  switch (kind) {
    case MotionKind::ramp:
      return t < over ? to * (t / over) : to;
    case MotionKind::half_sine:
      return t < over ? to * std::sin(pi * (t / over)) : 0.0;
    case MotionKind::spin_up: {
      if (t >= over) return to * t - 0.5 * to * over;
      // cos x - 1 without cancellation
      const double sine = std::sin(pi * t / over), unit = over / (2.0 * pi);
      return to / over * (0.5 * t * t - 2.0 * unit * unit * sine * sine);
    }
    case MotionKind::table:
      return table.at(t);
  }
  return 0.0;
}

double Motion::rate(double t, bool before) const {
  if (before ? t <= 0.0 : t < 0.0) return 0.0;
  if (kind == MotionKind::table) return before ? table.slope_before(t) : table.slope_after(t);
  const bool moving = before ? t <= over : t < over;
  switch (kind) {
    case MotionKind::ramp:
      return moving ? to / over : 0.0;
    case MotionKind::half_sine:
      return moving ? to * pi / over * std::cos(pi * (t / over)) : 0.0;
    default:
      return moving ? to / over * (t - over / (2.0 * pi) * std::sin(2.0 * pi * (t / over))) : to;
  }
}

double Motion::acceleration_after(double t) const {
  if (t < 0.0 || t >= over) return 0.0;
  switch (kind) {
    case MotionKind::half_sine:
      return -to * (pi / over) * (pi / over) * std::sin(pi * (t / over));
    case MotionKind::spin_up: {
      const double sine = std::sin(pi * (t / over));
      return to / over * 2.0 * sine * sine;
    }
    default:
      return 0.0;
  }
}

std::vector<double> Motion::breaks() const {
  return kind == MotionKind::table ? table.t : std::vector<double>{0.0, over};
}

double Motion::snapped(double t, double tolerance) const {
  if (kind == MotionKind::table) {
    for (double point : table.t)
      if (std::abs(t - point) <= tolerance) return point;
    return t;
  }
  if (std::abs(t) <= tolerance) return 0.0;
  return std::abs(t - over) <= tolerance ? over : t;
}

double Motion::final_value() const {
  return kind == MotionKind::table ? table.value.back() : kind == MotionKind::half_sine ? 0.0 : to;
}

double Motion::largest_rate() const {
  switch (kind) {
    case MotionKind::ramp:
      return std::abs(to) / over;
    case MotionKind::half_sine:
      return pi * std::abs(to) / over;
    case MotionKind::spin_up:
      return std::abs(to);
    case MotionKind::table:
      break;
  }
  double largest = 0.0;
  for (std::size_t k = 1; k < table.t.size(); ++k) largest = std::max(largest, std::abs(slope_of(table, k)));
  return largest;
}

}  // namespace gnomon::planar_beam
