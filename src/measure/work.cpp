#include "src/measure/work.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace gnomon {
namespace {

bool positive(double x) { return std::isfinite(x) && x > 0.0; }

bool usable(const WorkPoint& point) { return std::isfinite(point.error) && std::isfinite(point.cost); }

}  // namespace

std::optional<LevelCost> level_cost(std::span<const WorkPoint> curve, double error) {
  std::size_t first = curve.size();  // the loosest setting that counts
  double envelope = 0.0;             // largest error of the settings that count
  while (first > 0 && usable(curve[first - 1]) && curve[first - 1].error <= error) {
    --first;
    envelope = std::max(envelope, curve[first].error);
  }
  if (first == curve.size()) return std::nullopt;
  const double cost = curve[first].cost;
  if (first == 0) return LevelCost{cost, true};
  const WorkPoint& looser = curve[first - 1];
  if (!positive(envelope) || !positive(looser.error) || !positive(cost) || !positive(looser.cost))
    return LevelCost{cost, true};
  const double part = std::log(error / envelope) / std::log(looser.error / envelope);
  return LevelCost{cost * std::pow(looser.cost / cost, part), false};
}

std::optional<double> cost_at(std::span<const WorkPoint> curve, double error) {
  const auto found = level_cost(curve, error);
  return found ? std::optional(found->cost) : std::nullopt;
}

std::vector<bool> pareto_front(std::span<const WorkPoint> points) {
  const auto beats = [](const WorkPoint& a, const WorkPoint& b) {
    return a.error <= b.error && a.cost <= b.cost && (a.error < b.error || a.cost < b.cost);
  };
  std::vector<bool> front;
  for (const WorkPoint& point : points) {
    const bool beaten =
        std::ranges::any_of(points, [&](const WorkPoint& other) { return beats(other, point); });
    front.push_back(usable(point) && !beaten);
  }
  return front;
}

}  // namespace gnomon
