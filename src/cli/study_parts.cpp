#include "src/cli/study_parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "src/output/files.hpp"
#include "src/study/compare.hpp"
#include "src/study/figures.hpp"
#include "src/study/peers.hpp"
#include "src/study/present.hpp"
#include "src/study/published.hpp"
#include "src/study/scorecard.hpp"
#include "src/study/speed.hpp"
#include "src/study/static_refine.hpp"
#include "src/study/survey.hpp"
#include "src/study/vary_study.hpp"

namespace gnomon::cli {
namespace {

constexpr double run_limit = 300.0;  ///< s of one run

std::string command(const std::string& arguments, const StudyOptions& options = {}) {
  std::string text = "./gnomon " + arguments;
  if (options.quick) text += " --quick";
  if (!options.timing) text += " --no-timing";
  if (!options.integrators.empty())
    text += fmt::format(" --integrators {}", fmt::join(options.integrators, ","));
  return text;
}

/// The same for a command that draws a figure, with where it writes to: not every one does so unasked.
std::string drawing_command(const std::string& arguments, const StudyOptions& options) {
  return command(arguments, options) + " --out gnomon-out";
}

/// Those that a study of this length comes to.
std::vector<double> error_times(const DriftPlan& plan, double t_end) {
  std::vector<double> times = plan.error_times;
  std::erase_if(times, [&](double time) { return time > t_end; });
  return times;
}

}  // namespace

void PartMaker::plan(const StudyPlan& study, const std::string& model, std::vector<Part>& parts) {
  const auto scenes = [&](const std::vector<std::string>& names) {
    std::vector<Scene> list;
    for (const std::string& name : names) list.push_back(load_scene(context_.catalogue, name));
    return list;
  };
  StudyOptions options;
  options.quick = session_.quick;
  options.timing = session_.timed;
  options.time_limit = run_limit;

  const auto on = [&](const Scene& scene) {
    StudyOptions chosen = options;
    for (const std::string& name : study.integrators)
      if (context_.catalogue.pair(name, *scene.model)) chosen.integrators.push_back(name);
    return chosen;
  };

  const std::vector<Scene> carded = scenes(session_.quick ? study.quick_scorecard : study.scorecard);
  if (!carded.empty()) {
    std::vector<StudyOptions> card_options;
    std::size_t card_runs = 0;
    for (const Scene& scene : carded) {
      card_options.push_back(on(scene));
      card_runs += scorecard_runs(context_.catalogue, scene, card_options.back());
    }
    parts.push_back({model + "-scorecard", "Scorecard", card_runs, [=, this](output::Progress& progress) {
                       return make_scorecard(model, carded, card_options, progress);
                     }});
  }
  const std::vector<Scene> converging = scenes(session_.quick ? study.quick_converge : study.converge);
  std::size_t runs = 0;
  std::vector<StudyOptions> chosen;
  for (const Scene& scene : converging) {
    chosen.push_back(on(scene));
    runs += converge_runs(context_.catalogue, scene, chosen.back());
  }
  if (!converging.empty())
    parts.push_back({model + "-orders", "Order of convergence", runs, [=, this](output::Progress& progress) {
                       return make_orders(model, converging, chosen, progress);
                     }});
  for (const Scene& scene : scenes(session_.quick ? study.quick_compare : study.compare))
    parts.push_back({"compare-" + scene.name, "Work and precision: " + scene.name,
                     compare_runs(context_.catalogue, scene, on(scene)),
                     [=, this, chosen = on(scene)](output::Progress& progress) {
                       return make_comparison(scene, chosen, progress);
                     }});
  for (const WorkPlan& plan : study.work) {
    if (session_.quick) continue;
    const Scene scene = load_scene(context_.catalogue, plan.scene);
    StudyOptions planned = options;
    planned.integrators = plan.integrators;
    planned.steps = plan.steps;
    planned.explicit_steps = plan.explicit_steps;
    planned.tols = plan.tols;
    planned.time_limit = plan.time_limit;
    planned.timing_budget = plan.timing_budget;
    parts.push_back({"compare-" + scene.name, "Work and precision: " + scene.name,
                     compare_runs(context_.catalogue, scene, planned), [=, this](output::Progress& progress) {
                       return make_comparison(scene, planned, progress);
                     }});
  }
  for (const DriftPlan& plan : study.drift) {
    if (session_.quick && !plan.quick_t_end) continue;
    const bool ladder = plan.steps.size() > 1;
    const double t_end = session_.quick ? *plan.quick_t_end : plan.t_end;
    std::size_t before = 0;
    for (const double time : error_times(plan, t_end)) before += time < t_end ? 1 : 0;
    parts.push_back({(ladder ? "steps-" : "drift-") + plan.label,
                     (ladder ? "Large steps: " : "Drift: ") + plan.label,
                     plan.integrators.size() * plan.steps.size() * (1 + before),
                     [=, this](output::Progress& progress) { return make_drift(plan, progress); }});
  }
  for (const VaryPlan& plan : study.vary) {
    if (session_.quick && plan.full_only) continue;
    parts.push_back({"vary-" + plan.label, "Over one parameter: " + plan.label,
                     vary_runs(context_.catalogue, plan, options),
                     [=, this](output::Progress& progress) { return make_vary(plan, options, progress); }});
  }
  for (const StaticRefinePlan& plan : study.refine)
    parts.push_back({"refine-" + plan.label, "Error in space: " + plan.label, static_refine_runs(plan),
                     [=, this](output::Progress& progress) { return make_refine(plan, progress); }});
  if (!study.survey.empty())
    parts.push_back(
        {model + "-survey", "All schemes", survey_runs(context_.catalogue, study.survey, session_.quick),
         [=, this](output::Progress& progress) { return make_survey(model, study, options, progress); }});
  if (!options.timing) return;
  if (!study.speed.empty())
    parts.push_back({model + "-speed", "Speed", 1,
                     [=, this](output::Progress& progress) { return make_speed(model, study, progress); }});
  for (const PeerPlan& plan : study.peers)
    parts.push_back({"peers-" + plan.scene, "Against other libraries: " + plan.scene, 1,
                     [=, this](output::Progress& progress) { return make_peers(plan, progress); }});
}

bool PartMaker::make_orders(const std::string& model, const std::vector<Scene>& scenes,
                            const std::vector<StudyOptions>& options, output::Progress& progress) {
  Document document = new_document();
  std::vector<Convergence> studies;
  const std::size_t first = files_.sections();
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    studies.push_back(converge(runner_, scenes[k], options[k], progress));
    if (studies.back().interrupted) return false;
    document.add(studies.back());
    document.add_orders(studies.back().scene.name, studies.back().orders);
    Document own = new_document();
    own.add(studies.back());
    own.add_orders(studies.back().scene.name, studies.back().orders);
    files_.publish({"converge-" + scenes[k].name,
                    "Convergence: " + scenes[k].name,
                    drawing_command("converge " + scenes[k].name, options[k]),
                    {orders_table(studies.back()), runs_table(studies.back(), "Runs")},
                    convergence_figure(context_.catalogue, studies.back()),
                    {}},
                   own);
    files_.counts.add("converge-" + scenes[k].name, studies.back());
  }
  files_.publish({model + "-orders", "Order of convergence: " + model, "", {order_matrix(studies)}, {}, {}},
                 document);
  // It stands before the scenes that it sums up.
  files_.lead_with_last(first);
  return true;
}

bool PartMaker::make_comparison(const Scene& scene, const StudyOptions& options, output::Progress& progress) {
  const Comparison study = compare(runner_, scene, options, progress);
  if (study.interrupted) return false;
  Document document = new_document();
  document.add_comparison(study);
  output::Table costs = costs_table(study);
  costs.notes.push_back(sundials_line(context_.catalogue));
  std::string arguments = "compare " + scene.name;
  if (!options.steps.empty()) arguments += fmt::format(" --steps {:g}", fmt::join(options.steps, ","));
  if (!options.tols.empty()) arguments += fmt::format(" --tols {:g}", fmt::join(options.tols, ","));
  files_.publish({"compare-" + scene.name,
                  "Work and precision: " + scene.name,
                  drawing_command(arguments, options),
                  {costs, comparison_table(study, "Runs")},
                  work_precision_figure(context_.catalogue, study),
                  {}},
                 document);
  files_.counts.add("compare-" + scene.name, study);
  files_.fastest.add(study);
  return true;
}

bool PartMaker::make_drift(const DriftPlan& plan, output::Progress& progress) {
  SceneChanges changes;
  changes.t_end = session_.quick ? *plan.quick_t_end : plan.t_end;
  StudyOptions options;
  options.timing = session_.timed;
  options.time_limit = run_limit;
  options.integrators = plan.integrators;
  options.steps = plan.steps;
  if (plan.tol) options.tols = {*plan.tol};
  options.error_times = error_times(plan, *changes.t_end);
  const bool ladder = plan.steps.size() > 1;
  // With large steps the motions part; what is kept and how runs fail is shown.
  options.reference = !ladder || !options.error_times.empty();
  const DriftStudy study =
      drift(runner_, load_scene(context_.catalogue, plan.scene, changes), options, progress);
  if (study.interrupted) return false;
  Document document = new_document();
  document.add(study);
  document.add_drifts(study);
  std::vector<output::Table> tables{drift_table(study)};
  add_published(plan, tables.front());
  if (ladder) tables.insert(tables.begin(), drift_runs_table(study));
  std::string arguments = fmt::format("drift {} --t-end {:g} --step{} {:g}", plan.scene, *changes.t_end,
                                      ladder ? "s" : "", fmt::join(plan.steps, ","));
  if (plan.tol) arguments += fmt::format(" --tol {:g}", *plan.tol);
  if (!options.reference) arguments += " --no-reference";
  if (!options.error_times.empty())
    arguments += fmt::format(" --error-at {:g}", fmt::join(options.error_times, ","));
  const std::string name = (ladder ? "steps-" : "drift-") + plan.label;
  files_.publish({name,
                  (ladder ? "Large steps: " : "Drift: ") + plan.label,
                  drawing_command(arguments, options),
                  tables,
                  drift_figure(context_.catalogue, study, "energy"),
                  {}},
                 document);
  if (!ladder) files_.counts.add(name, study);
  return true;
}

bool PartMaker::make_vary(const VaryPlan& plan, const StudyOptions& options, output::Progress& progress) {
  const VariedStudy study = vary(runner_, plan, options, progress);
  if (study.interrupted) return false;
  Document document = new_document();
  study.add_to(document);
  StudyOptions named;
  named.quick = options.quick;
  named.timing = options.timing;
  named.integrators = plan.integrators;
  const std::string name = "vary-" + plan.label;
  files_.publish({name,
                  "Over one parameter: " + plan.label,
                  drawing_command(vary_command(plan), named),
                  study.tables(),
                  study.figure(context_.catalogue),
                  {}},
                 document);
  for (const Comparison& each : study.comparisons) files_.counts.add(name, each);
  return true;
}

bool PartMaker::make_refine(const StaticRefinePlan& plan, output::Progress& progress) {
  const StaticRefinement study = refine_static(runner_, plan, progress);
  if (study.interrupted) return false;
  Document document = new_document();
  document.json()["static_refine"] = static_refine_json(study);
  files_.publish({"refine-" + plan.label,
                  "Error in space: " + plan.label,
                  "",
                  {static_refine_table(study)},
                  static_refine_figure(study),
                  {}},
                 document);
  return true;
}

bool PartMaker::make_scorecard(const std::string& model, const std::vector<Scene>& scenes,
                               const std::vector<StudyOptions>& options, output::Progress& progress) {
  Document document = new_document();
  document.json()["scorecard"] = nlohmann::ordered_json::array();
  std::vector<Scorecard> cards;
  std::string names;
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    cards.push_back(gnomon::scorecard(runner_, scenes[k], options[k], progress));
    const Scorecard& card = cards.back();
    if (card.interrupted) return false;
    Document own = new_document();
    own.json()["scorecard"] = scorecard_json(card);
    for (const auto& item : own.json()["scorecard"]) document.json()["scorecard"].push_back(item);
    names += " " + scenes[k].name;
    output::Table table = scorecard_table(card);
    table.notes.push_back(sundials_line(context_.catalogue));
    files_.publish({"scorecard-" + scenes[k].name,
                    "Scorecard: " + scenes[k].name,
                    command("scorecard " + scenes[k].name, options[k]),
                    {table},
                    {},
                    {}},
                   own);
  }
  output::Table joint = joint_scorecard_table("Scorecard, " + model, cards);
  files_.publish({model + "-scorecard",
                  "Scorecard: " + model,
                  command("scorecard" + names, options.front()),
                  {joint},
                  {},
                  {}},
                 document);
  // On the page it is the first of all.
  joint.notes.push_back("made by " + command("scorecard" + names, options.front()));
  files_.summarise_last(std::move(joint));
  return true;
}

bool PartMaker::make_survey(const std::string& model, const StudyPlan& plan, const StudyOptions& options,
                            output::Progress& progress) {
  const Survey study = gnomon::survey(runner_, model, plan.survey, options, progress);
  if (study.interrupted) return false;
  Document document = new_document();
  document.json()["survey"] = survey_json(study);
  files_.publish({model + "-survey",
                  "All schemes: " + model,
                  command("survey " + model, options),
                  survey_tables(study),
                  {},
                  {}},
                 document);
  return true;
}

bool PartMaker::make_speed(const std::string& model, const StudyPlan& plan, output::Progress& progress) {
  progress.begin("speed of a step and of the wrapper, interleaved");
  const SpeedStudy study = measure_speed(runner_, plan.speed, plan.integrators, session_.quick);
  if (runner_.stopped()) return false;
  Document document = new_document();
  document.json()["speed"] = speed_json(study);
  std::vector<output::Table> tables{step_times_table(study)};
  if (!study.wrappers.empty()) {
    tables.push_back(wrapper_table(study));
    tables.back().notes.push_back(sundials_line(context_.catalogue));
  }
  for (output::Table& table : parts_tables(study)) tables.push_back(std::move(table));
  files_.publish({model + "-speed", "Speed: " + model, "", tables, {}, {}}, document);
  return true;
}

bool PartMaker::make_peers(const PeerPlan& plan, output::Progress& progress) {
  progress.begin(fmt::format("{} / time to given errors, interleaved", plan.scene));
  const PeerStudy study = measure_peers(runner_, plan, session_.quick);
  if (runner_.stopped()) return false;
  Document document = new_document();
  document.json()["peers"] = peers_json(study);
  files_.publish({"peers-" + plan.scene,
                  "Against other libraries: " + plan.scene,
                  "",
                  {peers_table(study), peer_runs_table(study)},
                  {},
                  {}},
                 document);
  return true;
}

Document PartMaker::new_document() const {
  Document document(context_.catalogue, "bench");
  document.json()["environment"] = session_.environment;
  return document;
}

}  // namespace gnomon::cli
