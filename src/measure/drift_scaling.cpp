#include "src/measure/drift_scaling.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "src/measure/statistics.hpp"

namespace gnomon {

std::optional<DriftScaling> drift_scaling(std::span<const DriftAtStep> runs) {
  const auto count = [&](DriftVerdict verdict) {
    return std::ranges::count_if(runs, [&](const DriftAtStep& run) { return run.drift.verdict == verdict; });
  };
  constexpr double floor = 1e-11;
  DriftScaling scaling;
  scaling.of_slope = count(DriftVerdict::secular) > count(DriftVerdict::bounded);
  std::vector<double> steps, drifts;
  for (const DriftAtStep& run : runs) {
    if (run.drift.verdict != (scaling.of_slope ? DriftVerdict::secular : DriftVerdict::bounded)) continue;
    const double size = scaling.of_slope ? std::abs(run.drift.slope) : run.drift.max_abs;
    if (run.drift.max_abs <= floor) continue;
    if (scaling.of_slope && std::abs(run.drift.slope) <= 3.0 * run.drift.slope_error) continue;
    if (!(run.step > 0.0) || !(size > 0.0) || !std::isfinite(size)) continue;
    steps.push_back(std::log(run.step));
    drifts.push_back(std::log(size));
  }
  if (std::set<double>(steps.begin(), steps.end()).size() < 3) return std::nullopt;
  scaling.points = static_cast<int>(steps.size());
  scaling.exponent = theil_sen_slope(steps, drifts);
  if (std::isnan(scaling.exponent)) return std::nullopt;
  return scaling;
}

}  // namespace gnomon
