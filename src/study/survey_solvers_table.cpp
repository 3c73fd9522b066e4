#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "src/study/present.hpp"
#include "src/study/survey_solvers.hpp"

namespace gnomon {
namespace {

using output::Align;
using output::Cell;

/// The schemes of all classes, each once: closed forms after the others, negative controls last.
std::vector<const SchemeInfo*> solvers_in(const std::vector<SolverClass>& classes) {
  std::vector<const SchemeInfo*> schemes;
  for (const SolverClass& of : classes)
    for (const SolverEntry& entry : of.entries)
      if (std::find(schemes.begin(), schemes.end(), entry.scheme) == schemes.end())
        schemes.push_back(entry.scheme);
  std::ranges::stable_sort(schemes, {}, [](const SchemeInfo* scheme) {
    return scheme->control ? 2 : scheme->stepping == Stepping::closed_form ? 1 : 0;
  });
  return schemes;
}

const SolverEntry* solver_in(const SolverClass& of, const SchemeInfo* scheme) {
  for (const SolverEntry& entry : of.entries)
    if (entry.scheme == scheme) return &entry;
  return nullptr;
}

bool ended_well(const SolverEntry* entry) { return entry && entry->run.result.status == Status::ok; }

double ns_of(const SolverEntry& entry) {
  if (!entry.run.timing) return std::nan("");
  const bool closed = entry.scheme->stepping == Stepping::closed_form;
  return 1e9 * entry.run.timing->median / static_cast<double>(closed ? 1L : entry.run.result.cost.steps);
}

Cell ns_cell(const SolverEntry* entry) {
  if (!ended_well(entry) || !entry->run.timing) return {};
  Cell cell = output::number_cell(ns_of(*entry));
  if (entry->run.timing->unstable) cell.text += "*";
  return cell;
}

Cell solver_error_cell(const SolverEntry* entry) {
  if (!entry) return {};
  return ended_well(entry) ? error_cell(entry->run, 0)
                           : Cell(std::string(to_string(entry->run.result.status)));
}

Cell steps_cell(const SolverEntry* entry) {
  if (!ended_well(entry) || entry->scheme->stepping == Stepping::closed_form) return {};
  return output::count_cell(entry->run.result.cost.steps);
}

/// Rates a step on the last class on which the scheme ended well.
Cell rates_cell(const std::vector<SolverClass>& classes, const SchemeInfo* scheme) {
  Cell cell;
  for (const SolverClass& of : classes)
    if (const SolverEntry* entry = solver_in(of, scheme); ended_well(entry))
      if (const Cost& cost = entry->run.result.cost; cost.steps > 0)
        cell = output::number_cell(static_cast<double>(cost.rhs) / static_cast<double>(cost.steps), 3);
  return cell;
}

Cell own_bound_cell(const std::vector<SolverClass>& classes, const SchemeInfo* scheme) {
  Cell cell;
  for (const SolverClass& of : classes)
    if (const SolverEntry* entry = solver_in(of, scheme);
        ended_well(entry) && std::isfinite(entry->own_bound))
      cell = output::at_most_cell(entry->own_bound, 2);
  return cell;
}

Cell solver_energy_cell(const SolverEntry& entry) {
  if (entry.status != Status::ok) return std::string(to_string(entry.status));
  if (!entry.energy) return {};
  return fmt::format("{} {:.1e}", to_string(entry.energy->verdict), entry.energy->max_abs);
}

Cell loosest_cell(const SolverEntry& entry) {
  if (entry.off_at) return fmt::format("{:.0e}: {}", *entry.off_at, entry.off_how);
  return entry.loosest ? Cell(fmt::format("> {:.0e}", *entry.loosest)) : Cell();
}

/// Why runs did not end well; classes on which a scheme gives the same reason stand together.
std::string failures_note(const std::vector<SolverClass>& classes) {
  std::vector<std::pair<std::string, std::string>> reasons;  // with whose and where
  for (const SchemeInfo* scheme : solvers_in(classes))
    for (const SolverClass& of : classes) {
      const SolverEntry* entry = solver_in(of, scheme);
      if (!entry || ended_well(entry) || entry->run.result.message.empty()) continue;
      const std::string who = fmt::format("{}{}", scheme->control ? "negative control " : "", scheme->name);
      const auto same = std::ranges::find_if(reasons, [&](const auto& each) {
        return each.first == entry->run.result.message && each.second.starts_with(who + " (");
      });
      if (same == reasons.end())
        reasons.push_back({entry->run.result.message, fmt::format("{} ({}", who, of.plan.label)});
      else
        same->second += ", " + of.plan.label;
    }
  std::string text;
  for (const auto& [reason, where] : reasons)
    text += fmt::format("{}{}): {}", text.empty() ? "" : "; ", where, reason);
  return text;
}

/// "gravity: exact-heavy-symmetric-top on heavy-symmetric-top"
std::string other_scenes_note(const std::vector<SolverClass>& classes) {
  std::string text;
  for (const SolverClass& of : classes)
    for (const SolverEntry& entry : of.entries)
      if (entry.scene != of.plan.scene)
        text += fmt::format("; {} has no closed form: {} is on {}", of.plan.scene, entry.scheme->name,
                            entry.scene);
  return text;
}

}  // namespace

output::Table solver_cost_table(const std::string& model, const std::vector<SolverClass>& classes) {
  output::Table table;
  table.caption = fmt::format("Cost of the schemes that choose their steps and of closed forms, {}", model);
  table.columns = {{"integrator", "integrator", Align::left}, {"order", "order", Align::left}};
  const std::string unit = classes.empty() ? "" : fmt::format(" [{}]", classes.front().unit);
  for (const SolverClass& of : classes)
    table.columns.push_back({"error_" + of.plan.key(), "error" + unit + ", " + of.plan.label});
  for (const SolverClass& of : classes)
    table.columns.push_back({"steps_" + of.plan.key(), "steps, " + of.plan.label});
  table.columns.push_back({"rates", "rates a step"});
  for (const SolverClass& of : classes)
    table.columns.push_back({"ns_" + of.plan.key(), "ns a step, " + of.plan.label});
  table.columns.push_back({"own_bound", "own bound"});
  for (const SchemeInfo* scheme : solvers_in(classes)) {
    std::vector<Cell> cells{std::string(scheme->name),
                            scheme->stepping == Stepping::closed_form ? "exact" : "variable"};
    for (const SolverClass& of : classes) cells.push_back(solver_error_cell(solver_in(of, scheme)));
    for (const SolverClass& of : classes) cells.push_back(steps_cell(solver_in(of, scheme)));
    cells.push_back(rates_cell(classes, scheme));
    for (const SolverClass& of : classes) cells.push_back(ns_cell(solver_in(of, scheme)));
    cells.push_back(own_bound_cell(classes, scheme));
    table.rows.push_back(std::move(cells));
  }
  table.notes = {fmt::format("tolerance {:g}; error: {} at the end of the scene{}", survey_tol,
                             classes.empty() ? "" : classes.front().metric, other_scenes_note(classes)),
                 "steps: those taken; time and evaluations of rejected ones are in those of a step; rates a "
                 "step: on the "
                 "last class; each takes the moment once",
                 "of a closed form the ns are those of an evaluation, and the bound is its own on the error",
                 unstable_note};
  if (std::string why = failures_note(classes); !why.empty()) table.notes.push_back("ended early: " + why);
  return table;
}

output::Table solver_stability_table(const std::string& model, const std::vector<SolverClass>& classes) {
  output::Table table;
  table.caption =
      fmt::format("What the schemes that choose their steps keep and where they break, {}", model);
  table.columns = {{"integrator", "integrator", Align::left}};
  const auto has_energy = [](const SolverClass& of) {
    return std::ranges::any_of(of.entries, [](const auto& entry) { return entry.energy.has_value(); });
  };
  for (const SolverClass& of : classes) {
    table.columns.push_back({"held_" + of.plan.key(), "held to roundoff, " + of.plan.label, Align::left});
    if (has_energy(of))
      table.columns.push_back({"energy_" + of.plan.key(), "energy, " + of.plan.label, Align::left});
    table.columns.push_back(
        {"off_at_tol_" + of.plan.key(), "off by 1 % at tolerance, " + of.plan.label, Align::left});
  }
  for (const SchemeInfo* scheme : solvers_in(classes)) {
    std::vector<Cell> cells{std::string(scheme->name)};
    for (const SolverClass& of : classes) {
      const SolverEntry* entry = solver_in(of, scheme);
      const std::size_t width = has_energy(of) ? 3 : 2;
      if (!entry || (!ended_well(entry) && width == 2)) {
        cells.insert(cells.end(), width, Cell());
        continue;
      }
      const std::string held = fmt::format("{}", fmt::join(entry->held, ", "));
      cells.push_back(ended_well(entry) ? Cell(held.empty() ? "none" : held) : Cell());
      if (width == 3) cells.push_back(solver_energy_cell(*entry));
      cells.push_back(loosest_cell(*entry));
    }
    table.rows.push_back(std::move(cells));
  }
  std::string runs;
  for (const SolverClass& of : classes)
    runs += fmt::format("{}{}: to t = {:g} s", runs.empty() ? "" : "; ", of.plan.label,
                        std::min(of.plan.t_end, 20'000.0 * of.plan.step));
  table.notes = {
      fmt::format(
          "held and energy: tolerance {:g}, {}; the energy with its largest drift, relative to its scale",
          survey_tol, runs),
      "undecided: no trend stands out, or the error grows below 1e-9, where long runs of roundoff may be; "
      "roundoff: at most 1e-12",
      "off by 1 % at: the first of the tolerances 1e-8, 1e-7 .. 0.1 that does not end well over 500 time "
      "scales (at most the long run of equal steps) or changes an invariant by a hundredth of its scale"};
  return table;
}

void add_solvers(const std::vector<SolverClass>& classes, nlohmann::ordered_json& list) {
  const auto number = [](double value) -> nlohmann::ordered_json {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
  };
  for (const SolverClass& of : classes)
    for (const SolverEntry& entry : of.entries) {
      const Row& run = entry.run;
      nlohmann::ordered_json item;
      item["integrator"] = entry.scheme->name;
      item["class"] = of.plan.label;
      item["scene"] = entry.scene;
      item["stepping"] = to_string(entry.scheme->stepping);
      item["tol"] = number(run.setting.tol.value_or(std::nan("")));
      item["status"] = to_string(ended_well(&entry) ? entry.status : run.result.status);
      item["message"] = run.result.message;
      item["error"] = number(run.error.empty() ? std::nan("") : run.error[0]);
      item["own_bound"] = number(entry.own_bound);
      item["steps"] = run.result.cost.steps;
      item["rejected"] = run.result.cost.rejected;
      item["rhs"] = run.result.cost.rhs;
      item["held"] = entry.held;
      if (entry.energy)
        item["energy"] = {{"verdict", to_string(entry.energy->verdict)},
                          {"max_drift", number(entry.energy->max_abs)},
                          {"slope", number(entry.energy->slope)}};
      item["loosest_tolerance_within_1_percent"] = number(entry.loosest.value_or(std::nan("")));
      item["off_by_1_percent_at_tolerance"] = number(entry.off_at.value_or(std::nan("")));
      item["off_how"] = entry.off_how;
      item[entry.scheme->stepping == Stepping::closed_form ? "ns_an_evaluation" : "ns_a_step"] =
          number(ns_of(entry));
      list.push_back(std::move(item));
    }
}

}  // namespace gnomon
