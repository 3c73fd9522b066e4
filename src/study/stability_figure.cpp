#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/output/figure_style.hpp"
#include "src/study/stability_output.hpp"
#include "src/study/vary_output.hpp"

namespace gnomon {
namespace {

constexpr int survived_style = 0;
constexpr int limit_style = 3;

output::Figure drift_figure(const Catalogue& catalogue, const Stability& study) {
  output::Figure figure;
  output::Panel panel;
  const auto style = [&](const SchemeInfo& scheme) {
    const auto found = std::ranges::find(catalogue.schemes, scheme.name, &SchemeInfo::name);
    return static_cast<int>(found - catalogue.schemes.begin());
  };
  figure.title = fmt::format("{}: what large steps do", study.name);
  figure.hollow_note = "hollow: does not survive";
  panel.x_label = "step [s]";
  panel.y_label = "largest drift of an invariant / its scale";
  for (const StabilityScene& on : study.scenes)
    for (const StabilityEntry& entry : on.entries) {
      output::Series series;
      series.label = std::string(entry.scheme->name);
      series.style = style(*entry.scheme);
      for (const StabilityEntry::Point& point : entry.points) {
        series.x.push_back(point.step);
        // Curves end where a result is wrong by orders of magnitude.
        const double drift = largest_drift(on.rows[point.row]).value_or(std::nan(""));
        series.y.push_back(drift < 1e3 ? drift : std::nan(""));
        series.hollow.push_back(!point.failure.empty());
      }
      panel.series.push_back(std::move(series));
    }
  panel.reference_lines.push_back({study.search.survival.max_drift, "limit"});
  figure.panels.push_back(std::move(panel));
  output::settle_styles(figure);
  return figure;
}

/// Every way to fail, in the order in which the runs show them.
std::vector<std::string> failure_kinds(const Stability& study) {
  std::vector<std::string> kinds;
  for (const StabilityScene& on : study.scenes)
    for (const StabilityEntry& entry : on.entries)
      for (const StabilityEntry::Point& point : entry.points)
        if (const std::string kind = failure_kind(point.failure);
            !kind.empty() && std::ranges::find(kinds, kind) == kinds.end())
          kinds.push_back(kind);
  return kinds;
}

std::vector<const SchemeInfo*> schemes_of(const Stability& study) {
  std::vector<const SchemeInfo*> schemes;
  for (const StabilityScene& on : study.scenes)
    for (const StabilityEntry& entry : on.entries)
      if (std::ranges::find(schemes, entry.scheme) == schemes.end()) schemes.push_back(entry.scheme);
  return schemes;
}

/// The places of the values along the axis, with room beside the outer ones: a short line around a place
/// touches none of its neighbours'.
struct Places {
  std::vector<output::Range> around;  ///< one a value
  output::Range all;
};

Places places_of(const output::Panel& panel, const Variation& variation) {
  const auto along = [&](double x) { return panel.log_x ? std::log10(x) : x; };
  const auto back = [&](double u) { return panel.log_x ? std::pow(10.0, u) : u; };
  std::vector<double> sorted;
  for (std::size_t of = 0; of < variation.values.size(); ++of)
    if (const double u = along(varied_x(variation, of)); std::isfinite(u)) sorted.push_back(u);
  std::ranges::sort(sorted);
  double gap = HUGE_VAL;
  for (std::size_t k = 1; k < sorted.size(); ++k)
    if (sorted[k] > sorted[k - 1]) gap = std::min(gap, sorted[k] - sorted[k - 1]);
  if (sorted.empty()) sorted.push_back(0.0);
  // Values that lie close together among others: still a line that can be seen.
  gap = std::isfinite(gap) ? std::max(gap, 0.02 * (sorted.back() - sorted.front())) : 1.0;
  Places places;
  for (std::size_t of = 0; of < variation.values.size(); ++of) {
    const double u = along(varied_x(variation, of));
    places.around.push_back({back(u - 0.4 * gap), back(u + 0.4 * gap)});
  }
  const double beside = std::max(0.45 * gap, 0.03 * (sorted.back() - sorted.front()));
  places.all = {back(sorted.front() - beside), back(sorted.back() + beside)};
  return places;
}

output::Panel map_panel(const Stability& study, const SchemeInfo& scheme,
                        const std::vector<std::string>& kinds) {
  output::Panel panel = varied_panel(*study.variation);
  panel.title = std::string(scheme.name);
  panel.y_label = "step [s]";
  const Places places = places_of(panel, *study.variation);
  panel.x_range = places.all;
  for (std::size_t of = 0; of < study.variation->values.size(); ++of)
    if (panel.log_x && !(varied_x(*study.variation, of) > 0.0)) panel.x_label += " (0 left out)";
  std::vector<output::Series> all(kinds.size() + 1);
  for (std::size_t k = 0; k < all.size(); ++k) {
    all[k].label = k == 0 ? "survives" : kinds[k - 1];
    // That of the limit is black: no kind of failure has it.
    const int style = static_cast<int>(k);
    all[k].style = k == 0 ? survived_style : style < limit_style ? style : style + 1;
    all[k].marks_only = true;
  }
  for (std::size_t of = 0; of < study.scenes.size(); ++of)
    for (const StabilityEntry& entry : study.scenes[of].entries) {
      if (entry.scheme != &scheme) continue;
      for (const StabilityEntry::Point& point : entry.points) {
        const auto kind = std::ranges::find(kinds, failure_kind(point.failure)) - kinds.begin();
        output::Series& series = all[point.failure.empty() ? 0 : static_cast<std::size_t>(kind) + 1];
        series.x.push_back(varied_x(*study.variation, of));
        series.y.push_back(point.step);
        series.hollow.push_back(!point.failure.empty());
      }
      if (entry.breaking.survived > 0.0)
        panel.levels.push_back({entry.breaking.survived, places.around[of], limit_style});
    }
  for (output::Series& series : all)
    if (!series.x.empty()) panel.series.push_back(std::move(series));
  return panel;
}

}  // namespace

output::Figure stability_figure(const Catalogue& catalogue, const Stability& study) {
  if (!study.variation) return drift_figure(catalogue, study);
  output::Figure figure;
  figure.title = fmt::format("{}: what survives over step and {}", study.name, study.variation->key);
  figure.hollow_note = "hollow: does not survive";
  figure.floor_note = "dotted: largest step below which all survive";
  const std::vector<std::string> kinds = failure_kinds(study);
  for (const SchemeInfo* scheme : schemes_of(study))
    figure.panels.push_back(map_panel(study, *scheme, kinds));
  return figure;
}

}  // namespace gnomon
