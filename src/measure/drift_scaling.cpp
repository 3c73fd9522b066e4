#include "src/measure/drift_scaling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
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

bool may_be_biased_rounding(const DriftAtStep& run) {
  switch (run.drift.verdict) {
    case DriftVerdict::secular:
    case DriftVerdict::bounded:
    case DriftVerdict::undecided:
      return run.drift.max_abs <= std::numeric_limits<double>::epsilon() * run.evaluations;
    default:
      return false;
  }
}

void tell_rounding(std::span<DriftAtStep> runs) {
  std::vector<DriftAtStep*> order;
  for (DriftAtStep& run : runs) order.push_back(&run);
  std::ranges::stable_sort(order, std::ranges::greater{}, [](const DriftAtStep* run) { return run->step; });
  std::vector<DriftAtStep*> found;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto finer =
        std::find_if(order.begin() + static_cast<std::ptrdiff_t>(k), order.end(),
                     [&](const DriftAtStep* run) { return run->step <= 0.75 * order[k]->step; });
    if (finer == order.end() || !may_be_biased_rounding(*order[k])) continue;
    const DriftVerdict verdict = (*finer)->drift.verdict;
    const bool is_rounding = verdict == DriftVerdict::roundoff || verdict == DriftVerdict::newton ||
                             may_be_biased_rounding(**finer);
    if (!is_rounding || (*finer)->drift.max_abs < 0.7 * order[k]->drift.max_abs) continue;
    found.push_back(order[k]);
    if (verdict != DriftVerdict::roundoff) found.push_back(*finer);
  }
  for (DriftAtStep* run : found)
    run->drift.verdict = run->iterates ? DriftVerdict::newton : DriftVerdict::roundoff;
}

}  // namespace gnomon
