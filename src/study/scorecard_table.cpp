#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "src/study/present.hpp"
#include "src/study/scorecard.hpp"

namespace gnomon {
namespace {

/// From the best to the worst.
int badness(const Score& score) {
  if (score.long_run != Status::ok) return 9;
  if (!score.energy) return -1;
  switch (score.energy->verdict) {
    case DriftVerdict::roundoff:
      return 0;
    case DriftVerdict::newton:
      return 1;
    case DriftVerdict::bounded:
      return 2;
    case DriftVerdict::undecided:
      return 3;
    case DriftVerdict::dissipated:
      return 4;
    case DriftVerdict::secular:
      return 5;
    case DriftVerdict::saturated:
      return 6;
    case DriftVerdict::far_off:
      return 7;
    case DriftVerdict::failed:
      return 8;
  }
  return 8;
}

std::string energy_text(const Score& score) {
  if (score.long_run != Status::ok) return std::string(to_string(score.long_run));
  return score.energy ? std::string(to_string(score.energy->verdict)) : "";
}

std::string of_all(std::size_t some, std::size_t all) {
  return some == all ? "" : fmt::format(" ({} of {})", some, all);
}

/// A scheme on one of the scenes.
struct ScoreOn {
  const Scorecard* card;
  const Score* score;
};

output::Cell joint_order_cell(const std::vector<ScoreOn>& all) {
  std::vector<double> orders;
  std::map<std::string, std::size_t> marks;
  std::size_t fixed = 0;
  for (const ScoreOn& on : all) {
    fixed += on.score->scheme->stepping == Stepping::fixed ? 1 : 0;
    const OrderFinding finding = on.score->order.finding;
    if (on.score->order.observed)
      orders.push_back(*on.score->order.observed);
    else if (on.score->scheme->stepping == Stepping::fixed && finding != OrderFinding::none)
      ++marks[order_cell(on.score->order, on.score->declared).text];
  }
  std::string others;
  for (const auto& [mark, count] : marks)
    others += (others.empty() ? "" : ", ") + mark + of_all(count, fixed);
  if (orders.empty()) return others.empty() ? output::Cell() : output::Cell(others, "");
  const auto [least, most] = std::ranges::minmax_element(orders);
  output::Cell cell = output::number_cell(*least, 3);
  if (*most - *least > 0.1) cell.text += " to " + output::number(*most, 3);
  cell.text += of_all(orders.size(), fixed);
  if (!others.empty()) cell.text += ", " + others;
  return cell;
}

bool has_times(const std::vector<Scorecard>& cards) {
  for (const Scorecard& card : cards)
    for (const Score& score : card.scores)
      for (const auto& cost : score.seconds)
        if (cost) return true;
  return false;
}

const std::optional<LevelCost>& cost_of(const Score& score, std::size_t level, bool times) {
  return times ? score.seconds[level] : score.evaluations[level];
}

/// Of the schemes that step; those that are exact on the scene need one step for any error.
std::optional<LevelCost> least_cost(const Scorecard& card, std::size_t level, bool times) {
  std::optional<LevelCost> least;
  for (const Score& score : card.scores)
    if (const auto& cost = cost_of(score, level, times);
        cost && score.scheme->stepping != Stepping::closed_form &&
        score.order.finding != OrderFinding::exact && (!least || cost->cost < least->cost))
      least = cost;
  return least;
}

/// Geometric mean over the scenes that the scheme runs on, if it reaches the level on all of them: without
/// those where it is dearest a mean says nothing. An upper bound carries over to it; where the least is one,
/// the ratio is a lower bound.
output::Cell joint_cost_cell(const std::vector<ScoreOn>& all, std::size_t level, bool times) {
  double logarithms = 0.0;
  std::size_t reached = 0;
  bool at_most = false, at_least = false, few = false;
  for (const ScoreOn& on : all) {
    const auto& cost = cost_of(*on.score, level, times);
    const auto least = least_cost(*on.card, level, times);
    if (!cost || !least || !(cost->cost > 0.0 && least->cost > 0.0)) continue;
    if (!times && on.score->scheme->stepping == Stepping::closed_form) continue;
    logarithms += std::log(cost->cost / least->cost);
    at_most = at_most || cost->upper_bound;
    at_least = at_least || (least->upper_bound && cost->cost != least->cost);
    few = few || cost->few;
    ++reached;
  }
  if (reached == 0) return {};
  if (reached < all.size()) return {output::missing_text + of_all(reached, all.size()), ""};
  output::Cell cell = output::number_cell(std::exp(logarithms / static_cast<double>(reached)), 2);
  if (at_most || at_least) cell.text = (at_most && at_least ? "≈ " : at_most ? "≤ " : "≥ ") + cell.text;
  if (few) cell.text += "°";
  return cell;
}

void add_energy_cells(std::vector<output::Cell>& cells, const std::vector<ScoreOn>& all) {
  const Score* worst = nullptr;
  std::size_t known = 0;
  double largest = std::nan("");
  for (const ScoreOn& on : all) {
    if (badness(*on.score) < 0) continue;
    ++known;
    if (!worst || badness(*on.score) > badness(*worst)) worst = on.score;
    if (on.score->energy && !(on.score->energy->max_abs <= largest)) largest = on.score->energy->max_abs;
  }
  if (!worst) {
    cells.insert(cells.end(), 2, output::Cell());
    return;
  }
  const auto as_bad =
      std::ranges::count_if(all, [&](const ScoreOn& on) { return badness(*on.score) == badness(*worst); });
  cells.emplace_back(energy_text(*worst) + of_all(static_cast<std::size_t>(as_bad), known));
  cells.push_back(output::number_cell(largest, 2));
}

void add_step_cells(std::vector<output::Cell>& cells, const std::vector<ScoreOn>& all) {
  const auto scaled = [](const ScoreOn& on) {
    return on.score->breaking->survived / on.card->comparison.scene.model->time_scale();
  };
  const ScoreOn* least = nullptr;
  for (const ScoreOn& on : all) {
    if (!on.score->breaking) continue;
    // Of equal ones, one that breaks is the smaller.
    if (!least || scaled(on) < scaled(*least) || (scaled(on) == scaled(*least) && on.score->breaking->breaks))
      least = &on;
  }
  if (!least) {
    cells.insert(cells.end(), 2, output::Cell());
    return;
  }
  const Breaking& breaking = *least->score->breaking;
  output::Cell step =
      breaking.survived > 0.0 ? output::number_cell(scaled(*least), 2) : output::Cell("none", "");
  if (!breaking.breaks) step.text = "≥ " + step.text;
  cells.push_back(step);
  cells.push_back(breaking.breaks ? output::Cell(breaking.how) : output::Cell());
}

std::string largest_step_note() {
  return "all smaller ones that were tried survive, at least down to a sixteenth of it unless a run there "
         "takes "
         "longer than 20 s; ≥: the largest that was tried; " +
         survival_line({});
}

/// Why, in a note.
void add_undecided(output::Table& table, std::span<const Scorecard> cards) {
  std::string text;
  for (const Scorecard& card : cards)
    for (const Score& score : card.scores) {
      const std::string why =
          score.energy && score.long_run == Status::ok ? why_undecided(*score.energy) : "";
      if (!why.empty())
        text += fmt::format("{}{} on {}: {}", text.empty() ? "undecided: " : "; ", score.scheme->name,
                            card.comparison.scene.name, why);
    }
  if (!text.empty()) table.notes.push_back(text);
}

std::string exponent_text(double level) { return fmt::format("{:.0e}", level); }

}  // namespace

output::Table joint_scorecard_table(const std::string& heading, const std::vector<Scorecard>& cards) {
  using output::Align;
  output::Table table;
  table.caption = heading;
  if (cards.empty()) return table;
  const bool times = has_times(cards);
  const char* what = times ? "CPU time" : "evaluations";
  table.columns = {{"integrator", "integrator", Align::left}, {"order", "order"}};
  for (const double level : cards.front().levels)
    table.columns.push_back({fmt::format("cost_at_{}", exponent_text(level)),
                             fmt::format("{} to {}", what, exponent_text(level))});
  table.columns.insert(table.columns.end(), {{"energy", "energy", Align::left},
                                             {"energy_drift", "its drift"},
                                             {"largest_step", "largest step"},
                                             {"how", "fails beyond", Align::left},
                                             {"failed", "failed runs", Align::left}});
  std::vector<const SchemeInfo*> schemes;
  for (const Scorecard& card : cards)
    for (const Score& score : card.scores)
      if (std::ranges::find(schemes, score.scheme) == schemes.end()) schemes.push_back(score.scheme);
  for (const SchemeInfo* scheme : schemes) {
    std::vector<ScoreOn> all;
    int runs = 0, failed = 0;
    for (const Scorecard& card : cards)
      for (const Score& score : card.scores) {
        if (score.scheme != scheme) continue;
        all.push_back({&card, &score});
        runs += score.runs;
        failed += score.failed;
      }
    std::vector<output::Cell> cells{std::string(scheme->name) + of_all(all.size(), cards.size()),
                                    joint_order_cell(all)};
    for (std::size_t k = 0; k < cards.front().levels.size(); ++k)
      cells.push_back(joint_cost_cell(all, k, times));
    add_energy_cells(cells, all);
    add_step_cells(cells, all);
    cells.emplace_back(fmt::format("{} of {}", failed, runs), fmt::format("{}", failed));
    table.rows.push_back(std::move(cells));
  }
  std::string scenes;
  for (const Scorecard& card : cards) {
    const Scene& scene = card.comparison.scene;
    scenes += fmt::format("{}{} ({} error [{}] at t = {:g} s, time scale {:.3g} s)",
                          scenes.empty() ? "" : ", ", scene.name, scene.model->metrics()[0].name,
                          scene.model->metrics()[0].unit, scene.t_end, scene.model->time_scale());
  }
  table.notes.push_back("scenes: " + scenes + "; in brackets on how many of them, where not on all");
  table.notes.push_back(fmt::format(
      "{} to an error: times the least of the schemes that step and are not exact, geometric mean over the "
      "scenes that the scheme runs on, if it reaches it on all of them; ≤: on one of them already the "
      "loosest "
      "setting that ended well reaches it, ≥: that of the scheme with the least, ≈: both; °: fewer than two "
      "tighter settings confirm it; — not reached, in brackets on how many scenes it is",
      what));
  table.notes.push_back(std::string("order: ") + order_marks);
  add_undecided(table, cards);
  table.notes.push_back(verdict_marks);
  table.notes.push_back(
      "energy: the worst of the scenes that keep one, over a thousand time scales, a tenth of one the step, "
      "1e-8 the "
      "tolerance; its drift: the largest, in the scale of the energy");
  table.notes.push_back("largest step: the least of the scenes, in time scales; " + largest_step_note());
  return table;
}

output::Table scorecard_table(const Scorecard& card) {
  using output::Align;
  using output::Cell;
  output::Table table;
  const Scene& scene = card.comparison.scene;
  const MetricInfo metric = scene.model->metrics()[0];
  table.caption = fmt::format("Scorecard, {}", scene.name);
  table.columns = {{"integrator", "integrator", Align::left}, {"order", "order"}};
  for (const double level : card.levels) {
    table.columns.push_back(
        {fmt::format("cpu_us_at_{:.0e}", level), fmt::format("us to {:.0e} {}", level, metric.unit)});
    table.columns.push_back({fmt::format("rhs_at_{:.0e}", level), "(rates)"});
  }
  table.columns.insert(table.columns.end(), {{"energy", "energy", Align::left},
                                             {"energy_drift", "its drift"},
                                             {"largest_step_s", "largest step [s]"},
                                             {"how", "fails beyond", Align::left},
                                             {"failed", "failed runs", Align::left}});
  for (const Score& score : card.scores) {
    std::vector<Cell> cells{std::string(score.scheme->name), score.scheme->stepping == Stepping::fixed
                                                                 ? order_cell(score.order, score.declared)
                                                                 : Cell()};
    for (std::size_t k = 0; k < card.levels.size(); ++k) {
      cells.push_back(microseconds_cell(score.seconds[k]));
      cells.push_back(evaluations_cell(score.evaluations[k]));
    }
    if (score.long_run != Status::ok)
      cells.emplace_back(std::string(to_string(score.long_run)));
    else
      cells.push_back(score.energy ? Cell(std::string(to_string(score.energy->verdict))) : Cell());
    cells.push_back(score.energy ? output::number_cell(score.energy->max_abs, 2) : Cell());
    if (!score.breaking) {
      cells.insert(cells.end(), 2, Cell());
    } else {
      Cell step =
          score.breaking->survived > 0.0 ? output::number_cell(score.breaking->survived) : Cell("none", "");
      if (!score.breaking->breaks) step.text = "≥ " + step.text;
      cells.push_back(step);
      cells.push_back(score.breaking->breaks ? Cell(score.breaking->how) : Cell());
    }
    std::string failed = fmt::format("{} of {}", score.failed, score.runs);
    if (score.failed > 0) failed += " (" + score.first_failure + ")";
    cells.emplace_back(failed);
    table.rows.push_back(std::move(cells));
  }
  table.notes.push_back(reference_line(card.comparison));
  table.notes.push_back(
      fmt::format("order and cost of the {} error at t = {:g} s; ≤: already the loosest setting that ended "
                  "well reaches the level; °: fewer than two tighter ones confirm it; — not reached",
                  metric.name, scene.t_end));
  table.notes.push_back(std::string("order: ") + order_marks);
  table.notes.push_back(fmt::format("energy to t = {:g} s at a step of {:.3g} s or a tolerance of 1e-8",
                                    card.long_t_end, 0.1 * scene.model->time_scale()));
  add_undecided(table, {&card, 1});
  table.notes.push_back(verdict_marks);
  table.notes.push_back("largest step: " + largest_step_note());
  return table;
}

}  // namespace gnomon
