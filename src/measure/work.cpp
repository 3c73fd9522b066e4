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
  std::optional<LevelCost> least;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    double envelope = 0.0;  // largest error of the settings that have to reach the level
    bool counts = true;
    for (std::size_t k = i; k < std::min(i + 3, curve.size()); ++k) {
      counts = counts && usable(curve[k]) && curve[k].error <= error;
      envelope = std::max(envelope, curve[k].error);
    }
    if (!counts) continue;
    LevelCost found{curve[i].cost, i == 0, i + 3 > curve.size()};
    if (i > 0 && !(curve[i - 1].error <= error)) {
      const WorkPoint& looser = curve[i - 1];
      if (positive(envelope) && positive(looser.error) && positive(found.cost) && positive(looser.cost)) {
        const double part = std::log(error / envelope) / std::log(looser.error / envelope);
        found.cost = std::min(found.cost, found.cost * std::pow(looser.cost / found.cost, part));
      } else {
        found.upper_bound = true;
      }
    }
    if (!least || found.cost < least->cost) least = found;
  }
  return least;
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
