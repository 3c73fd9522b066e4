#include "src/study/breaking.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace gnomon {
namespace {

/// Ended by a limit or the user: it says nothing about the step.
bool is_cut_short(Status status) {
  return status == Status::step_limit || status == Status::time_limit || status == Status::interrupted;
}

bool has_survived(const Trial& trial) { return trial.failure.empty(); }
bool has_failed(const Trial& trial) {
  return !trial.failure.empty() && !is_cut_short(trial.row.result.status);
}

/// The scene run to another time.
Scene until(const Scene& scene, double t_end) {
  Scene changed = scene;
  if (t_end != scene.t_end) changed.resolved["t_end"] = changed.t_end = t_end;
  return changed;
}

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

std::string failure_kind(const std::string& failure) { return failure.substr(0, failure.find(" by ")); }

bool keeps_energy(const Scene& scene) {
  return std::ranges::any_of(scene.model->invariant_info(), [&](const InvariantInfo& info) {
    return info.name == "energy" && info.since < scene.t_end;
  });
}

double horizon(double t_end, double step) {
  double end = t_end;
  while (end < (1.0 - 1e-9) * fewest_steps * step) end *= 2.0;
  return end;
}

std::string survival_line(const Survival& survival) {
  return fmt::format(
      "a step survives if the run, of {:g} steps or more, ends well, every state finite, and no invariant is "
      "off by more than {:g} of its scale at 256 jittered times; where no energy is constant, also no error "
      "at the end of the scene above {:g} of that of a result that is wrong altogether; where one is, the "
      "path "
      "is not looked at",
      fewest_steps, survival.max_drift, survival.max_error);
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
  std::string failure = failure_of(scene_, row, search_.survival);
  take(step, std::move(row), std::move(failure));
}

void BreakingSearch::take(double step, Row row, std::string failure) {
  const auto place = std::ranges::upper_bound(trials_, step, {}, &Trial::step);
  trials_.insert(place, Trial{step, std::move(failure), std::move(row)});
}

BreakingSearch::Bracket BreakingSearch::bracket() const {
  Bracket found;
  for (const Trial& trial : trials_) {
    if (has_failed(trial)) {
      found.fails = &trial;
      break;
    }
    if (has_survived(trial)) found.survived = &trial;
  }
  return found;
}

bool BreakingSearch::is_tried(double step) const {
  return std::ranges::any_of(trials_,
                             [&](const Trial& trial) { return std::abs(trial.step - step) <= 1e-9 * step; });
}

/// The nearest step that divides its run into equal parts.
double BreakingSearch::whole_part(double step) const {
  const double end = horizon(t_end_, step);
  return end / std::round(end / step);
}

std::vector<double> BreakingSearch::descend(double survived) const {
  const StepSearch::Descent& descent = search_.descent;
  if (descent.near < 1 || trials_.size() >= static_cast<std::size_t>(descent.at_most)) return {};
  double least = search_.lowest;
  for (const Trial& trial : trials_)
    if (trial.step < survived && is_cut_short(trial.row.result.status)) least = std::max(least, trial.step);
  const double near = descent.near, from = std::log2(survived / search_.first);
  const int stride = descent.near / descent.far;
  std::vector<double> steps;
  double place = from;
  for (int k = static_cast<int>(std::ceil(from * near)) + 1; place > from - descent.octaves; --k) {
    if (k % stride != 0 && place <= from - 1.0) continue;
    // Multiples of the golden section: no two of the grid's steps have a ratio that others have.
    const double turns = k * 0.6180339887498949;
    place = (k + 0.6 * (turns - std::floor(turns) - 0.5)) / near;
    const double step = whole_part(search_.first * std::exp2(place));
    if (step >= survived * (1.0 - 1e-9) || is_tried(step)) continue;
    if (std::ranges::find(steps, step) != steps.end()) continue;
    // An octave at a time: what a limit ends there need not be tried with smaller steps.
    if (step <= least || (!steps.empty() && step < 0.5 * steps.front())) break;
    steps.push_back(step);
  }
  return steps;
}

std::vector<double> BreakingSearch::next() {
  const auto rung = [&] { return search_.first * std::exp2(begun_++); };
  const auto [survived, fails] = bracket();
  if (begun_ < search_.count && search_.whole) {
    std::vector<double> ladder;
    while (begun_ < search_.count) ladder.push_back(rung());
    return ladder;
  }
  if (begun_ < search_.count && !fails) return {rung()};
  if (!survived) {
    if (!fails || is_cut_short(trials_.front().row.result.status)) return {};
    const double smaller = whole_part(0.25 * fails->step);
    if (search_.lowest > 0.0 && smaller >= search_.lowest) return {smaller};
    return {};
  }
  if (fails && fails->step > search_.resolution * (1.0 + 1e-9) * survived->step) {
    const double middle = whole_part(std::sqrt(survived->step * fails->step));
    if (middle > survived->step && middle < fails->step && !is_tried(middle)) return {middle};
  }
  return descend(survived->step);
}

Breaking BreakingSearch::result() && {
  Breaking breaking;
  const Bracket found = bracket();
  const Trial* beyond = found.fails;
  // Nothing but limits.
  if (!found.survived && !beyond && !trials_.empty()) beyond = &trials_.front();
  if (found.survived) breaking.survived = found.survived->step;
  if (beyond) {
    breaking.breaks = beyond->step;
    breaking.how = beyond->failure;
    breaking.status = beyond->row.result.status;
    breaking.message = beyond->row.result.message;
    breaking.t = beyond->row.result.t;
  }
  for (const Trial& trial : trials_) {
    if (is_cut_short(trial.row.result.status)) continue;
    if (breaking.tried++ == 0) breaking.down_to = trial.step;
    if (beyond && trial.step > beyond->step && has_survived(trial)) breaking.again = trial.step;
  }
  breaking.trials = std::move(trials_);
  return breaking;
}

namespace {

/// A scheme and a step, and whose.
struct Asked {
  RunPlan plan;
  std::size_t owner;
};

/// Every step to its horizon; the rows in the order of `asked`, fewer if the user interrupts.
class HorizonRuns {
 public:
  HorizonRuns(Runner& runner, const Scene& scene, const ReferenceStates& reference,
              const StudyOptions& options, const std::function<void(const RunPlan&)>& begin)
      : runner_(runner), scene_(scene), reference_(reference), options_(options), begin_(begin) {}

  void run(const std::vector<Asked>& asked, const Survival& survival, std::vector<BreakingSearch>& searches) {
    std::map<double, std::vector<std::size_t>> by_end;
    for (std::size_t k = 0; k < asked.size(); ++k)
      by_end[horizon(scene_.t_end, *asked[k].plan.setting.step)].push_back(k);
    std::vector<std::size_t> again;  // run to the end of the scene, too
    std::vector<std::optional<Row>> rows(asked.size());
    for (const auto& [end, which] : by_end) {
      const bool longer = end != scene_.t_end;
      std::vector<Row> made = run_to(end, asked, which, longer ? ReferenceStates{} : reference_);
      for (std::size_t k = 0; k < made.size(); ++k) {
        rows[which[k]] = std::move(made[k]);
        if (longer && !keeps_energy(scene_) && !reference_.states.empty() &&
            failure_of(scene_, *rows[which[k]], survival).empty())
          again.push_back(which[k]);
      }
    }
    std::vector<std::string> failures(asked.size());
    for (std::size_t k = 0; k < asked.size(); ++k)
      if (rows[k]) failures[k] = failure_of(scene_, *rows[k], survival);
    std::vector<Row> made = run_to(scene_.t_end, asked, again, reference_);
    for (std::size_t k = 0; k < made.size(); ++k) {
      failures[again[k]] = failure_of(scene_, made[k], survival);
      if (!failures[again[k]].empty()) rows[again[k]] = std::move(made[k]);
    }
    for (std::size_t k = 0; k < asked.size(); ++k)
      if (rows[k])
        searches[asked[k].owner].take(*asked[k].plan.setting.step, std::move(*rows[k]), failures[k]);
  }

 private:
  std::vector<Row> run_to(double end, const std::vector<Asked>& asked, const std::vector<std::size_t>& which,
                          const ReferenceStates& reference) {
    if (which.empty() || runner_.stopped()) return {};
    std::vector<RunPlan> plans;
    for (const std::size_t k : which) plans.push_back(asked[k].plan);
    return runner_.run_each(until(scene_, end), reference, plans, options_, begin_);
  }

  Runner& runner_;
  const Scene& scene_;
  const ReferenceStates& reference_;
  const StudyOptions& options_;
  const std::function<void(const RunPlan&)>& begin_;
};

}  // namespace

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
    const std::function<void(const RunPlan&)> begin_plan = [&](const RunPlan& plan) {
      const auto k = static_cast<std::size_t>(std::ranges::find(schemes, plan.scheme) - schemes.begin());
      if (!begun[k - from]) begin(*plan.scheme);
      begun[k - from] = true;
    };
    HorizonRuns runs(runner, scene, reference, options, begin_plan);
    while (!runner.stopped()) {
      std::vector<Asked> asked;
      for (std::size_t k = 0; k < searches.size(); ++k)
        for (const double step : searches[k].next())
          asked.push_back({{schemes[from + k], {step, std::nullopt}}, k});
      if (asked.empty()) break;
      runs.run(asked, search.survival, searches);
    }
    if (runner.stopped()) break;
    for (std::size_t k = 0; k < searches.size(); ++k) found[from + k] = std::move(searches[k]).result();
  }
  return found;
}

}  // namespace gnomon
