#include "src/study/survey.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "src/study/converge.hpp"
#include "src/study/drift_study.hpp"
#include "src/study/present.hpp"

namespace gnomon {

using Json = nlohmann::ordered_json;

namespace {

std::vector<std::string> surveyed(const Catalogue& catalogue, const Scene& scene) {
  std::vector<std::string> names;
  for (const SchemeInfo* scheme : catalogue.schemes_for(*scene.model))
    if (scheme->stepping == Stepping::fixed) names.emplace_back(scheme->name);
  return names;
}

Scene load(const Catalogue& catalogue, const std::string& name, std::optional<double> t_end) {
  SceneChanges changes;
  changes.t_end = t_end;
  return load_scene(catalogue, name, changes);
}

/// Steps from a 64th of the motion's time scale to 16 times it, by factors of 2, over 500 time scales or
/// the long run; an invariant may be off by a hundredth of its scale. Where no energy is constant the runs
/// end with the scene, where the reference is, and its errors may be a hundredth of one that is wrong
/// altogether: the other invariants hold whatever the step.
void add_breakings(Runner& runner, SurveyClass& of, output::Progress& progress) {
  const double scale = of.scene.model->time_scale();
  StudyOptions options;
  const bool by_energy = keeps_energy(of.scene);
  const Scene scene =
      by_energy ? load(runner.catalogue(), of.plan.scene, std::min(500.0 * scale, of.plan.t_end)) : of.scene;
  const ReferenceStates reference = by_energy ? ReferenceStates{} : runner.reference(scene, options);
  options.time_limit = 20.0;
  StepSearch search;
  search.first = scale / 64.0;
  search.count = 11;
  search.survival.max_drift = search.survival.max_error = 0.01;
  std::vector<const SchemeInfo*> schemes;
  for (const SurveyEntry& entry : of.entries) schemes.push_back(entry.scheme);
  auto found =
      find_breakings(runner, scene, reference, schemes, search, options, [&](const SchemeInfo& scheme) {
        progress.begin(fmt::format("{} / {}  larger and larger steps", of.plan.scene, scheme.name));
      });
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (!found[k]) continue;
    of.entries[k].breaking = std::move(*found[k]);
    of.entries[k].breaking.trials.clear();
  }
}

void add_orders(Runner& runner, SurveyClass& of, const StudyOptions& options, output::Progress& progress) {
  StudyOptions chosen = options;
  for (const SurveyEntry& entry : of.entries) chosen.integrators.emplace_back(entry.scheme->name);
  const Convergence study = converge(runner, of.scene, chosen, progress);
  for (const OrderRow& row : study.orders)
    for (SurveyEntry& entry : of.entries)
      if (entry.scheme == row.scheme && row.metric == of.scene.model->metrics()[0].name) {
        entry.order = row.order;
        entry.declared = row.expected;
      }
}

void add_drift(Runner& runner, SurveyClass& of, const StudyOptions& options, output::Progress& progress) {
  StudyOptions chosen = options;
  chosen.steps = {of.plan.step};
  chosen.reference = false;
  for (const SurveyEntry& entry : of.entries) chosen.integrators.emplace_back(entry.scheme->name);
  const DriftStudy study =
      drift(runner, load(runner.catalogue(), of.plan.scene, of.plan.t_end), chosen, progress);
  for (const DriftRow& row : study.drifts)
    for (SurveyEntry& entry : of.entries) {
      const Row& run = study.rows[row.row];
      if (entry.scheme != run.scheme) continue;
      entry.status = run.result.status;
      entry.cost = run.result.cost;
      const std::string& name = row.invariant.info.name;
      if (row.drift.verdict == DriftVerdict::roundoff) entry.held.push_back(name);
      if (name == "energy") entry.energy = row.drift;
    }
}

void find_why_not_timed(Runner& runner, const SurveyClass& of, SurveyEntry& entry) {
  StudyOptions options;
  options.reference = false;
  const double t_end = static_cast<double>(entry.timed_steps) * of.plan.step;
  const Row row = runner.run(load(runner.catalogue(), of.plan.scene, t_end), {}, *entry.scheme,
                             {of.plan.step, std::nullopt}, options);
  entry.timed_status = row.result.status;
  entry.timed_failure = std::string(to_string(row.result.status));
  if (row.result.status == Status::ok)
    entry.timed_failure = "no time was measured";
  else if (!row.result.message.empty())
    entry.timed_failure += ": " + row.result.message;
}

/// Of the runs that have no time; empty if all have.
std::string untimed_note(const Survey& survey) {
  std::string text;
  for (const SurveyClass& of : survey.classes)
    for (const SurveyEntry& entry : of.entries)
      if (!entry.timed_failure.empty())
        text += fmt::format("{}{}, {} ({} steps of {:g} s): {}", text.empty() ? "no time of a step: " : "; ",
                            entry.scheme->name, of.plan.label, entry.timed_steps, of.plan.step,
                            entry.timed_failure);
  return text;
}

void add_times(Runner& runner, std::vector<SurveyClass>& classes, bool quick) {
  std::vector<TimedTask> tasks;
  std::vector<std::string> names;
  std::vector<SurveyEntry*> timed;
  for (SurveyClass& of : classes)
    for (SurveyEntry& entry : of.entries) {
      const long steps = quick ? 5'000 : 20'000;
      RunSpec spec;
      spec.step = of.plan.step;
      spec.t_end = static_cast<double>(steps) * of.plan.step;
      spec.record = false;
      const auto run = runner.catalogue().pair(entry.scheme->name, *of.scene.model)->run;
      tasks.push_back({[run, spec, model = of.scene.model] {
        const RunResult result = run(model->get(), spec);
        return result.status == Status::ok ? result.cpu_seconds : std::nan("");
      }});
      names.push_back(fmt::format("{} {}, {}, {:.17g} x {}", of.scene.name, of.scene.physics_hash(),
                                  entry.scheme->name, of.plan.step, steps));
      entry.timed_steps = steps;
      timed.push_back(&entry);
    }
  TimingPlan plan;
  if (quick) plan.min_seconds = 0.005;
  const auto stats = runner.time("survey times", {}, names, tasks, plan);
  for (std::size_t k = 0; k < stats.size(); ++k) timed[k]->run = stats[k];
  for (SurveyClass& of : classes)
    for (SurveyEntry& entry : of.entries)
      if (entry.run.repetitions == 0 && !runner.stopped()) find_why_not_timed(runner, of, entry);
}

/// The schemes of all classes, each once, and its entry in a class if it runs there.
std::vector<const SchemeInfo*> schemes_of(const Survey& survey) {
  std::vector<const SchemeInfo*> schemes;
  for (const SurveyClass& of : survey.classes)
    for (const SurveyEntry& entry : of.entries)
      if (std::find(schemes.begin(), schemes.end(), entry.scheme) == schemes.end())
        schemes.push_back(entry.scheme);
  return schemes;
}
const SurveyEntry* entry_of(const SurveyClass& of, const SchemeInfo* scheme) {
  for (const SurveyEntry& entry : of.entries)
    if (entry.scheme == scheme) return &entry;
  return nullptr;
}

output::Cell surveyed_order_cell(const SurveyEntry& entry) {
  if (!entry.order.observed && entry.order.finding == OrderFinding::none && entry.declared)
    return output::Cell(fmt::format("— ({:g})", *entry.declared));
  return order_cell(entry.order, entry.declared);
}

bool evaluates_moments(const SurveyClass& of) {
  return std::ranges::any_of(of.entries, [](const SurveyEntry& entry) { return entry.cost.moments > 0; });
}

output::Cell per_step(long count, long steps) {
  return steps > 0 ? output::number_cell(static_cast<double>(count) / static_cast<double>(steps), 3)
                   : output::Cell();
}

output::Cell energy_cell(const SurveyEntry& entry) {
  if (entry.status != Status::ok) return std::string(to_string(entry.status));
  if (!entry.energy) return {};
  return fmt::format("{} {:.1e}", to_string(entry.energy->verdict), entry.energy->max_abs);
}

output::Cell breaking_cell(const SurveyClass& of, const SurveyEntry& entry) {
  const double scale = of.scene.model->time_scale();
  if (!entry.breaking.breaks) return fmt::format("> {:.3g}", entry.breaking.survived / scale);
  return fmt::format("{:.3g}: {}", *entry.breaking.breaks / scale, entry.breaking.how);
}

}  // namespace

std::size_t survey_runs(const Catalogue& catalogue, const std::vector<SurveyPlan>& plans, bool quick) {
  std::size_t runs = 1;  // the times
  for (const SurveyPlan& plan : plans) {
    const Scene scene = load(catalogue, plan.scene, std::nullopt);
    StudyOptions options;
    options.quick = quick;
    options.integrators = surveyed(catalogue, scene);
    runs += converge_runs(catalogue, scene, options) + 2 * options.integrators.size() +
            survey_solver_runs(catalogue, plan);
  }
  return runs;
}

Survey survey(Runner& runner, const std::string& model, const std::vector<SurveyPlan>& plans,
              const StudyOptions& options, output::Progress& progress) {
  Survey study;
  study.model = model;
  for (const SurveyPlan& plan : plans) {
    SurveyClass of{plan, load(runner.catalogue(), plan.scene, std::nullopt), {}};
    if (options.quick) of.plan.t_end = std::min(plan.t_end, 2000.0 * plan.step);
    for (const std::string& name : surveyed(runner.catalogue(), of.scene)) {
      SurveyEntry entry{};
      entry.scheme = runner.catalogue().scheme(name);
      of.entries.push_back(std::move(entry));
    }
    add_orders(runner, of, options, progress);
    add_drift(runner, of, options, progress);
    add_breakings(runner, of, progress);
    if (runner.stopped()) break;
    SolverClass solvers = survey_solvers(runner, of.plan, options, progress);
    if (runner.stopped()) break;
    study.solvers.push_back(std::move(solvers));
    study.classes.push_back(std::move(of));
  }
  if (options.timing && !runner.stopped()) {
    progress.begin("times of a step, interleaved");
    add_times(runner, study.classes, options.quick);
    if (!runner.stopped()) time_solvers(runner, study.solvers, options);
  }
  study.interrupted = runner.stopped();
  return study;
}

output::Table survey_cost_table(const Survey& survey) {
  output::Table table;
  table.caption = fmt::format("Order and cost of the schemes of equal steps, {}", survey.model);
  table.columns = {{"integrator", "integrator", output::Align::left}};
  for (const SurveyClass& of : survey.classes)
    table.columns.push_back({"order_" + of.plan.key(), "order, " + of.plan.label});
  for (const SurveyClass& of : survey.classes)
    table.columns.push_back({"rates_" + of.plan.key(), "rates a step, " + of.plan.label});
  for (const SurveyClass& of : survey.classes)
    if (evaluates_moments(of))
      table.columns.push_back({"moments_" + of.plan.key(), "moments a step, " + of.plan.label});
  for (const SurveyClass& of : survey.classes)
    table.columns.push_back({"ns_" + of.plan.key(), "ns a step, " + of.plan.label});
  for (const SchemeInfo* scheme : schemes_of(survey)) {
    std::vector<output::Cell> cells{std::string(scheme->name)};
    for (const SurveyClass& of : survey.classes) {
      const SurveyEntry* entry = entry_of(of, scheme);
      cells.push_back(entry ? surveyed_order_cell(*entry) : output::Cell());
    }
    for (const SurveyClass& of : survey.classes) {
      const SurveyEntry* entry = entry_of(of, scheme);
      cells.push_back(entry ? per_step(entry->cost.rhs, entry->cost.steps) : output::Cell());
    }
    for (const SurveyClass& of : survey.classes) {
      if (!evaluates_moments(of)) continue;
      const SurveyEntry* entry = entry_of(of, scheme);
      cells.push_back(entry ? per_step(entry->cost.moments, entry->cost.steps) : output::Cell());
    }
    for (const SurveyClass& of : survey.classes) {
      const SurveyEntry* entry = entry_of(of, scheme);
      output::Cell cell;
      if (entry && entry->run.repetitions > 0) {
        cell = output::number_cell(1e9 * entry->run.median / static_cast<double>(entry->timed_steps));
        if (entry->run.unstable) cell.text += "*";
      }
      cells.push_back(cell);
    }
    table.rows.push_back(std::move(cells));
  }
  std::string scenes;
  for (const SurveyClass& of : survey.classes)
    scenes += fmt::format("{}{}: {}", scenes.empty() ? "" : "; ", of.plan.label, of.plan.scene);
  table.notes = {
      scenes, std::string("order of the first error class; ") + order_marks,
      "evaluations a step: of the long runs; times: medians of 5 interleaved runs of 20000 steps (5000 in a "
      "quick study), one core",
      unstable_note};
  if (const std::string note = untimed_note(survey); !note.empty()) table.notes.push_back(note);
  return table;
}

output::Table survey_stability_table(const Survey& survey) {
  output::Table table;
  table.caption = fmt::format("What the schemes of equal steps keep and where they break, {}", survey.model);
  table.columns = {{"integrator", "integrator", output::Align::left}};
  for (const SurveyClass& of : survey.classes) {
    table.columns.push_back(
        {"held_" + of.plan.key(), "held to roundoff, " + of.plan.label, output::Align::left});
    if (of.entries.front().energy ||
        std::ranges::any_of(of.entries, [](const auto& e) { return e.energy.has_value(); }))
      table.columns.push_back({"energy_" + of.plan.key(), "energy, " + of.plan.label, output::Align::left});
    table.columns.push_back(
        {"off_at_" + of.plan.key(), "off by 1 % at, " + of.plan.label, output::Align::left});
  }
  for (const SchemeInfo* scheme : schemes_of(survey)) {
    std::vector<output::Cell> cells{std::string(scheme->name)};
    for (const SurveyClass& of : survey.classes) {
      const SurveyEntry* entry = entry_of(of, scheme);
      const bool energy = std::ranges::any_of(of.entries, [](const auto& e) { return e.energy.has_value(); });
      if (!entry) {
        cells.insert(cells.end(), energy ? 3 : 2, output::Cell());
        continue;
      }
      cells.emplace_back(entry->held.empty() ? std::string("none")
                                             : fmt::format("{}", fmt::join(entry->held, ", ")));
      if (energy) cells.push_back(energy_cell(*entry));
      cells.push_back(breaking_cell(of, *entry));
    }
    table.rows.push_back(std::move(cells));
  }
  std::string runs;
  for (const SurveyClass& of : survey.classes)
    runs += fmt::format("{}{}: step {:g} s to t = {:g} s", runs.empty() ? "" : "; ", of.plan.scene,
                        of.plan.step, of.plan.t_end);
  table.notes = {
      "held and energy: " + runs + "; the energy with its largest drift, relative to its scale",
      "off by 1 % at: the first of the steps 2^k times the motion's time scale (the inverse of its "
      "largest rate), "
      "k = -6 .. 4, upwards, that does not end well over 500 time scales (at most the long run, at "
      "least 100 steps) or changes an invariant by a hundredth of its scale; where no energy is constant, of "
      "runs to the end of the scene, or whose error there is a hundredth of that of a result that is wrong "
      "altogether; a step survives, as the scorecard has it, up to a half",
      verdict_marks};
  return table;
}

std::vector<output::Table> survey_tables(const Survey& survey) {
  return {survey_cost_table(survey), survey_stability_table(survey),
          solver_cost_table(survey.model, survey.solvers),
          solver_stability_table(survey.model, survey.solvers)};
}

nlohmann::ordered_json survey_json(const Survey& survey) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  const auto number = [](double value) -> nlohmann::ordered_json {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
  };
  for (const SurveyClass& of : survey.classes)
    for (const SurveyEntry& entry : of.entries) {
      nlohmann::ordered_json item;
      item["integrator"] = entry.scheme->name;
      item["class"] = of.plan.label;
      item["scene"] = of.plan.scene;
      item["stepping"] = to_string(entry.scheme->stepping);
      item["observed_order"] = number(entry.order.observed.value_or(std::nan("")));
      item["declared_order"] = number(entry.declared.value_or(std::nan("")));
      item["order_finding"] = to_string(entry.order.finding);
      item["status"] = to_string(entry.status);
      item["steps"] = entry.cost.steps;
      item["rhs"] = entry.cost.rhs;
      item["moments"] = entry.cost.moments;
      item["held"] = entry.held;
      if (entry.energy)
        item["energy"] = {{"verdict", to_string(entry.energy->verdict)},
                          {"max_drift", number(entry.energy->max_abs)},
                          {"slope", number(entry.energy->slope)}};
      item["largest_step_within_1_percent"] = number(entry.breaking.survived);
      item["off_by_1_percent_at"] = number(entry.breaking.breaks.value_or(std::nan("")));
      item["off_how"] = entry.breaking.how;
      item["timed_status"] = entry.timed_steps > 0 ? Json(to_string(entry.timed_status)) : Json(nullptr);
      item["untimed_because"] = entry.timed_failure.empty() ? Json(nullptr) : Json(entry.timed_failure);
      item["ns_a_step"] = entry.timed_steps > 0
                              ? number(1e9 * entry.run.median / static_cast<double>(entry.timed_steps))
                              : nullptr;
      list.push_back(std::move(item));
    }
  add_solvers(survey.solvers, list);
  return list;
}

}  // namespace gnomon
