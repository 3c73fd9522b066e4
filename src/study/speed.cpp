#include "src/study/speed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gnomon {
namespace {

/// What the two give, not yet timed.
nlohmann::ordered_json try_out(const Yardstick& yardstick, const void* model, const RunSpec& spec,
                               RunResult (*run)(const void*, const RunSpec&)) {
  const RunResult wrapped = run(model, spec);
  std::vector<double> plain;
  long evaluations = 0;
  yardstick.run(model, spec.t_end, yardstick.setting(), plain, evaluations);
  double difference = 0.0;
  for (std::size_t k = 0; k < plain.size(); ++k)
    difference = std::max(difference, std::abs(plain[k] - wrapped.state[k]));
  return {{"evaluations", wrapped.cost.rhs}, {"plain_evaluations", evaluations}, {"difference", difference}};
}

WrapperTime measure(Runner& runner, const Yardstick& yardstick) {
  const Scene scene = load_scene(runner.catalogue(), std::string(yardstick.scene));
  const auto run = runner.catalogue().pair(yardstick.integrator, *scene.model)->run;
  const void* model = scene.model->get();
  RunSpec spec;
  spec.t_end = scene.t_end;
  if (yardstick.tol > 0.0)
    spec.tol = yardstick.tol;
  else
    spec.step = yardstick.step;
  spec.record = false;

  const nlohmann::ordered_json identity{
      {"scene", scene.name}, {"physics", scene.physics_hash()}, {"setting", yardstick.setting()}};
  const std::vector<std::string> names{std::string(yardstick.integrator), std::string(yardstick.name)};
  const auto tried = runner.measure("wrapper", {{"of", identity}, {"names", names}}, false,
                                    [&] { return try_out(yardstick, model, spec, run); });
  WrapperTime time{&yardstick, 0, 0, 0.0, {}, {}};
  if (!tried.is_null()) {
    time.evaluations = tried.at("evaluations");
    time.plain_evaluations = tried.at("plain_evaluations");
    time.difference =
        tried.at("difference").is_number() ? tried.at("difference").get<double>() : std::nan("");
  }
  const std::vector<TimedTask> tasks{{[&] { return run(model, spec).cpu_seconds; }}, {[&] {
                                       std::vector<double> state;
                                       long evaluations = 0;
                                       return yardstick.run(model, spec.t_end, yardstick.setting(), state,
                                                            evaluations);
                                     }}};
  TimingPlan plan;
  plan.repetitions = 11;
  const auto stats = runner.time("wrapper times", identity, names, tasks, plan);
  time.wrapped = stats[0];
  time.plain = stats[1];
  return time;
}

void measure_parts(Runner& runner, const std::vector<Scene>& scenes, const TimingPlan& plan, bool quick,
                   std::vector<PartTime>& parts) {
  std::vector<TimedTask> tasks;
  std::vector<std::string> names;
  for (const PartTask& task : runner.catalogue().parts) {
    const auto is_of = [&](const Scene& scene) { return scene.model_name == task.model; };
    if (std::none_of(scenes.begin(), scenes.end(), is_of) || (quick && task.full_only)) continue;
    parts.push_back({&task, {}});
    names.push_back(fmt::format("{}: {}, {} {}", task.part, task.variant, task.size, task.size_name));
    tasks.push_back({[&task] { return task.run(task.index, task.size); }});
  }
  if (tasks.empty()) return;
  const auto stats = runner.time("part times", {}, names, tasks, plan);
  for (std::size_t k = 0; k < parts.size(); ++k) parts[k].run = stats[k];
}

/// What it costs a step to keep the energy: the schemes differ in that alone. Empty where there are not both.
std::string repair_costs(const SpeedStudy& study) {
  std::string text;
  for (const StepTime& repaired : study.steps) {
    if (repaired.scheme->name != "beam-energy-momentum") continue;
    const auto documented = std::ranges::find_if(study.steps, [&](const StepTime& time) {
      return time.scheme->name == "beam-midpoint" && time.scene == repaired.scene &&
             time.step == repaired.step && time.parts == repaired.parts &&
             time.instructions == repaired.instructions;
    });
    if (documented == study.steps.end() || !(documented->ns() > 0.0)) continue;
    text += fmt::format("{}{} at {} {}", text.empty() ? "beam-energy-momentum / beam-midpoint: " : ", ",
                        output::number(repaired.ns() / documented->ns(), 3), repaired.parts,
                        repaired.instructions.empty() ? "parts" : "parts, " + repaired.instructions);
  }
  return text;
}

std::string unstable_mark(const TimingStats& stats) { return stats.unstable ? "*" : ""; }

}  // namespace

SpeedStudy measure_speed(Runner& runner, const std::vector<SpeedPlan>& plans,
                         const std::vector<std::string>& integrators, bool quick) {
  SpeedStudy study;
  std::vector<Scene> scenes;
  std::vector<TimedTask> tasks;
  std::vector<std::string> names;
  const auto add = [&](const SpeedPlan& plan, const std::string& instructions) {
    SceneChanges changes;
    changes.t_end = plan.step * static_cast<double>(plan.steps);
    changes.set = plan.set;
    if (!instructions.empty())
      changes.set.push_back(fmt::format("{}=\"{}\"", plan.instructions_key, instructions));
    scenes.push_back(load_scene(runner.catalogue(), plan.scene, changes));
    for (const SchemeInfo* scheme : runner.catalogue().schemes_for(*scenes.back().model)) {
      if (scheme->stepping == Stepping::adaptive) continue;
      const std::vector<std::string>& shown = plan.integrators.empty() ? integrators : plan.integrators;
      if (!shown.empty() && std::ranges::find(shown, scheme->name) == shown.end()) continue;
      const bool closed = scheme->stepping == Stepping::closed_form;
      RunSpec spec;
      spec.t_end = scenes.back().t_end;
      if (!closed) spec.step = plan.step;
      spec.record = false;
      spec.scheme.newton_tol = plan.newton_tol;
      const auto run = runner.catalogue().pair(scheme->name, *scenes.back().model)->run;
      const std::shared_ptr<const AnyModel> model = scenes.back().model;
      tasks.push_back({[=] {
        const RunResult result = run(model->get(), spec);
        return result.status == Status::ok ? result.cpu_seconds : std::nan("");
      }});
      names.push_back(fmt::format("{} {}, {}, {:.17g}, {:.17g}", plan.scene, scenes.back().physics_hash(),
                                  scheme->name, spec.step.value_or(0.0), plan.newton_tol));
      study.steps.push_back({plan.scene,
                             std::string(model->load_class()),
                             scheme,
                             plan.step,
                             closed ? 1 : plan.steps,
                             plan.parts,
                             instructions,
                             {}});
    }
  };
  for (const SpeedPlan& plan : plans) {
    if (quick && plan.full_only) continue;
    if (plan.instructions_key.empty()) {
      add(plan, "");
    } else {
      for (const std::string& name : plan.instructions()) add(plan, name);
    }
  }
  TimingPlan plan;
  plan.repetitions = 7;
  if (quick) plan.min_seconds = 0.005;
  const auto stats = runner.time("step times", {}, names, tasks, plan);
  for (std::size_t k = 0; k < stats.size(); ++k) study.steps[k].run = stats[k];
  const auto is_planned = [&](const Yardstick& yardstick) {
    const std::string model = load_scene(runner.catalogue(), std::string(yardstick.scene)).model_name;
    return std::any_of(scenes.begin(), scenes.end(),
                       [&](const Scene& scene) { return scene.model_name == model; });
  };
  for (const Yardstick& yardstick : runner.catalogue().yardsticks)
    if (is_planned(yardstick)) study.wrappers.push_back(measure(runner, yardstick));
  measure_parts(runner, scenes, plan, quick, study.parts);
  return study;
}

output::Table step_times_table(const SpeedStudy& study) {
  output::Table table;
  const bool parts = std::any_of(study.steps.begin(), study.steps.end(),
                                 [](const StepTime& time) { return time.parts != 1.0; });
  const bool sets = std::any_of(study.steps.begin(), study.steps.end(),
                                [](const StepTime& time) { return !time.instructions.empty(); });
  long shortest = 0;
  bool closed_forms = false;
  for (const StepTime& time : study.steps) {
    if (time.scheme->stepping == Stepping::closed_form)
      closed_forms = true;
    else if (shortest == 0 || time.steps < shortest)
      shortest = time.steps;
  }
  table.caption = parts ? "Time of one step, one core" : "Time of one step, one body, one core";
  table.columns = {{"integrator", "integrator", output::Align::left},
                   {"scene", "scene", output::Align::left},
                   {"load", "load", output::Align::left},
                   {"ns_median", "median [ns]"},
                   {"ns_min", "least [ns]"},
                   {"ns_max", "most [ns]"},
                   {"repetitions", "repetitions"}};
  if (parts) {
    table.columns.push_back({"parts", "parts"});
    table.columns.push_back({"ns_part", "a part [ns]"});
  }
  if (sets) {
    table.columns.push_back({"parts_per_second", "parts a second"});
    table.columns.insert(table.columns.begin() + 3, {"instructions", "instructions", output::Align::left});
  }
  for (const StepTime& time : study.steps) {
    const double scale = 1e9 / static_cast<double>(time.steps);
    output::Cell median = output::number_cell(time.ns());
    median.text += unstable_mark(time.run);
    table.rows.push_back({std::string(time.scheme->name), time.scene, time.load, median,
                          output::number_cell(scale * time.run.min),
                          output::number_cell(scale * time.run.max),
                          output::count_cell(time.run.repetitions)});
    if (parts) {
      table.rows.back().push_back(output::count_cell(std::llround(time.parts)));
      table.rows.back().push_back(output::number_cell(time.ns() / time.parts, 3));
    }
    if (sets) {
      table.rows.back().push_back(output::number_cell(1e9 * time.parts / time.ns(), 3));
      table.rows.back().insert(table.rows.back().begin() + 3, time.instructions);
    }
  }
  table.notes.push_back(
      fmt::format("runs of {}{} steps, interleaved; {}", parts ? "at least " : "", shortest, unstable_note));
  if (const std::string costs = repair_costs(study); !costs.empty()) table.notes.push_back(costs);
  if (closed_forms)
    table.notes.push_back("a closed form: one evaluation, what is worked out once a body apart");
  return table;
}

output::Table wrapper_table(const SpeedStudy& study) {
  output::Table table;
  table.caption = "Cost of the wrapper: gnomon's run against the same integration without it";
  table.columns = {{"integrator", "integrator", output::Align::left},
                   {"plain", "against", output::Align::left},
                   {"scene", "scene", output::Align::left},
                   {"setting", "setting", output::Align::left},
                   {"wrapped_us", "gnomon [us]"},
                   {"plain_us", "plain [us]"},
                   {"ratio", "ratio"},
                   {"evaluations", "evaluations"},
                   {"plain_evaluations", "plain"},
                   {"difference", "difference of the results"}};
  for (const WrapperTime& time : study.wrappers)
    table.rows.push_back(
        {std::string(time.yardstick->integrator), std::string(time.yardstick->name),
         std::string(time.yardstick->scene),
         fmt::format("{} {:g}", time.yardstick->tol > 0.0 ? "tol" : "step", time.yardstick->setting()),
         output::number_cell(1e6 * time.wrapped.median, 4), output::number_cell(1e6 * time.plain.median, 4),
         output::number_cell(time.ratio(), 3), output::count_cell(time.evaluations),
         output::count_cell(time.plain_evaluations), output::number_cell(time.difference, 2)});
  table.notes.push_back("medians of 11 interleaved repetitions; the ratio is that of the medians");
  return table;
}

namespace {

output::Table parts_table(const SpeedStudy& study, std::string_view part) {
  output::Table table;
  table.columns = {{"variant", std::string(part), output::Align::left}};
  for (const PartTime& time : study.parts) {
    if (time.task->part != part) continue;
    table.caption = fmt::format("{}, by {}", time.task->what, part);
    const std::string key = fmt::format("us_{}", time.task->size);
    const auto has = [&](const output::Column& column) { return column.key == key; };
    if (std::none_of(table.columns.begin(), table.columns.end(), has))
      table.columns.push_back({key, fmt::format("{} {} [us]", time.task->size, time.task->size_name)});
    if (table.rows.empty() || table.rows.back().front().text != time.task->variant)
      table.rows.push_back({std::string(time.task->variant)});
    output::Cell median = output::number_cell(1e6 * time.run.median, 3);
    median.text += unstable_mark(time.run);
    table.rows.back().push_back(median);
  }
  table.notes.push_back(
      "medians, interleaved, one core; where there is a pattern, it is analysed beforehand, with the same "
      "pivots where they serve; * repetitions differ by more than 5 % (median deviation)");
  return table;
}

}  // namespace

std::vector<output::Table> parts_tables(const SpeedStudy& study) {
  std::vector<output::Table> tables;
  std::vector<std::string_view> parts;
  for (const PartTime& time : study.parts) {
    if (std::ranges::find(parts, time.task->part) != parts.end()) continue;
    parts.push_back(time.task->part);
    tables.push_back(parts_table(study, parts.back()));
  }
  return tables;
}

nlohmann::ordered_json speed_json(const SpeedStudy& study) {
  nlohmann::ordered_json json;
  for (const StepTime& time : study.steps)
    json["steps"].push_back(
        {{"integrator", time.scheme->name},
         {"scene", time.scene},
         {"step", time.step},
         {"parts", time.parts},
         {"instructions",
          time.instructions.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(time.instructions)},
         {"ns_median", time.ns()},
         {"repetitions", time.run.repetitions},
         {"unstable", time.run.unstable}});
  for (const PartTime& time : study.parts)
    json["parts"].push_back({{"part", time.task->part},
                             {"variant", time.task->variant},
                             {"size", time.task->size},
                             {"us_median", 1e6 * time.run.median},
                             {"repetitions", time.run.repetitions},
                             {"unstable", time.run.unstable}});
  for (const WrapperTime& time : study.wrappers)
    json["wrappers"].push_back({{"integrator", time.yardstick->integrator},
                                {"plain", time.yardstick->name},
                                {"scene", time.yardstick->scene},
                                {"ratio", time.ratio()},
                                {"evaluations", time.evaluations},
                                {"plain_evaluations", time.plain_evaluations},
                                {"difference", time.difference}});
  return json;
}

}  // namespace gnomon
