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
    if (invariant.initial.empty()) continue;  // not constant at any time of the run
    has_energy = has_energy || invariant.info.name == "energy";
    if (!(invariant.max_drift <= survival.max_drift))
      return fmt::format("{} off by {:.1g}", invariant.info.name,
                         std::isfinite(invariant.max_drift) ? invariant.max_drift : std::nan(""));
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
    if (invariant.initial.empty()) continue;
    if (!largest || !(invariant.max_drift <= *largest)) largest = invariant.max_drift;
  }
  return largest;
}

void BreakingSearch::take(double step, Row row) {
  Trial trial{step, failure_of(scene_, row, search_.survival), std::move(row)};
  const bool beyond = breaking_.breaks && step > *breaking_.breaks;
  if (trial.failure.empty() && !beyond) breaking_.survived = step;
  if (!trial.failure.empty() && !beyond) {
    breaking_.breaks = step;
    breaking_.how = trial.failure;
    breaking_.status = trial.row.result.status;
    breaking_.message = trial.row.result.message;
    breaking_.t = trial.row.result.t;
  }
  breaking_.trials.push_back(std::move(trial));
}

bool BreakingSearch::is_open() const { return breaking_.breaks && !is_cut_short(breaking_.status); }

std::vector<double> BreakingSearch::next() {
  const auto rung = [&] { return search_.first * std::exp2(begun_++); };
  if (begun_ < search_.count && search_.whole) {
    std::vector<double> ladder;
    while (begun_ < search_.count) ladder.push_back(rung());
    return ladder;
  }
  if (begun_ < search_.count && !breaking_.breaks) return {rung()};
  if (!is_open()) return {};
  if (breaking_.survived == 0.0) {
    smaller_ = 0.25 * smaller_.value_or(search_.first);
    if (search_.lowest > 0.0 && *smaller_ >= search_.lowest) return {*smaller_};
    return {};
  }
  if (!(*breaking_.breaks > search_.resolution * (1.0 + 1e-9) * breaking_.survived)) return {};
  const double middle = whole_part(scene_.t_end, std::sqrt(breaking_.survived * *breaking_.breaks));
  if (!(middle > breaking_.survived && middle < *breaking_.breaks)) return {};
  return {middle};
}

Breaking BreakingSearch::result() && {
  std::ranges::sort(breaking_.trials, {}, &Trial::step);
  return std::move(breaking_);
}

std::vector<std::optional<Breaking>> find_breakings(Runner& runner, const Scene& scene,
                                                    const ReferenceStates& reference,
                                                    const std::vector<const SchemeInfo*>& schemes,
                                                    const StepSearch& search, const StudyOptions& options,
                                                    const std::function<void(const SchemeInfo&)>& begin) {
  std::vector<std::optional<Breaking>> found(schemes.size());
  const std::size_t together = runner.jobs() > 1 ? std::max<std::size_t>(1, schemes.size()) : 1;
  for (std::size_t from = 0; from < schemes.size(); from += together) {
    const std::size_t to = std::min(from + together, schemes.size());
    std::vector<BreakingSearch> searches(to - from, BreakingSearch(scene, search));
    std::vector<bool> begun(searches.size(), false);
    while (!runner.stopped()) {
      std::vector<RunPlan> plans;
      std::vector<std::size_t> owners;
      for (std::size_t k = 0; k < searches.size(); ++k)
        for (const double step : searches[k].next()) {
          plans.push_back({schemes[from + k], {step, std::nullopt}});
          owners.push_back(k);
        }
      if (plans.empty()) break;
      std::vector<Row> rows = runner.run_each(scene, reference, plans, options, [&](const RunPlan& plan) {
        const auto k = static_cast<std::size_t>(std::ranges::find(schemes, plan.scheme) - schemes.begin());
        if (!begun[k - from]) begin(*plan.scheme);
        begun[k - from] = true;
      });
      for (std::size_t k = 0; k < rows.size(); ++k)
        searches[owners[k]].take(*plans[k].setting.step, std::move(rows[k]));
    }
    if (runner.stopped()) break;
    for (std::size_t k = 0; k < searches.size(); ++k) found[from + k] = std::move(searches[k]).result();
  }
  return found;
}

}  // namespace gnomon
