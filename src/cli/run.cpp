#include <fmt/format.h>
#include <fmt/ranges.h>
#include <cmath>

#include <iostream>

#include "src/cli/command.hpp"
#include "src/cli/files.hpp"
#include "src/error.hpp"
#include "src/study/present.hpp"

namespace gnomon::cli {
namespace {

/// The setting of the one run, and what is wrong with it.
Setting read_setting(const SchemeInfo& scheme, const StudyOptions& options) {
  const bool step = !options.steps.empty(), tol = !options.tols.empty();
  if (step && tol) throw UsageError("--tol: found both --step and --tol, expected only one of them");
  switch (scheme.stepping) {
    case Stepping::fixed:
      if (!step)
        throw UsageError(fmt::format("--step: found {}, expected --step H because {} takes equal steps",
                                     tol ? "--tol" : "nothing", scheme.name));
      return {options.steps[0], std::nullopt};
    case Stepping::adaptive:
      if (!tol)
        throw UsageError(fmt::format("--tol: found {}, expected --tol X because {} chooses its own steps",
                                     step ? "--step" : "nothing", scheme.name));
      return {std::nullopt, options.tols[0]};
    case Stepping::closed_form:
      break;
  }
  if (step || tol)
    throw UsageError(
        fmt::format("{0}: found {0}, expected neither --step nor --tol because {1} is a closed form",
                    step ? "--step" : "--tol", scheme.name));
  return {};
}

output::Table series_table(const SceneStudy& study) {
  const RunResult& result = study.rows.front().result;
  output::Table table;
  table.columns = {{"t_s", "t [s]"}};
  for (std::size_t k = 0; k < result.samples.size(); ++k) {
    std::vector<output::Cell> cells{output::number_cell(result.sample_times[k], 17)};
    for (const Named& component : study.scene.model->observe(result.samples[k]))
      for (std::size_t i = 0; i < component.values.size(); ++i) {
        if (k == 0) table.columns.push_back({fmt::format("{}_{}", component.name, i), component.name});
        cells.push_back(output::number_cell(component.values[i], 17));
      }
    for (const Probe& probe : study.scene.model->probes(result.samples[k]))
      for (const auto& [component, value] : probe.components) {
        if (k == 0)
          table.columns.push_back(
              {fmt::format("{}_{}", probe.name, component), fmt::format("{} {}", probe.name, component)});
        cells.push_back(output::number_cell(value, 17));
      }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

std::string list_of(const std::vector<double>& values) {
  return fmt::format("({:.15g})", fmt::join(values, ", "));
}

void print(const Request& request, const SceneStudy& study) {
  const Row& row = study.rows.front();
  const RunResult& result = row.result;
  const AnyModel& model = *study.scene.model;
  say(request, fmt::format("{} / {}, {}: {}{}{}", study.scene.name, row.scheme->name, row.setting.text(),
                           to_string(result.status), result.message.empty() ? "" : ", ", result.message));
  say(request, fmt::format("t = {:.10g} s{}", result.t,
                           result.step ? fmt::format(", step used {:.10g} s", *result.step) : ""));
  for (const std::string& flag : result.flags) say(request, "flag: " + flag);
  for (const Named& component : model.observe(result.state))
    say(request, fmt::format("  {:<20} {}", component.name, list_of(component.values)));
  for (const Probe& probe : model.probes(result.state))
    for (const auto& [component, value] : probe.components)
      say(request, fmt::format("  {:<20} {:.15g}", probe.name + " " + component, value));
  say(request, reference_line(study));
  for (std::size_t k = 0; k < row.error.size(); ++k) {
    const MetricInfo metric = model.metrics()[k];
    say(request, fmt::format("  error {:<14} {} {}", metric.name,
                             row.below_bound[k] ? output::at_most(row.error[k], 2)
                                                : fmt::format("{:.4e}", row.error[k]),
                             metric.unit == "1" ? "(relative)" : metric.unit));
  }
  for (std::size_t k = 0; k < result.own_bound.size(); ++k)
    say(request, fmt::format("  own bound {:<10} {}", model.metrics()[k].name,
                             output::at_most(result.own_bound[k], 2)));
  for (const InvariantSummary& invariant : row.invariants)
    say(request,
        fmt::format("  drift {:<20} at most {:.3e} of {:.6g}, slope {}", invariant.info.name,
                    invariant.max_drift, invariant.info.scale,
                    std::isfinite(invariant.slope) ? fmt::format("{:.2e} 1/s", invariant.slope) : "—"));
  const Cost& cost = result.cost;
  say(request, fmt::format("cost: {} steps, {} rejected, {} rate evaluations, {} moments, {} Jacobians, "
                           "{} factorisations, {} Newton iterations",
                           cost.steps, cost.rejected, cost.rhs, cost.moments, cost.jacobians,
                           cost.factorizations, cost.newton_iterations));
  if (row.timing)
    say(request, fmt::format("CPU time: median {:.4g} us, {:.4g} to {:.4g} us in {} repetitions{}",
                             1e6 * row.timing->median, 1e6 * row.timing->min, 1e6 * row.timing->max,
                             row.timing->repetitions, row.timing->unstable ? " (unstable)" : ""));
}

/// CSV and LaTeX on standard output have no place for flags, and nothing else is printed there.
void tell_flags(const Request& request, const RunResult& result, int samples) {
  if (request.quiet || (request.csv != "-" && request.latex != "-")) return;
  for (const std::string& flag : result.flags) std::cerr << "gnomon: flag: " << flag << '\n';
  const std::size_t asked = static_cast<std::size_t>(samples) + 1;
  if (result.status == Status::ok && samples > 0 && result.samples.size() < asked)
    std::cerr << fmt::format("gnomon: found {} states to keep in {} steps, asked for were {}\n",
                             result.samples.size(), result.cost.steps, asked);
}

}  // namespace

int run(Context& context) {
  const Request& request = context.request;
  const std::string one_name = "expected the name of one integrator";
  if (request.integrators.find(',') != std::string::npos)
    throw UsageError(fmt::format("--integrator: found '{}', {}", request.integrators, one_name));
  StudyOptions options = study_options(request);
  if (request.scenes.size() > 1)
    throw UsageError(fmt::format("run: found {} scenes, expected one", request.scenes.size()));
  SceneStudy study;
  study.scene = std::move(load_scenes(context).front());
  if (options.integrators.empty()) throw UsageError("--integrator: found nothing, " + one_name);
  const SchemeInfo& scheme = *select(context.catalogue, study.scene, options, "--integrator").front();
  const Setting setting = read_setting(scheme, options);
  check_scheme_options(context, {study.scene}, options);
  warn({study.scene});
  if (setting.step && *setting.step > study.scene.t_end * (1.0 + 1e-9) && !request.quiet)
    std::cerr << fmt::format("gnomon: --step: {:g} s is longer than the run, which is one step of {:g} s\n",
                             *setting.step, study.scene.t_end);

  ReferenceStore references(reference_folder(), true);
  Runner runner(context.catalogue, references, context.stop);
  study.reference = runner.reference(study.scene, options);
  study.rows.push_back(runner.run(study.scene, study.reference, scheme, setting, options));
  const RunResult& result = study.rows.front().result;
  if (result.status == Status::ok && options.timing) {
    // A long run is its own measurement; a short one is repeated.
    if (result.cpu_seconds > 1.0)
      study.rows.front().timing = summarise({result.cpu_seconds});
    else
      runner.time(study.scene, study.rows, options);
  }
  print(request, study);
  tell_flags(request, result, options.samples);
  Document document(context.catalogue, "run");
  document.add(study);
  const output::Table table = result.samples.empty() ? runs_table(study, "") : series_table(study);
  if (!request.out.empty())
    for (const std::string& file :
         write_study(request.out, "run-" + study.scene.name, {table}, document, std::nullopt, ""))
      say(request, "wrote " + file);
  write_outputs(request, document, {table});
  if (result.status == Status::interrupted || runner.stopped()) return interrupted;
  if (result.status == Status::ok) return done;
  std::cerr << fmt::format("gnomon: {} / {}: {}: {}\n", study.scene.name, scheme.name,
                           to_string(result.status), result.message);
  return run_failed;
}

}  // namespace gnomon::cli
