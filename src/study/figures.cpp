#include "src/study/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/output/figure_style.hpp"
#include "src/study/present.hpp"

namespace gnomon {
namespace {

constexpr double most_drift_drawn = 10.0;  ///< that is drawn, of the invariant's scale
constexpr double least_drift_drawn = std::numeric_limits<double>::epsilon();
constexpr const char* bound_note = "hollow: at or below the bound of the reference";

/// Series of one quantity against another over the rows of one scheme; what lies at the bound is hollow.
template <class X>
output::Series series(const Catalogue& catalogue, const SceneStudy& study, const SchemeInfo& scheme,
                      X&& x_of) {
  output::Series series;
  series.label = std::string(scheme.name);
  series.style = style_of_scheme(catalogue, scheme);
  for (const Row& row : study.rows) {
    if (row.scheme != &scheme || row.error.empty()) continue;
    series.x.push_back(x_of(row));
    series.y.push_back(row.error[0]);
    series.hollow.push_back(row.below_bound[0]);
  }
  return series;
}

bool failed_run(const Row& row) {
  return row.result.status != Status::ok && row.result.status != Status::interrupted;
}

double step_of(const Row& row) {
  return row.result.step ? *row.result.step : row.setting.step.value_or(std::nan(""));
}

double tol_of(const Row& row) { return row.setting.tol.value_or(std::nan("")); }

/// Failed runs of one scheme; `x_of` gives their place, not a number where it is not known.
template <class X>
void add_failures(output::Panel& panel, const Catalogue& catalogue, const SceneStudy& study,
                  const SchemeInfo& scheme, X&& x_of) {
  for (const Row& row : study.rows)
    if (row.scheme == &scheme && failed_run(row))
      panel.failures.push_back(
          {x_of(row), style_of_scheme(catalogue, scheme),
           fmt::format("{}, {}: {}", scheme.name, row.setting.text(), to_string(row.result.status))});
}

std::vector<const SchemeInfo*> schemes_of(const SceneStudy& study) {
  std::vector<const SchemeInfo*> schemes;
  for (const Row& row : study.rows)
    if (std::find(schemes.begin(), schemes.end(), row.scheme) == schemes.end()) schemes.push_back(row.scheme);
  return schemes;
}

/// How many runs have a cross, and whose they are: "7 runs failed: beam-hht 4, beam-bathe 3".
template <class Crossed>
std::string crosses_note(const SceneStudy& study, std::string_view what, Crossed&& crossed) {
  constexpr std::size_t most_named = 6;
  std::vector<std::pair<std::string_view, int>> counts;
  int all = 0;
  for (const SchemeInfo* scheme : schemes_of(study)) {
    const auto count = static_cast<int>(std::ranges::count_if(
        study.rows, [&](const Row& row) { return row.scheme == scheme && crossed(row); }));
    if (count > 0) counts.emplace_back(scheme->name, count);
    all += count;
  }
  if (all == 0) return "";
  std::ranges::stable_sort(counts, [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text = fmt::format("{} run{} {}:", all, all == 1 ? "" : "s", what);
  int others = 0;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (k < most_named)
      // A no-break space, so that a number stays with its name.
      text += fmt::format("{} {}\u00a0{}", k == 0 ? "" : ",", counts[k].first, counts[k].second);
    else
      others += counts[k].second;
  }
  return others > 0 ? fmt::format("{}, others {}", text, others) : text;
}

/// Of a figure with one cross for each failed run.
std::string failure_note(const SceneStudy& study, const std::vector<output::Panel>& panels) {
  std::string note = crosses_note(study, "failed", failed_run);
  const bool unknown = std::ranges::any_of(panels, [](const output::Panel& panel) {
    return std::ranges::any_of(panel.failures, [](const auto& each) { return std::isnan(each.x); });
  });
  if (unknown) note += "; at the left edge: cost not known";
  return note;
}

void add_bound(output::Panel& panel, const SceneStudy& study) {
  if (!study.reference.bounds.empty())
    panel.reference_lines.push_back({study.reference.bounds.back()[0], "bound of the reference"});
}

std::string error_label(const SceneStudy& study) {
  const MetricInfo metric = study.scene.model->metrics()[0];
  return fmt::format("{} error at t = {:g} s [{}]", metric.name, study.scene.t_end, metric.unit);
}

template <class X>
void add_front(output::Panel& panel, const SceneStudy& study, const std::vector<bool>& front, X&& x_of) {
  if (front.size() != study.rows.size()) return;  // interrupted
  for (std::size_t k = 0; k < front.size(); ++k)
    if (front[k] && !study.rows[k].error.empty())
      panel.front.push_back({x_of(study.rows[k]), study.rows[k].error[0]});
}

/// The largest |drift| of one invariant in every run against its step or tolerance.
output::Figure drift_ladder_figure(const Catalogue& catalogue, const DriftStudy& study,
                                   const std::string& invariant) {
  output::Figure figure;
  figure.title = fmt::format("{}, {}", study.scene.name, invariant);
  figure.hollow_note = "hollow: at or below roundoff";
  const std::string y_label =
      fmt::format("largest |{} drift| / scale, t ≤ {:g} s", invariant, study.scene.t_end);
  output::Panel steps{.title = "", .x_label = "step [s]", .y_label = y_label};
  output::Panel tols{.title = "", .x_label = "tolerance", .y_label = y_label};
  std::vector<double> drifts(study.rows.size(), std::nan(""));
  for (const DriftRow& row : study.drifts)
    if (row.invariant.info.name == invariant) drifts[row.row] = row.drift.max_abs;
  const auto too_large = [&](const Row& row) {
    const auto k = static_cast<std::size_t>(&row - study.rows.data());
    return !failed_run(row) && drifts[k] > most_drift_drawn;
  };
  for (const SchemeInfo* scheme : schemes_of(study)) {
    if (scheme->stepping == Stepping::closed_form) continue;
    const bool fixed = scheme->stepping == Stepping::fixed;
    output::Panel& panel = fixed ? steps : tols;
    const auto x_of = fixed ? step_of : tol_of;
    output::Series series;
    series.label = std::string(scheme->name);
    series.style = style_of_scheme(catalogue, *scheme);
    for (std::size_t k = 0; k < study.rows.size(); ++k) {
      const Row& row = study.rows[k];
      if (row.scheme != scheme) continue;
      const bool drawn = row.result.status == Status::ok && drifts[k] <= most_drift_drawn;
      series.x.push_back(x_of(row));
      series.y.push_back(drawn ? std::max(drifts[k], least_drift_drawn) : std::nan(""));
      series.hollow.push_back(drawn && drifts[k] <= least_drift_drawn);
      if (too_large(row))
        panel.failures.push_back(
            {x_of(row), series.style,
             fmt::format("{}, {}: drift {:.2g}", scheme->name, row.setting.text(), drifts[k])});
    }
    panel.series.push_back(std::move(series));
    add_failures(panel, catalogue, study, *scheme, x_of);
  }
  figure.failure_note =
      crosses_note(study, fmt::format("failed or drifted by more than {:g}", most_drift_drawn),
                   [&](const Row& row) { return failed_run(row) || too_large(row); });
  for (output::Panel* panel : {&steps, &tols})
    if (!panel->series.empty()) figure.panels.push_back(std::move(*panel));
  output::settle_styles(figure);
  return figure;
}

}  // namespace

output::Figure convergence_figure(const Catalogue& catalogue, const Convergence& study) {
  output::Figure figure;
  figure.title = study.scene.name;
  figure.hollow_note = bound_note;
  output::Panel steps{.title = "fixed step", .x_label = "step [s]", .y_label = error_label(study)};
  output::Panel tols{.title = "adaptive", .x_label = "tolerance", .y_label = error_label(study)};
  for (const SchemeInfo* scheme : schemes_of(study)) {
    const auto add = [&](output::Panel& panel, const auto& x_of) {
      panel.series.push_back(series(catalogue, study, *scheme, x_of));
      add_failures(panel, catalogue, study, *scheme, x_of);
    };
    if (scheme->stepping == Stepping::fixed) add(steps, step_of);
    if (scheme->stepping == Stepping::adaptive) add(tols, tol_of);
  }
  figure.floor_note = "dotted: floor";
  const MetricInfo shown = study.scene.model->metrics()[0];
  for (const OrderRow& row : study.orders)
    if (row.floor && row.metric == shown.name)
      steps.levels.push_back({row.floor->level,
                              {row.floor->step_to, row.floor->step_from},
                              style_of_scheme(catalogue, *row.scheme)});
  std::vector<double> declared;
  for (const OrderRow& row : study.orders)
    if (row.expected && std::find(declared.begin(), declared.end(), *row.expected) == declared.end())
      declared.push_back(*row.expected);
  for (double order : declared) steps.guides.push_back({order, fmt::format("order {:g}", order)});
  for (output::Panel* panel : {&steps, &tols}) {
    if (panel->series.empty()) continue;
    add_bound(*panel, study);
    figure.panels.push_back(*panel);
  }
  figure.failure_note = failure_note(study, figure.panels);
  output::settle_styles(figure);
  return figure;
}

output::Figure work_precision_figure(const Catalogue& catalogue, const Comparison& study) {
  output::Figure figure;
  figure.title = study.scene.name;
  figure.hollow_note = bound_note;
  figure.front_note = "Pareto front";
  output::Panel time{.title = "CPU time", .x_label = "CPU time [s]", .y_label = error_label(study)};
  output::Panel rates{
      .title = "evaluations", .x_label = "evaluations of the rates", .y_label = error_label(study)};
  const auto seconds = [](const Row& row) { return row.timing ? row.timing->median : std::nan(""); };
  const auto evaluations = [](const Row& row) { return static_cast<double>(row.evaluations()); };
  // A run that failed was not repeated: the time of its only one. Nothing is known of one that crashed.
  const auto seconds_spent = [](const Row& row) {
    return row.result.cpu_seconds > 0.0 ? row.result.cpu_seconds : std::nan("");
  };
  const auto evaluations_spent = [](const Row& row) {
    return row.evaluations() > 0 ? static_cast<double>(row.evaluations()) : std::nan("");
  };
  for (const SchemeInfo* scheme : schemes_of(study)) {
    time.series.push_back(series(catalogue, study, *scheme, seconds));
    for (const Row& row : study.rows)
      if (row.scheme == scheme && !row.error.empty())
        time.series.back().x_bars.push_back(row.timing ? output::Range{row.timing->min, row.timing->max}
                                                       : output::Range{0.0, 0.0});
    rates.series.push_back(series(catalogue, study, *scheme, evaluations));
    add_failures(time, catalogue, study, *scheme, seconds_spent);
    add_failures(rates, catalogue, study, *scheme, evaluations_spent);
  }
  add_front(time, study, study.front_in_time, seconds);
  add_front(rates, study, study.front_in_evaluations, evaluations);
  add_bound(time, study);
  add_bound(rates, study);
  const bool timed =
      std::any_of(study.rows.begin(), study.rows.end(), [](const Row& row) { return row.timing; });
  if (timed) figure.panels.push_back(time);
  figure.panels.push_back(rates);
  figure.failure_note = failure_note(study, figure.panels);
  output::settle_styles(figure);
  return figure;
}

output::Figure drift_figure(const Catalogue& catalogue, const DriftStudy& study,
                            const std::string& invariant) {
  if (study.has_ladder()) return drift_ladder_figure(catalogue, study, invariant);
  output::Figure figure;
  figure.title = fmt::format("{}, {}", study.scene.name, invariant);
  output::Panel panel{.title = "",
                      .x_label = "time [s]",
                      .y_label = fmt::format("|{} drift| / scale, running maximum", invariant)};
  std::vector<const Row*> crossed;
  for (const DriftRow& row : study.drifts) {
    if (row.invariant.info.name != invariant) continue;
    const Row& run = study.rows[row.row];
    output::Series series;
    series.label = std::string(run.scheme->name);
    series.style = style_of_scheme(catalogue, *run.scheme);
    // Twelve points a decade of the running maximum are enough to see growth.
    double largest = 0.0, next = 0.0, left = std::nan("");
    for (std::size_t k = 0; k < row.invariant.times.size() && std::isnan(left); ++k) {
      largest = std::max(largest, std::abs(row.invariant.drift[k]));
      const double t = row.invariant.times[k];
      if (largest > most_drift_drawn) left = t;
      if (t <= 0.0 || !std::isnan(left) || (t < next && k + 1 < row.invariant.times.size())) continue;
      series.x.push_back(t);
      series.y.push_back(largest);
      next = t * std::pow(10.0, 1.0 / 12.0);
    }
    panel.series.push_back(std::move(series));
    if (std::isnan(left) && !failed_run(run)) continue;
    crossed.push_back(&run);
    panel.failures.push_back(
        {std::isnan(left) ? run.result.t : left, panel.series.back().style,
         fmt::format("{}: {}", run.scheme->name,
                     failed_run(run) ? std::string(to_string(run.result.status))
                                     : fmt::format("drift beyond {:g}", most_drift_drawn))});
  }
  figure.failure_note =
      crosses_note(study, fmt::format("failed or drifted by more than {:g}", most_drift_drawn),
                   [&](const Row& row) { return std::ranges::find(crossed, &row) != crossed.end(); });
  figure.panels.push_back(std::move(panel));
  output::settle_styles(figure);
  return figure;
}

}  // namespace gnomon
