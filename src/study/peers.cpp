#include "src/study/peers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

/// A run with more evaluations, some ten milliseconds, is of no use at any level.
constexpr long most_evaluations = 400'000;
constexpr double first_tol = 0.1, last_tol = 1e-14;
/// Settings a decade of tolerances, and of steps an octave.
constexpr int settings_a_decade = 4, settings_an_octave = 4;
constexpr long most_steps = 1L << 22;

struct Outcome {
  double seconds;  ///< not finite if it failed
  double error;
  long evaluations;
};

struct Contender {
  PeerRow row;
  Stepping stepping;
  std::function<Outcome(const Setting&)> run;
};

std::vector<Setting> ladder(Stepping stepping, double t_end) {
  std::vector<Setting> list;
  if (stepping == Stepping::closed_form) {
    list.emplace_back();
  } else if (stepping == Stepping::adaptive) {
    for (int k = 0;; ++k) {
      const double tol = first_tol * std::pow(10.0, -static_cast<double>(k) / settings_a_decade);
      if (tol < 0.999 * last_tol) break;
      list.push_back({std::nullopt, tol});
    }
  } else {
    long steps = 0;
    for (int k = 0; steps < most_steps; ++k) {
      const long next = std::lround(std::exp2(static_cast<double>(k) / settings_an_octave));
      if (next == steps) continue;
      steps = next;
      list.push_back({t_end / static_cast<double>(steps), std::nullopt});
    }
  }
  return list;
}

/// What a state is off the reference, in the first metric; not finite for a run that failed.
class Judge {
 public:
  /// A reference without states, of which only tables are made, judges nothing.
  Judge(const Scene& scene, const ReferenceStates& reference)
      : model_(scene.model), bound_(reference.bounds.back()[0]) {
    if (!reference.states.empty()) reference_ = reference.states.back();
  }
  double operator()(const std::vector<double>& state) const {
    return std::max(bound_, model_->distance(state, reference_)[0]);
  }

 private:
  std::shared_ptr<const AnyModel> model_;
  std::vector<double> reference_;
  double bound_;
};

Contender of_ours(const Runner& runner, const Scene& scene, const Judge& judge, const SchemeInfo& scheme) {
  const auto run = runner.catalogue().pair(scheme.name, *scene.model)->run;
  const void* model = scene.model->get();
  const double t_end = scene.t_end;
  return {{std::string(scheme.name), false, scheme.stepping == Stepping::closed_form, {}},
          scheme.stepping,
          [=](const Setting& setting) {
            RunSpec spec;
            spec.t_end = t_end;
            spec.step = setting.step;
            spec.tol = setting.tol;
            spec.record = false;
            const RunResult result = run(model, spec);
            if (result.status != Status::ok) return Outcome{std::nan(""), std::nan(""), 0};
            return Outcome{result.cpu_seconds, judge(result.state), result.cost.rhs};
          }};
}

Contender of_peers(const Scene& scene, const Judge& judge, const Peer& peer) {
  const void* model = scene.model->get();
  const double t_end = scene.t_end;
  const auto run = peer.run;
  return {{std::string(peer.name), true, false, {}}, Stepping::adaptive, [=](const Setting& setting) {
            std::vector<double> state;
            long evaluations = 0;
            const double seconds = run(model, t_end, *setting.tol, state, evaluations);
            if (seconds < 0.0) return Outcome{std::nan(""), std::nan(""), 0};
            return Outcome{seconds, judge(state), evaluations};
          }};
}

using Levels = std::vector<std::optional<LevelTime>>;

nlohmann::ordered_json levels_json(const Levels& levels) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const auto& level : levels) {
    json.emplace_back();
    if (!level) continue;
    json.back() = {{"error", level->error}, {"evaluations", level->evaluations}};
    if (level->setting.step) json.back()["step"] = *level->setting.step;
    if (level->setting.tol) json.back()["tol"] = *level->setting.tol;
    json.back()["loosest"] = level->loosest;
  }
  return json;
}

Levels restore_levels(const nlohmann::ordered_json& json) {
  Levels levels;
  for (const auto& each : json) {
    levels.emplace_back();
    if (each.is_null()) continue;
    LevelTime level{{}, each.at("error"), each.at("evaluations"), {}, false};
    if (each.contains("step")) level.setting.step = each.at("step");
    if (each.contains("tol")) level.setting.tol = each.at("tol");
    level.loosest = each.value("loosest", false);
    levels.back() = level;
  }
  return levels;
}

/// The levels, not yet timed.
Levels find_levels(const Contender& contender, const PeerPlan& plan, double t_end, const Runner& runner) {
  Levels levels;
  const std::vector<Setting> settings = ladder(contender.stepping, t_end);
  std::vector<double> errors;
  std::vector<long> evaluations;
  const double tightest = *std::min_element(plan.levels.begin(), plan.levels.end());
  for (const Setting& setting : settings) {
    if (runner.stopped()) return levels;
    const Outcome outcome = contender.run(setting);
    errors.push_back(outcome.error);
    evaluations.push_back(outcome.evaluations);
    if (outcome.evaluations > most_evaluations || loosest_that_counts(errors, tightest)) break;
  }
  if (contender.row.closed_form) errors.resize(3, errors.front());
  for (double level : plan.levels) {
    const auto found = loosest_that_counts(errors, level);
    levels.push_back(found ? std::optional(LevelTime{settings[*found],
                                                     errors[*found],
                                                     evaluations[*found],
                                                     {},
                                                     *found == 0 && !contender.row.closed_form})
                           : std::nullopt);
  }
  return levels;
}

std::string setting_text(const Setting& setting) {
  return !setting.step && !setting.tol ? "closed form" : setting.text();
}

}  // namespace

std::optional<std::size_t> loosest_that_counts(const std::vector<double>& errors, double level) {
  for (std::size_t k = 0; k + 2 < errors.size(); ++k)
    if (errors[k] <= level && errors[k + 1] <= level && errors[k + 2] <= level) return k;
  return std::nullopt;
}

std::optional<double> PeerStudy::best(std::size_t level, bool peer) const {
  std::optional<double> least;
  for (const PeerRow& row : rows) {
    if (row.peer != peer || row.closed_form || !row.levels[level]) continue;
    const double time = row.levels[level]->run.median;
    if (!least || time < *least) least = time;
  }
  return least;
}

PeerStudy measure_peers(Runner& runner, const PeerPlan& plan, bool quick) {
  PeerStudy study{plan, "", {}};
  const Scene scene = load_scene(runner.catalogue(), plan.scene);
  study.metric = fmt::format("{} error [{}]", scene.model->metrics()[0].name, scene.model->metrics()[0].unit);
  StudyOptions options;
  options.integrators = plan.integrators;
  const ReferenceStates reference = runner.reference(scene, options);
  if (reference.kind.empty()) return study;
  const Judge judge(scene, reference);

  std::vector<Contender> contenders;
  for (const Peer& peer : runner.catalogue().peers)
    if (peer.model_type == scene.model->type()) contenders.push_back(of_peers(scene, judge, peer));
  for (const SchemeInfo* scheme : select(runner.catalogue(), scene, options))
    contenders.push_back(of_ours(runner, scene, judge, *scheme));

  std::vector<TimedTask> tasks;
  std::vector<LevelTime*> timed;
  const nlohmann::ordered_json problem{
      {"scene", scene.name}, {"physics", scene.physics_hash()}, {"levels", plan.levels}};
  std::vector<std::string> names;
  for (Contender& contender : contenders) {
    const auto kept =
        runner.measure("levels", {{"of", problem}, {"integrator", contender.row.name}}, false,
                       [&] { return levels_json(find_levels(contender, plan, scene.t_end, runner)); });
    contender.row.levels = kept.is_null() ? Levels(plan.levels.size()) : restore_levels(kept);
  }
  for (Contender& contender : contenders)
    for (auto& level : contender.row.levels)
      if (level) {
        timed.push_back(&*level);
        tasks.push_back({[&contender, setting = level->setting] { return contender.run(setting).seconds; }});
        names.push_back(fmt::format("{}, {:.17g}, {:.17g}", contender.row.name,
                                    level->setting.step.value_or(0.0), level->setting.tol.value_or(0.0)));
      }
  TimingPlan timing;
  timing.repetitions = quick ? 5 : 11;
  timing.min_seconds = quick ? 0.005 : 0.02;
  const auto stats = runner.time("peer times", problem, names, tasks, timing);
  for (std::size_t k = 0; k < stats.size(); ++k) timed[k]->run = stats[k];
  for (Contender& contender : contenders) study.rows.push_back(std::move(contender.row));
  return study;
}

output::Table peers_table(const PeerStudy& study) {
  output::Table table;
  table.caption = fmt::format("Time to the {} on {}, one core", study.metric, study.plan.scene);
  table.columns = {{"integrator", "integrator", output::Align::left}};
  for (double level : study.plan.levels) {
    table.columns.push_back({fmt::format("us_at_{:g}", level), fmt::format("{:g} [us]", level)});
    table.columns.push_back({fmt::format("ratio_at_{:g}", level), "of the best peer"});
  }
  for (const PeerRow& row : study.rows) {
    std::vector<output::Cell> cells{row.name};
    for (std::size_t k = 0; k < row.levels.size(); ++k) {
      const auto peer = study.best(k, true);
      output::Cell time, ratio;
      if (row.levels[k]) {
        time = output::number_cell(1e6 * row.levels[k]->run.median);
        if (peer) ratio = output::number_cell(row.levels[k]->run.median / *peer, 2);
        if (row.levels[k]->loosest)
          for (output::Cell* cell : {&time, &ratio}) cell->text = "≤ " + cell->text;
      }
      cells.push_back(std::move(time));
      cells.push_back(std::move(ratio));
    }
    table.rows.push_back(std::move(cells));
  }
  std::string reached, asked;
  for (std::size_t k = 0; k < study.plan.levels.size(); ++k) {
    const auto ours = study.best(k, false), peer = study.best(k, true);
    const std::string comma = k > 0 ? ", " : "";
    reached += comma + (ours && peer ? output::number(*ours / *peer, 2) : output::missing_text);
    asked += comma + output::number(study.plan.goals[k], 2);
  }
  table.notes.push_back(
      fmt::format("our fastest stepping scheme over the best peer: {}; asked: {}", reached, asked));
  table.notes.push_back(
      "medians of thread CPU time, all interleaved in one run; a setting counts only if the two next tighter "
      "ones also reach the level; ≤: already the loosest one that was tried does");
  return table;
}

output::Table peer_runs_table(const PeerStudy& study) {
  output::Table table;
  table.caption = "Runs";
  table.columns = {{"integrator", "integrator", output::Align::left},
                   {"level", "level"},
                   {"setting", "setting", output::Align::left},
                   {"error", study.metric},
                   {"evaluations", "evaluations"},
                   {"us_median", "median [us]"},
                   {"us_min", "least [us]"},
                   {"repetitions", "repetitions"}};
  for (const PeerRow& row : study.rows)
    for (std::size_t k = 0; k < row.levels.size(); ++k) {
      if (!row.levels[k]) continue;
      const LevelTime& time = *row.levels[k];
      output::Cell median = output::number_cell(1e6 * time.run.median);
      if (time.run.unstable) median.text += "*";
      if (time.loosest) median.text = "≤ " + median.text;
      table.rows.push_back(
          {row.name, output::number_cell(study.plan.levels[k], 1), setting_text(time.setting),
           output::number_cell(time.error, 2), output::count_cell(time.evaluations), median,
           output::number_cell(1e6 * time.run.min), output::count_cell(time.run.repetitions)});
    }
  table.notes.push_back(unstable_note);
  return table;
}

nlohmann::ordered_json peers_json(const PeerStudy& study) {
  const auto number = [](const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
  };
  nlohmann::ordered_json json{{"scene", study.plan.scene},
                              {"levels", study.plan.levels},
                              {"goals", study.plan.goals},
                              {"times", nlohmann::ordered_json::array()}};
  for (const PeerRow& row : study.rows)
    for (std::size_t k = 0; k < row.levels.size(); ++k) {
      nlohmann::ordered_json entry{
          {"integrator", row.name}, {"peer", row.peer}, {"level", study.plan.levels[k]}};
      if (row.levels[k]) {
        const LevelTime& time = *row.levels[k];
        const auto peer = study.best(k, true);
        entry["step"] = number(time.setting.step);
        entry["tol"] = number(time.setting.tol);
        entry["error"] = time.error;
        entry["evaluations"] = time.evaluations;
        entry["us_median"] = 1e6 * time.run.median;
        entry["us_min"] = 1e6 * time.run.min;
        entry["repetitions"] = time.run.repetitions;
        entry["unstable"] = time.run.unstable;
        entry["upper_bound"] = time.loosest;
        entry["ratio"] = number(peer ? std::optional(time.run.median / *peer) : std::nullopt);
      }
      json["times"].push_back(std::move(entry));
    }
  return json;
}

}  // namespace gnomon
