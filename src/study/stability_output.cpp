#include "src/study/stability_output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "src/study/present.hpp"

namespace gnomon {

using output::Align;

namespace {

/// The cells that say which scene: with a variation its value.
void begin_row(const Stability& study, std::size_t of, const StabilityEntry& entry,
               std::vector<output::Cell>& cells) {
  cells.emplace_back(std::string(entry.scheme->name));
  if (study.variation) cells.emplace_back(study.variation->values[of]);
}

std::vector<output::Column> first_columns(const Stability& study) {
  std::vector<output::Column> columns{{"integrator", "integrator", Align::left}};
  if (study.variation) columns.push_back({"value", study.variation->key});
  return columns;
}

void add_notes(const Stability& study, output::Table& table) {
  table.notes.push_back(survival_line(study.search.survival));
  if (!study.scenes.empty())
    table.notes.push_back(
        fmt::format("run to t = {:g} s, doubled for large steps until it takes {:g} of them",
                    study.scenes.front().scene.t_end, fewest_steps));
}

std::string steps_text(const std::vector<double>& steps) {
  std::string text;
  for (const double step : steps) text += (text.empty() ? "" : ", ") + output::number(step, 3);
  return text;
}

}  // namespace

output::Table stability_table(const Stability& study) {
  output::Table table;
  table.caption = fmt::format("Largest step that survives, {}", study.name);
  table.columns = first_columns(study);
  table.columns.insert(table.columns.end(), {{"largest_step_s", "largest step [s]"},
                                             {"largest_step_scaled", "in time scales"},
                                             {"max_drift", "largest drift there"},
                                             {"tried_down_to_s", "tried down to [s]"},
                                             {"tried", "steps tried"},
                                             {"breaks_at_s", "fails at [s]"},
                                             {"how", "how", Align::left},
                                             {"status", "status", Align::left},
                                             {"t_s", "time reached [s]"},
                                             {"reason", "reason", Align::left},
                                             {"survives_again_s", "survives again at [s]", Align::left}});
  for (std::size_t of = 0; of < study.scenes.size(); ++of) {
    const StabilityScene& on = study.scenes[of];
    const double scale = on.scene.model->time_scale();
    for (const StabilityEntry& entry : on.entries) {
      const Breaking& breaking = entry.breaking;
      std::vector<output::Cell> cells;
      begin_row(study, of, entry, cells);
      if (breaking.survived > 0.0) {
        const bool open = !breaking.breaks;  // the ladder ends first
        output::Cell step = output::number_cell(breaking.survived),
                     scaled = output::number_cell(breaking.survived / scale);
        if (open) step.text = "≥ " + step.text, scaled.text = "≥ " + scaled.text;
        cells.push_back(step);
        cells.push_back(scaled);
      } else {
        cells.insert(cells.end(), {output::Cell("none", ""), output::Cell()});
      }
      const auto point = std::ranges::find(entry.points, breaking.survived, &StabilityEntry::Point::step);
      const auto drift = point == entry.points.end() ? std::nullopt : largest_drift(on.rows[point->row]);
      cells.push_back(drift ? output::number_cell(*drift, 2) : output::Cell());
      cells.push_back(breaking.tried > 0 ? output::number_cell(breaking.down_to) : output::Cell());
      cells.emplace_back(fmt::format("{}", breaking.tried));
      if (breaking.breaks)
        cells.insert(cells.end(),
                     {output::number_cell(*breaking.breaks), breaking.how,
                      std::string(to_string(breaking.status)), output::number_cell(breaking.t, 4),
                      breaking.message.empty() ? output::Cell() : output::Cell(breaking.message)});
      else
        cells.insert(cells.end(), 5, output::Cell());
      const std::vector<double> islands = entry.islands();
      cells.push_back(islands.empty() ? output::Cell() : output::Cell(steps_text(islands)));
      table.rows.push_back(std::move(cells));
    }
  }
  add_notes(study, table);
  table.notes.push_back(fmt::format(
      "largest step: all smaller ones that were tried survive, too; a ladder of factors of 2, bisected until "
      "neighbours are a factor {:.3g} or one step of the run apart, then {} steps in the octave below the "
      "largest and {} an octave in the next {}, and again below one that fails; tried: without runs that a "
      "limit ended; ≥: the largest step of the ladder survives; survives again: tried steps beyond the "
      "smallest that fails",
      study.search.resolution, study.search.descent.near, study.search.descent.far,
      study.search.descent.octaves - 1));
  return table;
}

output::Table stability_map(const Stability& study) {
  output::Table table;
  table.caption = study.variation
                      ? fmt::format("What survives over step and {}, {}", study.variation->key, study.name)
                      : fmt::format("What survives, {}", study.name);
  table.columns = first_columns(study);
  std::vector<double> steps;
  for (int k = 0; k < study.search.count; ++k) steps.push_back(study.search.first * std::pow(2.0, k));
  for (const double step : steps)
    table.columns.push_back(
        {fmt::format("step_{:.3g}_s", step), fmt::format("{:.3g} s", step), Align::centre});
  for (std::size_t of = 0; of < study.scenes.size(); ++of) {
    const StabilityScene& on = study.scenes[of];
    for (const StabilityEntry& entry : on.entries) {
      std::vector<output::Cell> cells;
      begin_row(study, of, entry, cells);
      for (const double step : steps) {
        const auto point = std::ranges::find(entry.points, step, &StabilityEntry::Point::step);
        if (point == entry.points.end()) {
          cells.emplace_back();
          continue;
        }
        const RunResult& result = on.rows[point->row].result;
        if (point->failure.empty())
          cells.emplace_back("ok");
        else if (result.status == Status::ok)
          cells.emplace_back(point->failure);
        else
          cells.emplace_back(fmt::format("{} at {:.3g} s", point->failure, result.t));
      }
      table.rows.push_back(std::move(cells));
    }
  }
  add_notes(study, table);
  return table;
}

nlohmann::ordered_json stability_json(const Stability& study) {
  using Json = nlohmann::ordered_json;
  const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); };
  Json list = Json::array();
  for (std::size_t of = 0; of < study.scenes.size(); ++of) {
    const StabilityScene& on = study.scenes[of];
    for (const StabilityEntry& entry : on.entries) {
      const Breaking& breaking = entry.breaking;
      Json item;
      item["scene"] = on.scene.name;
      item["integrator"] = entry.scheme->name;
      item["vary"] = nullptr;
      if (study.variation) item["vary"] = {{study.variation->key, study.variation->values[of]}};
      item["time_scale"] = number(on.scene.model->time_scale());
      item["max_drift"] = study.search.survival.max_drift;
      item["largest_step"] = breaking.survived > 0.0 ? number(breaking.survived) : Json(nullptr);
      item["breaks_at"] = breaking.breaks ? number(*breaking.breaks) : Json(nullptr);
      item["breaks_how"] = breaking.breaks ? Json(breaking.how) : Json(nullptr);
      item["status"] = breaking.breaks ? Json(to_string(breaking.status)) : Json(nullptr);
      item["message"] = breaking.breaks ? Json(breaking.message) : Json(nullptr);
      item["t"] = breaking.breaks ? number(breaking.t) : Json(nullptr);
      item["survives_again"] = entry.islands();
      item["steps_tried"] = breaking.tried;
      item["tried_down_to"] = breaking.tried > 0 ? number(breaking.down_to) : Json(nullptr);
      item["points"] = Json::array();
      for (const StabilityEntry::Point& point : entry.points) {
        const Row& row = on.rows[point.row];
        item["points"].push_back({{"step", number(point.step)},
                                  {"t_end", number(horizon(on.scene.t_end, point.step))},
                                  {"survives", point.failure.empty()},
                                  {"how", point.failure},
                                  {"status", to_string(row.result.status)},
                                  {"t", number(row.result.t)},
                                  {"max_drift", number(largest_drift(row).value_or(std::nan("")))}});
      }
      list.push_back(std::move(item));
    }
  }
  return list;
}

}  // namespace gnomon
