#include "src/study/breaking.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gnomon {
namespace {

/// Ended by a limit or the user: it says nothing about the step.
bool is_cut_short(Status status) {
  return status == Status::step_limit || status == Status::time_limit || status == Status::interrupted;
}

/// The nearest step that divides the run into equal parts.
double whole_part(double t_end, double step) { return t_end / std::max(1.0, std::round(t_end / step)); }

}  // namespace

std::string failure_of(const Scene& scene, const Row& row, const Survival& survival) {
  if (row.result.status != Status::ok) return std::string(to_string(row.result.status));
  bool has_energy = false;
  for (const InvariantSummary& invariant : row.invariants) {
    if (invariant.times.empty()) continue;
    has_energy = has_energy || invariant.info.name == "energy";
    if (!(invariant.max_drift <= survival.max_drift))
      return fmt::format("{} off by {:.1g}", invariant.info.name, invariant.max_drift);
  }
  if (has_energy) return "";
  const std::vector<MetricInfo> metrics = scene.model->metrics();
  for (std::size_t k = 0; k < row.error.size(); ++k)
    if (std::isfinite(metrics[k].saturation) && !(row.error[k] <= survival.max_error * metrics[k].saturation))
      return fmt::format("{} wrong by {:.2g} {}", metrics[k].name, row.error[k],
                         metrics[k].unit == "1" ? "of its size" : metrics[k].unit);
  return "";
}

std::string survival_line(const Survival& survival) {
  return fmt::format(
      "a step survives if the run ends well, every state finite, and no invariant is off by more than {:g} "
      "of its scale at 256 jittered times; where no energy is constant, also no error at the end above {:g} "
      "of "
      "that of a result that is wrong altogether",
      survival.max_drift, survival.max_error);
}

std::optional<double> largest_drift(const Row& row) {
  std::optional<double> largest;
  for (const InvariantSummary& invariant : row.invariants) {
    if (invariant.times.empty()) continue;
    if (!largest || !(invariant.max_drift <= *largest)) largest = invariant.max_drift;
  }
  return largest;
}

Breaking find_breaking(Runner& runner, const Scene& scene, const ReferenceStates& reference,
                       const SchemeInfo& scheme, const StepSearch& search, const StudyOptions& options) {
  Breaking breaking;
  const auto survives = [&](double step) {
    Setting setting;
    setting.step = step;
    Trial trial{step, "", runner.run(scene, reference, scheme, setting, options)};
    trial.failure = failure_of(scene, trial.row, search.survival);
    const bool good = trial.failure.empty();
    if (good && !(breaking.breaks && step > *breaking.breaks)) breaking.survived = step;
    if (!good && !(breaking.breaks && step > *breaking.breaks)) {
      breaking.breaks = step;
      breaking.how = trial.failure;
      breaking.status = trial.row.result.status;
      breaking.message = trial.row.result.message;
      breaking.t = trial.row.result.t;
    }
    breaking.trials.push_back(std::move(trial));
    return good;
  };
  for (int k = 0; k < search.count && !runner.stopped(); ++k)
    if (!survives(search.first * std::pow(2.0, k)) && !search.whole) break;
  if (breaking.survived == 0.0 && breaking.breaks && !is_cut_short(breaking.status))
    for (double step = 0.25 * search.first; search.lowest > 0.0 && step >= search.lowest; step *= 0.25)
      if (runner.stopped() || survives(step) || is_cut_short(breaking.status)) break;
  while (breaking.survived > 0.0 && breaking.breaks && !is_cut_short(breaking.status) && !runner.stopped() &&
         *breaking.breaks > search.resolution * (1.0 + 1e-9) * breaking.survived) {
    const double middle = whole_part(scene.t_end, std::sqrt(breaking.survived * *breaking.breaks));
    if (!(middle > breaking.survived && middle < *breaking.breaks)) break;
    survives(middle);
  }
  std::ranges::sort(breaking.trials, {}, &Trial::step);
  return breaking;
}

}  // namespace gnomon
