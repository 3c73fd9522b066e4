#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <functional>
#include <iostream>

#include "src/cli/command.hpp"
#include "src/cli/files.hpp"
#include "src/environment.hpp"
#include "src/error.hpp"
#include "src/output/files.hpp"
#include "src/study/compare.hpp"
#include "src/study/peers.hpp"
#include "src/study/present.hpp"
#include "src/study/published.hpp"
#include "src/study/speed.hpp"
#include "src/study/survey.hpp"

namespace gnomon::cli {
namespace {

namespace fs = std::filesystem;

/// A part of the study: it writes files of its own and is skipped when an earlier call with the same program
/// and plan has finished it.
struct Part {
  std::string name;     ///< also the stem of its files
  std::string heading;  ///< in the index
  std::size_t runs;
  std::function<bool(output::Progress&)> make;  ///< false: interrupted, nothing written
};

class Study {
 public:
  Study(Context& context)
      : context_(context),
        request_(context.request),
        references_(reference_folder()),
        runner_(context.catalogue, references_, context.stop) {
    const std::string results = std::string(GNOMON_SOURCE_DIR) + "/results";
    folder_ = !request_.out.empty() ? request_.out : request_.quick ? results + "/quick" : results;
    published_ = fs::weakly_canonical(folder_) == fs::weakly_canonical(results);
    for (const std::string& file : context.catalogue.study_files) plan(read_study(file), file);
  }

  int run() {
    const std::string program = hash_text(output::read_file("/proc/self/exe"));
    std::vector<const Part*> open;
    std::size_t runs = 0, known = 0;
    for (const Part& part : parts_) {
      if (!request_.fresh && finished(part, program)) {
        ++known;
        continue;
      }
      open.push_back(&part);
      runs += part.runs;
    }
    if (known > 0)
      std::cerr << fmt::format(
          "gnomon: {} of {} parts are there from an earlier call (--fresh makes them again)\n", known,
          parts_.size());
    output::Progress progress(runs, output::progress_mode(request_.quiet), std::cerr);
    for (const Part* part : open) {
      if (context_.stop.load() || !part->make(progress)) {
        progress.finish();
        std::cerr << "gnomon: interrupted; the finished parts are kept and the next call goes on from them\n";
        return interrupted;
      }
      output::write_file_atomically(stamp(*part), program);
    }
    progress.finish();
    write_index();
    if (published_) update_readme();
    return done;
  }

 private:
  void plan(const StudyPlan& study, const std::string& file) {
    const std::string model = fs::path(file).parent_path().filename().string();
    const auto scenes = [&](const std::vector<std::string>& names) {
      std::vector<Scene> list;
      for (const std::string& name : names) list.push_back(load_scene(context_.catalogue, name));
      return list;
    };
    StudyOptions options;
    options.quick = request_.quick;

    const auto on = [&](const Scene& scene) {
      StudyOptions chosen = options;
      for (const std::string& name : study.integrators) {
        if (!context_.catalogue.scheme(name))
          throw UsageError(fmt::format("{}: integrators: found the unknown name '{}'", file, name));
        if (context_.catalogue.pair(name, *scene.model)) chosen.integrators.push_back(name);
      }
      return chosen;
    };

    const std::vector<Scene> converging = scenes(request_.quick ? study.quick_converge : study.converge);
    std::size_t runs = 0;
    std::vector<StudyOptions> chosen;
    for (const Scene& scene : converging) {
      chosen.push_back(on(scene));
      runs += converge_runs(context_.catalogue, scene, chosen.back());
    }
    if (!converging.empty())
      parts_.push_back(
          {model + "-orders", "Order of convergence", runs, [=, this](output::Progress& progress) {
             return make_orders(model, converging, chosen, progress);
           }});
    for (const Scene& scene : scenes(request_.quick ? study.quick_compare : study.compare))
      parts_.push_back({"compare-" + scene.name, "Work and precision: " + scene.name,
                        compare_runs(context_.catalogue, scene, on(scene)),
                        [=, this, chosen = on(scene)](output::Progress& progress) {
                          return make_comparison(scene, chosen, progress);
                        }});
    for (const DriftPlan& plan : study.drift) {
      if (request_.quick && !plan.quick_t_end) continue;
      const bool ladder = plan.steps.size() > 1;
      parts_.push_back({(ladder ? "steps-" : "drift-") + plan.scene,
                        (ladder ? "Large steps: " : "Drift: ") + plan.scene,
                        plan.integrators.size() * plan.steps.size(),
                        [=, this](output::Progress& progress) { return make_drift(plan, progress); }});
    }
    if (!study.survey.empty())
      parts_.push_back({model + "-survey", "All schemes of equal steps",
                        survey_runs(context_.catalogue, study.survey), [=, this](output::Progress& progress) {
                          return make_survey(model, study.survey, options, progress);
                        }});
    parts_.push_back({model + "-speed", "Speed", 1,
                      [=, this](output::Progress& progress) { return make_speed(model, study, progress); }});
    for (const PeerPlan& plan : study.peers)
      parts_.push_back({"peers-" + plan.scene, "Against other libraries: " + plan.scene, 1,
                        [=, this](output::Progress& progress) { return make_peers(plan, progress); }});
  }

  bool make_orders(const std::string& model, const std::vector<Scene>& scenes,
                   const std::vector<StudyOptions>& options, output::Progress& progress) {
    Document document(context_.catalogue, "bench");
    std::vector<Convergence> studies;
    for (std::size_t k = 0; k < scenes.size(); ++k) {
      studies.push_back(converge(runner_, scenes[k], options[k], progress));
      if (studies.back().interrupted) return false;
      document.add(studies.back());
      document.add_orders(studies.back().scene.name, studies.back().orders);
      Document own(context_.catalogue, "bench");
      own.add(studies.back());
      own.add_orders(studies.back().scene.name, studies.back().orders);
      write_study(folder_, "converge-" + scenes[k].name,
                  {orders_table(studies.back()), runs_table(studies.back(), "Runs")}, own,
                  convergence_figure(context_.catalogue, studies.back()),
                  command("converge " + scenes[k].name, options[k]));
    }
    write_study(folder_, model + "-orders", {order_matrix(studies)}, document, std::nullopt, "");
    return true;
  }

  bool make_comparison(const Scene& scene, const StudyOptions& options, output::Progress& progress) {
    const Comparison study = compare(runner_, scene, options, progress);
    if (study.interrupted) return false;
    Document document(context_.catalogue, "bench");
    document.add_comparison(study);
    output::Table costs = costs_table(study);
    costs.notes.push_back(sundials_line(context_.catalogue));
    write_study(folder_, "compare-" + scene.name, {costs, comparison_table(study, "Runs")}, document,
                work_precision_figure(context_.catalogue, study), command("compare " + scene.name, options));
    return true;
  }

  bool make_drift(const DriftPlan& plan, output::Progress& progress) {
    SceneChanges changes;
    changes.t_end = request_.quick ? *plan.quick_t_end : plan.t_end;
    StudyOptions options;
    options.integrators = plan.integrators;
    options.steps = plan.steps;
    if (plan.tol) options.tols = {*plan.tol};
    // With large steps the motions part; what is kept and how runs fail is shown.
    const bool ladder = plan.steps.size() > 1;
    options.reference = !ladder;
    const DriftStudy study =
        drift(runner_, load_scene(context_.catalogue, plan.scene, changes), options, progress);
    if (study.interrupted) return false;
    Document document(context_.catalogue, "bench");
    document.add(study);
    document.add_drifts(study);
    std::vector<output::Table> tables{drift_table(study)};
    if (ladder) tables.insert(tables.begin(), drift_runs_table(study));
    std::string arguments = fmt::format("drift {} --t-end {:g} --step{} {:g}", plan.scene, *changes.t_end,
                                        ladder ? "s" : "", fmt::join(plan.steps, ","));
    if (plan.tol) arguments += fmt::format(" --tol {:g}", *plan.tol);
    if (ladder) arguments += " --no-reference";
    write_study(folder_, (ladder ? "steps-" : "drift-") + plan.scene, tables, document,
                drift_figure(context_.catalogue, study, "energy"), command(arguments, options));
    return true;
  }

  bool make_survey(const std::string& model, const std::vector<SurveyPlan>& plans,
                   const StudyOptions& options, output::Progress& progress) {
    const Survey study = gnomon::survey(runner_, model, plans, options, progress);
    if (study.interrupted) return false;
    Document document(context_.catalogue, "bench");
    document.json()["survey"] = survey_json(study);
    write_study(folder_, model + "-survey", {survey_cost_table(study), survey_stability_table(study)},
                document, std::nullopt, command("survey " + model));
    return true;
  }

  bool make_speed(const std::string& model, const StudyPlan& plan, output::Progress& progress) {
    progress.begin("speed of a step and of the wrapper, interleaved");
    const SpeedStudy study = measure_speed(runner_, plan.speed, plan.integrators, request_.quick);
    if (runner_.stopped()) return false;
    Document document(context_.catalogue, "bench");
    document.json()["speed"] = speed_json(study);
    std::vector<output::Table> tables{step_times_table(study)};
    if (!study.wrappers.empty()) {
      tables.push_back(wrapper_table(study));
      tables.back().notes.push_back(sundials_line(context_.catalogue));
    }
    write_study(folder_, model + "-speed", tables, document, std::nullopt, "");
    return true;
  }

  bool make_peers(const PeerPlan& plan, output::Progress& progress) {
    progress.begin(fmt::format("{} / time to given errors, interleaved", plan.scene));
    const PeerStudy study = measure_peers(runner_, plan, request_.quick);
    if (runner_.stopped()) return false;
    Document document(context_.catalogue, "bench");
    document.json()["peers"] = peers_json(study);
    write_study(folder_, "peers-" + plan.scene, {peers_table(study), peer_runs_table(study)}, document,
                std::nullopt, "");
    return true;
  }

  static std::string command(const std::string& arguments, const StudyOptions& options = {}) {
    if (options.integrators.empty()) return fmt::format("`./gnomon {}`\n\n", arguments);
    return fmt::format("`./gnomon {} --integrators {}`\n\n", arguments, fmt::join(options.integrators, ","));
  }

  std::string stamp(const Part& part) const {
    return fmt::format("{}/bench/{}/{}", GNOMON_BINARY_DIR, hash_text(fs::absolute(folder_).string()),
                       part.name + (request_.quick ? "-quick" : ""));
  }
  bool finished(const Part& part, const std::string& program) const {
    try {
      return fs::exists(fmt::format("{}/{}.md", folder_, part.name)) &&
             output::read_file(stamp(part)) == program;
    } catch (const std::exception&) {
      return false;
    }
  }

  void write_index() const {
    const nlohmann::ordered_json machine = environment(context_.catalogue);
    std::string text = "# Results\n\nWritten by `./gnomon bench";
    text += request_.quick ? " --quick`.\n\n" : "`.\n\n";
    for (const auto& [key, value] : machine.items())
      text += fmt::format("- {}: {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
    for (const Part& part : parts_) {
      text += fmt::format("\n## {}\n\n", part.heading);
      const std::string content = output::read_file(fmt::format("{}/{}.md", folder_, part.name));
      // The table of runs is in the part's own page.
      text += content.substr(0, content.find("**Runs**"));
      text +=
          fmt::format("\nAll of it: [{0}.md]({0}.md), [{0}.csv]({0}.csv), [{0}.json]({0}.json)\n", part.name);
    }
    output::write_file_atomically(folder_ + "/README.md", text);
    for (const Part& part : parts_)
      if (part.name.ends_with("-orders") || part.name.ends_with("-speed") ||
          part.name.starts_with("peers-")) {
        const std::string content = output::read_file(fmt::format("{}/{}.md", folder_, part.name));
        say(request_, content.substr(0, content.find("**Runs**")));
      }
    say(request_,
        fmt::format("wrote {} parts to {}; start with {}/README.md", parts_.size(), folder_, folder_));
  }

  void update_readme() const {
    const std::string path = std::string(GNOMON_SOURCE_DIR) + "/README.md";
    std::string text = output::read_file(path);
    for (const Part& part : parts_) {
      const std::string content = output::read_file(fmt::format("{}/{}.md", folder_, part.name));
      std::string shown = content.substr(0, content.find("**Runs**"));
      if (const std::size_t table = shown.find("**"); table != std::string::npos) shown = shown.substr(table);
      // Of the survey the first table is enough.
      if (part.name.ends_with("-survey")) shown = shown.substr(0, shown.find("\n**", 2) + 1);
      text = replace_section(text, part.name, shown);
    }
    output::write_file_atomically(path, text);
  }

  Context& context_;
  const Request& request_;
  ReferenceStore references_;
  Runner runner_;
  bool published_ = false;
  std::string folder_;
  std::vector<Part> parts_;
};

}  // namespace

int bench(Context& context) {
  Study study(context);
  return study.run();
}

}  // namespace gnomon::cli
