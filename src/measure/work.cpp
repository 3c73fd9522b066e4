#include "src/measure/work.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace gnomon {
namespace {

bool positive(double x) { return std::isfinite(x) && x > 0.0; }

bool usable(const WorkPoint& point) { return std::isfinite(point.error) && std::isfinite(point.cost); }

}  // namespace

std::optional<LevelSetting> level_setting(std::span<const WorkPoint> curve, double error) {
  std::optional<LevelSetting> best;
  double least = 0.0;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    double envelope = 0.0;  // largest error of the settings that have to reach the level
    bool counts = true;
    for (std::size_t k = i; k < std::min(i + 3, curve.size()); ++k) {
      counts = counts && usable(curve[k]) && curve[k].error <= error;
      envelope = std::max(envelope, curve[k].error);
    }
    if (!counts) continue;
    LevelSetting found{i, 0.0, i == 0, i + 3 > curve.size()};
    double cost = curve[i].cost;
    if (i > 0 && !(curve[i - 1].error <= error)) {
      const WorkPoint& looser = curve[i - 1];
      if (positive(envelope) && positive(looser.error) && positive(cost) && positive(looser.cost)) {
        if (looser.cost < cost) {
          found.looser_part = std::log(error / envelope) / std::log(looser.error / envelope);
          cost *= std::pow(looser.cost / cost, found.looser_part);
        }
      } else {
        found.upper_bound = true;
      }
    }
    if (!best || cost < least) best = found, least = cost;
  }
  return best;
}

LevelCost cost_there(const LevelSetting& setting, std::span<const double> costs) {
  const double own = costs[setting.place];
  if (!(setting.looser_part > 0.0)) return {own, setting.upper_bound, setting.few};
  return {own * std::pow(costs[setting.place - 1] / own, setting.looser_part), setting.upper_bound,
          setting.few};
}

std::optional<LevelCost> level_cost(std::span<const WorkPoint> curve, double error) {
  const auto setting = level_setting(curve, error);
  if (!setting) return std::nullopt;
  std::vector<double> costs;
  for (const WorkPoint& point : curve) costs.push_back(point.cost);
  return cost_there(*setting, costs);
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
