#include "src/study/vary_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/output/figure_style.hpp"
#include "src/study/present.hpp"

namespace gnomon {
namespace {

using output::Align;
using output::Cell;
using output::Table;

/// The scene without its variation.
std::string varied_name(const std::vector<Comparison>& variants) {
  const std::string& name = variants.front().scene.name;
  return name.substr(0, name.find('['));
}

/// The first metric with its article.
std::string one_error(const std::vector<Comparison>& variants) {
  const std::string name(variants.front().scene.model->metrics()[0].name);
  return fmt::format("{} {} error", std::string_view("aeiou").find(name.front()) < 5 ? "an" : "a", name);
}

/// The schemes in the order of the catalogue; not every one need run on every variant.
std::vector<const SchemeInfo*> varied_schemes(const std::vector<Comparison>& variants) {
  std::vector<const SchemeInfo*> schemes;
  for (const Comparison& study : variants)
    for (const CostRow& cost : study.costs)
      if (std::ranges::find(schemes, cost.scheme) == schemes.end()) schemes.push_back(cost.scheme);
  return schemes;
}

/// How a value stands above its column: the number alone where the others of a list do not change.
std::string value_heading(const Variation& variation, std::size_t of) {
  const auto axis = variation.axis();
  return axis && variation.values[of].starts_with('[') ? fmt::format("{}", axis->values[of])
                                                       : variation.values[of];
}

bool has_ladders(const std::vector<Comparison>& variants) {
  for (const Comparison& study : variants)
    for (std::size_t k = 1; k < study.rows.size(); ++k)
      if (study.rows[k].scheme == study.rows[k - 1].scheme) return true;
  return false;
}

/// An integrator and a setting. Default ladders depend on the time scale of a variant, so that their steps
/// differ: then it is the place on the ladder that counts.
struct VariedRow {
  const SchemeInfo* scheme;
  std::size_t place;
  std::string text;
  std::vector<const Row*> runs;  ///< one a value; null where there is none
};

std::vector<VariedRow> varied_rows(const std::vector<Comparison>& variants) {
  std::vector<VariedRow> rows;
  for (const SchemeInfo* scheme : varied_schemes(variants)) {
    const std::size_t first = rows.size();
    for (std::size_t of = 0; of < variants.size(); ++of) {
      std::size_t place = 0;
      for (const Row& run : variants[of].rows) {
        if (run.scheme != scheme) continue;
        if (first + place == rows.size())
          rows.push_back({scheme, place, run.setting.text(), std::vector<const Row*>(variants.size())});
        VariedRow& row = rows[first + place++];
        if (row.text != run.setting.text()) row.text = fmt::format("number {} of its ladder", row.place + 1);
        row.runs[of] = &run;
      }
    }
  }
  return rows;
}

void note_missing_references(const std::vector<Comparison>& variants, const Variation& variation,
                             Table& table) {
  for (std::size_t of = 0; of < variants.size(); ++of)
    if (variants[of].reference.kind.empty())
      table.notes.push_back(
          fmt::format("{} = {}: {}", variation.key, variation.values[of], reference_line(variants[of])));
}

}  // namespace

namespace {

/// The levels of varied_costs_table, by their number in Comparison::levels.
constexpr std::size_t shown_levels[] = {0, 2, 4};

/// Where the errors of a scheme end however small its steps.
struct Plateau {
  double level;                               ///< that all of them reach
  std::vector<std::optional<double>> errors;  ///< one a value of the variation; none where no run ended well
};

/// Of a scheme of equal steps without a declared order, which goes to a motion of its own: nothing if it
/// reaches one of the levels, or nowhere stays at an error.
std::optional<Plateau> plateau_of(const std::vector<Comparison>& variants, const SchemeInfo& scheme) {
  if (scheme.stepping != Stepping::fixed) return std::nullopt;
  Plateau plateau{0.0, {}};
  bool stays = false;
  for (const Comparison& study : variants) {
    if (scheme.order_for(study.scene.model->load_class())) return std::nullopt;
    const auto cost = std::ranges::find(study.costs, &scheme, &CostRow::scheme);
    if (cost != study.costs.end())
      for (const std::size_t level : shown_levels)
        if (cost->evaluations[level]) return std::nullopt;
    std::optional<double> last, before;
    for (const Row& row : study.rows)
      if (row.scheme == &scheme && !row.error.empty()) before = last, last = row.error[0];
    stays = stays || (before && std::abs(*before - *last) <= 0.05 * *last);
    plateau.errors.push_back(last);
    plateau.level = std::max(plateau.level, last.value_or(0.0));
  }
  if (!stays) return std::nullopt;
  const double digit = std::pow(10.0, std::floor(std::log10(plateau.level)) - 1.0);
  plateau.level = digit * std::ceil(plateau.level / digit);
  return plateau;
}

std::string plateau_note(const SchemeInfo& scheme, const Plateau& plateau) {
  std::string text;
  for (const auto& error : plateau.errors)
    text += (text.empty() ? "" : ", ") + (error ? output::number(*error, 3) : output::missing_text);
  return fmt::format(
      "{} ({}): its errors against the motion of the mesh end at {}, however small the steps; the costs are "
      "those of {}",
      scheme.name, scheme.summary, text, output::number(plateau.level, 2));
}

}  // namespace

output::Panel varied_panel(const Variation& variation) {
  output::Panel panel;
  const auto axis = variation.axis();
  panel.x_label = axis ? axis->label : fmt::format("number of the value of {}", variation.key);
  // Values over several decades: a zero among them has no place on the axis.
  panel.log_x = false;
  if (axis && std::ranges::none_of(axis->values, [](double value) { return value < 0.0; })) {
    double least = HUGE_VAL, most = 0.0;
    for (const double value : axis->values)
      if (value > 0.0) least = std::min(least, value), most = std::max(most, value);
    const bool zero = std::ranges::find(axis->values, 0.0) != axis->values.end();
    panel.log_x = most > 0.0 && (!zero || most >= 100.0 * least);
  }
  return panel;
}

double varied_x(const Variation& variation, std::size_t of) {
  const auto axis = variation.axis();
  return axis ? axis->values[of] : static_cast<double>(of + 1);
}

Table varied_costs_table(const std::vector<Comparison>& variants, const Variation& variation) {
  Table table;
  const MetricInfo metric = variants.front().scene.model->metrics()[0];
  table.caption = fmt::format("CPU microseconds (rate evaluations) to {} [{}] over {}, {}",
                              one_error(variants), metric.unit, variation.key, varied_name(variants));
  table.columns = {{"integrator", "integrator", Align::left}, {"error", "error"}};
  for (std::size_t of = 0; of < variants.size(); ++of) {
    table.columns.push_back({"cpu_us_at_" + variation.values[of], variation.values[of]});
    table.columns.push_back({"rhs_at_" + variation.values[of], "(rates)"});
  }
  std::vector<const SchemeInfo*> schemes;
  std::vector<std::string> notes;
  for (const SchemeInfo* scheme : varied_schemes(variants)) {
    if (const auto plateau = plateau_of(variants, *scheme)) {
      schemes.push_back(scheme);
      std::vector<Cell> cells{std::string(scheme->name), output::number_cell(plateau->level, 2)};
      for (const Comparison& study : variants) {
        const CostRow cost = costs_of(study, *scheme, {plateau->level});
        cells.push_back(microseconds_cell(cost.seconds.front()));
        cells.push_back(evaluations_cell(cost.evaluations.front()));
      }
      table.rows.push_back(std::move(cells));
      notes.push_back(plateau_note(*scheme, *plateau));
      continue;
    }
    for (const std::size_t level : shown_levels) {
      schemes.push_back(scheme);
      std::vector<Cell> cells{std::string(scheme->name),
                              output::number_cell(variants.front().levels[level], 1)};
      for (const Comparison& study : variants) {
        const auto cost = std::ranges::find(study.costs, scheme, &CostRow::scheme);
        const bool runs = cost != study.costs.end();
        cells.push_back(runs ? microseconds_cell(cost->seconds[level]) : Cell{});
        cells.push_back(runs ? evaluations_cell(cost->evaluations[level]) : Cell{});
      }
      table.rows.push_back(std::move(cells));
    }
  }
  name_linear_solver(variants.front(), schemes, table);
  note_missing_references(variants, variation, table);
  table.notes.emplace_back(levels_note);
  table.notes.insert(table.notes.end(), notes.begin(), notes.end());
  return table;
}

namespace {

/// Of the errors from 1e-3 to 1e-6 the one at which most costs are known and not only bounded.
std::size_t telling_level(const std::vector<Comparison>& variants) {
  std::size_t best = 1, most = 0;
  for (std::size_t level = 1; level <= 4; ++level) {
    std::size_t known = 0;
    for (const Comparison& study : variants)
      for (const CostRow& cost : study.costs)
        known += cost.evaluations[level] && !cost.evaluations[level]->upper_bound;
    if (known > most) best = level, most = known;
  }
  return best;
}

}  // namespace

output::Figure varied_costs_figure(const Catalogue& catalogue, const std::vector<Comparison>& variants,
                                   const Variation& variation) {
  const MetricInfo metric = variants.front().scene.model->metrics()[0];
  const std::size_t level = telling_level(variants);
  output::Figure figure;
  figure.title = fmt::format("{}: cost of {} of {:g} {}", varied_name(variants), one_error(variants),
                             variants.front().levels[level], metric.unit);
  output::Panel time = varied_panel(variation), rates = time;
  time.title = "CPU time", rates.title = "evaluations";
  time.y_label = "CPU time [s]", rates.y_label = "evaluations of the rates";
  bool timed = false;
  for (const SchemeInfo* scheme : varied_schemes(variants)) {
    output::Series seconds, evaluations;
    seconds.label = evaluations.label = std::string(scheme->name);
    seconds.style = evaluations.style = style_of_scheme(catalogue, *scheme);
    for (std::size_t of = 0; of < variants.size(); ++of) {
      const auto cost = std::ranges::find(variants[of].costs, scheme, &CostRow::scheme);
      if (cost == variants[of].costs.end()) continue;
      for (output::Series* series : {&seconds, &evaluations}) {
        const auto& at = series == &seconds ? cost->seconds[level] : cost->evaluations[level];
        timed = timed || (series == &seconds && at);
        series->x.push_back(varied_x(variation, of));
        series->y.push_back(at ? at->cost : std::nan(""));
        series->hollow.push_back(at && at->upper_bound);
      }
    }
    time.series.push_back(std::move(seconds));
    rates.series.push_back(std::move(evaluations));
  }
  figure.hollow_note = "hollow: an upper bound, no looser setting that ended well misses the error";
  if (timed) figure.panels.push_back(std::move(time));
  figure.panels.push_back(std::move(rates));
  output::settle_styles(figure);
  return figure;
}

Table varied_errors_table(const std::vector<Comparison>& variants, const Variation& variation) {
  Table table;
  const MetricInfo metric = variants.front().scene.model->metrics()[0];
  const auto axis = variation.axis();
  table.caption =
      fmt::format("{} error at t = {:g} s [{}] over {}, {}", metric.name, variants.front().scene.t_end,
                  metric.unit, axis ? axis->label : variation.key, varied_name(variants));
  table.columns = {{"integrator", "integrator", Align::left}, {"setting", "setting", Align::left}};
  for (std::size_t of = 0; of < variants.size(); ++of)
    table.columns.push_back({"error_at_" + variation.values[of], value_heading(variation, of)});
  std::vector<Cell> bounds{"bound of the reference", ""};
  for (const Comparison& study : variants)
    bounds.push_back(
        study.reference.bounds.empty() ? Cell{} : output::at_most_cell(study.reference.bounds.back()[0], 2));
  table.rows.push_back(std::move(bounds));
  for (const VariedRow& row : varied_rows(variants)) {
    std::vector<Cell> cells{std::string(row.scheme->name), row.text};
    for (const Row* run : row.runs) {
      if (!run)
        cells.emplace_back();
      else if (run->result.status != Status::ok)
        cells.emplace_back(std::string(to_string(run->result.status)), "");
      else
        cells.push_back(error_cell(*run, 0));
    }
    table.rows.push_back(std::move(cells));
  }
  note_missing_references(variants, variation, table);
  table.notes.emplace_back("≤: not above the bound of the reference");
  return table;
}

output::Figure varied_errors_figure(const Catalogue& catalogue, const std::vector<Comparison>& variants,
                                    const Variation& variation) {
  output::Figure figure;
  const MetricInfo metric = variants.front().scene.model->metrics()[0];
  figure.title = fmt::format("{}: {} error at t = {:g} s", varied_name(variants), metric.name,
                             variants.front().scene.t_end);
  figure.hollow_note = "hollow: at or below the bound of the reference";
  output::Panel panel = varied_panel(variation);
  panel.y_label = fmt::format("{} error [{}]", metric.name, metric.unit);
  for (const VariedRow& row : varied_rows(variants)) {
    output::Series series;
    series.label = row.scheme->stepping == Stepping::closed_form
                       ? std::string(row.scheme->name)
                       : fmt::format("{}, {}", row.scheme->name, row.text);
    series.style = style_of_scheme(catalogue, *row.scheme);
    for (std::size_t of = 0; of < variants.size(); ++of) {
      const Row* run = row.runs[of];
      const bool known = run && !run->error.empty();
      series.x.push_back(varied_x(variation, of));
      series.y.push_back(known ? run->error[0] : std::nan(""));
      series.hollow.push_back(known && run->below_bound[0]);
    }
    panel.series.push_back(std::move(series));
  }
  output::Series bound;
  bound.label = "bound of the reference";
  bound.style = static_cast<int>(catalogue.schemes.size());
  for (std::size_t of = 0; of < variants.size(); ++of) {
    const auto& bounds = variants[of].reference.bounds;
    bound.x.push_back(varied_x(variation, of));
    bound.y.push_back(bounds.empty() ? std::nan("") : bounds.back()[0]);
  }
  panel.series.push_back(std::move(bound));
  figure.panels.push_back(std::move(panel));
  output::settle_styles(figure);
  return figure;
}

Table varied_runs_table(const std::vector<Comparison>& variants, const Variation& variation) {
  Table all;
  for (std::size_t of = 0; of < variants.size(); ++of) {
    Table one = comparison_table(variants[of], "Runs");
    for (std::vector<Cell>& row : one.rows) row.insert(row.begin() + 1, Cell(variation.values[of]));
    one.columns.insert(one.columns.begin() + 1, {"value", variation.key});
    for (std::string& note : one.notes)
      if (note.starts_with("reference") || note.starts_with("no reference"))
        note = fmt::format("{}: {}", variation.values[of], note);
    if (of == 0) {
      all = std::move(one);
      continue;
    }
    all.rows.insert(all.rows.end(), one.rows.begin(), one.rows.end());
    for (const std::string& note : one.notes)
      if (std::ranges::find(all.notes, note) == all.notes.end()) all.notes.push_back(note);
  }
  return all;
}

std::vector<Table> varied_tables(const std::vector<Comparison>& variants, const Variation& variation) {
  std::vector<Table> tables;
  if (has_ladders(variants)) tables.push_back(varied_costs_table(variants, variation));
  tables.push_back(varied_errors_table(variants, variation));
  return tables;
}

output::Figure varied_figure(const Catalogue& catalogue, const std::vector<Comparison>& variants,
                             const Variation& variation) {
  return has_ladders(variants) ? varied_costs_figure(catalogue, variants, variation)
                               : varied_errors_figure(catalogue, variants, variation);
}

}  // namespace gnomon
