#include "src/study/study_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "src/error.hpp"
#include "src/instruction_set.hpp"
#include "src/output/files.hpp"
#include "src/scene_reader.hpp"
#include "src/study/study_check.hpp"

namespace gnomon {

std::vector<std::string> SpeedPlan::instructions() const {
  std::vector<std::string> names;
  if (scalar) names.emplace_back("scalar");
  for (const InstructionSet each : instruction_sets()) names.emplace_back(to_string(each));
  return names;
}

std::string SurveyPlan::key() const {
  std::string key = label;
  for (char& c : key)
    if (c == ' ' || c == '-') c = '_';
  return key;
}

namespace {

/// Labels become names of files.
bool is_label(const std::string& text) {
  return std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
}

std::string read_label(Section& section) {
  const char* expected = "a name of letters, digits, - and _";
  std::string label = section.text("label", expected);
  if (!is_label(label)) section.fail("label", section.shown("label"), expected);
  return label;
}

std::vector<double> read_error_times(Section& section, double t_end) {
  if (!section.has("error_times")) return {};
  const std::string expected = fmt::format("different times from above 0 to t_end = {:g} (s)", t_end);
  std::vector<double> times = section.list("error_times", expected);
  std::ranges::sort(times);
  if (times.empty() || times.front() <= 0.0 || times.back() > t_end ||
      std::ranges::adjacent_find(times) != times.end())
    section.fail("error_times", section.shown("error_times"), expected);
  return times;
}

VaryPlan read_vary(Section& section) {
  section.only({"label", "scene", "key", "values", "what", "t_end", "set", "steps", "tols", "integrators",
                "time_limit", "timing_budget", "full_only"});
  VaryPlan plan;
  plan.label = read_label(section);
  plan.scene = section.text("scene", "a scene's name");
  plan.variation.key = section.text("key", "a key of the scene, as \"beam.EA\"");
  const char* values = "values of the key, every one once";
  plan.variation.values = section.values("values", values);
  if (const std::string twice = plan.variation.repeated(); !twice.empty())
    section.fail("values", twice + " twice", values);
  if (section.has("what")) plan.stability = section.one_of("what", {"errors", "stability"}) == "stability";
  if (section.has("t_end")) plan.t_end = section.positive("t_end", "a positive number (s)");
  plan.set = section.texts("set", "texts key.path=value");
  const auto positive = [&](const char* key, const char* expected) {
    if (!section.has(key)) return std::vector<double>{};
    std::vector<double> list = section.list(key, expected);
    if (list.empty() || std::ranges::any_of(list, [](double value) { return value <= 0.0; }))
      section.fail(key, section.shown(key), expected);
    return list;
  };
  plan.steps = positive("steps", "one or more positive numbers (s)");
  plan.tols = positive("tols", "one or more tolerances");
  plan.integrators = section.texts("integrators", "names of integrators");
  if (section.has("time_limit")) plan.time_limit = section.positive("time_limit", "a positive number (s)");
  if (section.has("timing_budget"))
    plan.timing_budget = section.positive("timing_budget", "a positive number (s)");
  plan.full_only = section.flag("full_only");
  return plan;
}

StaticRefinePlan read_refine(Section& section) {
  section.only({"label", "scene", "row_key", "row_values", "row_set", "key", "values", "set", "probe",
                "components", "reference", "coarser", "orders", "meaning"});
  StaticRefinePlan plan;
  const char* label = "a name of letters, digits, - and _";
  plan.label = section.text("label", label);
  if (!is_label(plan.label)) section.fail("label", section.shown("label"), label);
  plan.scene = section.text("scene", "a scene's name");
  const auto variation = [&](Variation& read, const char* key, const char* values) {
    const char* expected = "values of the key, every one once";
    read.key = section.text(key, "a key of the scene, as \"beam.order\"");
    read.values = section.values(values, expected);
    if (const std::string twice = read.repeated(); !twice.empty())
      section.fail(values, twice + " twice", expected);
  };
  variation(plan.rows, "row_key", "row_values");
  variation(plan.columns, "key", "values");
  const std::vector<double> numbers = plan.columns.numbers().value_or(std::vector<double>{0.0});
  if (std::ranges::any_of(numbers, [](double value) { return value <= 0.0; }))
    section.fail("values", section.shown("values"), "positive numbers");
  const auto one_a_row = [&](const char* key, std::size_t count) {
    if (count != 0 && count != plan.rows.values.size())
      section.fail(key, section.shown(key), fmt::format("one a row, {} of them", plan.rows.values.size()));
  };
  plan.row_set = section.texts("row_set", "texts key.path=value, one a row");
  one_a_row("row_set", plan.row_set.size());
  plan.set = section.texts("set", "texts key.path=value");
  plan.probe = section.text("probe", "the name of a probe");
  const auto some = [&](const char* key, const char* expected) {
    std::vector<std::string> list = section.texts(key, expected);
    if (list.empty()) section.fail(key, section.has(key) ? section.shown(key) : "nothing", expected);
    return list;
  };
  plan.components = some("components", "one or more components of the probe");
  plan.reference = some("reference", "texts key.path=value that make a fine mesh");
  plan.coarser = some("coarser", "texts key.path=value that make another fine mesh");
  if (section.has("orders")) {
    const char* expected = "positive numbers, one a row";
    plan.orders = section.list("orders", expected);
    one_a_row("orders", plan.orders.size());
    if (plan.orders.empty() || std::ranges::any_of(plan.orders, [](double order) { return order <= 0.0; }))
      section.fail("orders", section.shown("orders"), expected);
  }
  plan.meaning = section.text_or("meaning", "", "a sentence");
  return plan;
}

}  // namespace

std::string study_text(const std::string& path) {
  try {
    return output::read_file(path);
  } catch (const std::runtime_error& error) {
    throw UsageError(
        fmt::format("{}: found no file that can be read, expected that of a study ({})", path, error.what()));
  }
}

bool StudyPlan::empty() const {
  return converge.empty() && quick_converge.empty() && compare.empty() && quick_compare.empty() &&
         scorecard.empty() && quick_scorecard.empty() && drift.empty() && work.empty() && speed.empty() &&
         survey.empty() && peers.empty() && vary.empty() && refine.empty();
}

StudyPlan read_study(const std::string& path, const Catalogue* catalogue) {
  return read_study_text(study_text(path), path, catalogue);
}

StudyPlan read_study_text(const std::string& text, const std::string& path, const Catalogue* catalogue) {
  toml::table table;
  try {
    table = toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    throw UsageError(fmt::format("{}:{}: found what is not TOML, expected valid TOML ({})", path,
                                 error.source().begin.line, error.description()));
  }
  const SceneSource source{path, {}};
  Section root(table, "", source);
  const auto each = [&](const char* key, auto&& read) {
    for (Section& section : root.sections(key)) {
      read(section);
      section.finish();
    }
  };
  StudyCheck check(catalogue);
  const auto scenes = [&](const char* key) {
    std::vector<std::string> names = root.texts(key, "names of scenes");
    check.scenes(root, key, names);
    return names;
  };
  StudyPlan plan;
  plan.converge = scenes("converge");
  plan.quick_converge = scenes("quick_converge");
  plan.compare = scenes("compare");
  plan.quick_compare = scenes("quick_compare");
  plan.scorecard = scenes("scorecard");
  plan.quick_scorecard = scenes("quick_scorecard");
  plan.integrators = root.texts("integrators", "names of integrators");
  check.shared_integrators(root, plan.integrators);
  each("drift", [&](Section& section) {
    section.only({"label", "scene", "t_end", "quick_t_end", "step", "steps", "tol", "error_times",
                  "integrators", "published", "source"});
    DriftPlan drift;
    drift.scene = section.text("scene", "a scene's name");
    drift.label = section.has("label") ? read_label(section) : drift.scene;
    drift.t_end = section.positive("t_end", "a positive number (s)");
    if (section.has("quick_t_end"))
      drift.quick_t_end = section.positive("quick_t_end", "a positive number (s)");
    const char* meaning = "one step, or several as a list";
    if (section.exactly_one("step", "steps", meaning) == "step")
      drift.steps = {section.positive("step", "a positive number (s)")};
    else
      drift.steps = section.positives("steps", "positive numbers (s), at least two");
    if (section.has("tol")) drift.tol = section.positive("tol", "a tolerance");
    drift.error_times = read_error_times(section, drift.t_end);
    drift.integrators = section.texts("integrators", "names of integrators");
    for (Section& other : section.sections("published")) {
      drift.published.push_back({other.text("name", "the name of a program"),
                                 other.text("invariant", "the name of an invariant"),
                                 other.positive("max_drift", "a positive number")});
      other.finish();
    }
    drift.source = drift.published.empty() ? section.text_or("source", "", "where it was published")
                                           : section.text("source", "where it was published");
    check.drift(section, drift);
    plan.drift.push_back(std::move(drift));
  });
  each("speed", [&](Section& section) {
    section.only({"scene", "step", "steps", "parts", "newton_tol", "set", "instructions_key", "scalar",
                  "integrators", "full_only"});
    SpeedPlan speed{section.text("scene", "a scene's name"),
                    section.positive("step", "a positive number (s)")};
    if (section.has("steps")) speed.steps = section.integer("steps", 1, 100'000'000, "a number of steps");
    if (section.has("parts")) speed.parts = section.positive("parts", "a number of parts");
    if (section.has("newton_tol")) speed.newton_tol = section.positive("newton_tol", "a tolerance");
    speed.set = section.texts("set", "texts key.path=value");
    speed.instructions_key = section.text_or("instructions_key", "", "a key of the scene");
    speed.scalar = section.flag("scalar");
    speed.integrators = section.texts("integrators", "names of integrators");
    speed.full_only = section.flag("full_only");
    check.speed(section, speed);
    plan.speed.push_back(std::move(speed));
  });
  each("work", [&](Section& section) {
    section.only({"scene", "steps", "explicit_steps", "tols", "integrators", "time_limit", "timing_budget"});
    WorkPlan work;
    work.scene = section.text("scene", "a scene's name");
    work.steps = section.positives("steps", "positive numbers (s), at least two");
    if (section.has("explicit_steps"))
      work.explicit_steps =
          section.positives("explicit_steps", "positive numbers (s) for explicit schemes, at least two");
    work.tols = section.positives("tols", "tolerances, at least two");
    work.integrators = section.texts("integrators", "names of integrators");
    if (section.has("time_limit")) work.time_limit = section.positive("time_limit", "a positive number (s)");
    if (section.has("timing_budget"))
      work.timing_budget = section.positive("timing_budget", "a positive number (s)");
    check.work(section, work);
    plan.work.push_back(std::move(work));
  });
  each("survey", [&](Section& section) {
    section.only({"label", "scene", "step", "t_end", "closed_form_scene"});
    plan.survey.push_back({section.text("label", "a name for the class of scenes"),
                           section.text("scene", "a scene's name"),
                           section.positive("step", "a positive number (s)"),
                           section.positive("t_end", "a positive number (s)"),
                           section.text_or("closed_form_scene", "", "a scene's name")});
    check.survey(section, plan.survey.back());
  });
  each("peers", [&](Section& section) {
    section.only({"scene", "levels", "goals", "integrators"});
    PeerPlan peers;
    peers.scene = section.text("scene", "a scene's name");
    peers.levels = section.numbers("levels", 4, "four errors, the greatest first");
    peers.goals = section.numbers("goals", 4, "four shares of the best peer's time");
    peers.integrators = section.texts("integrators", "names of integrators");
    check.peers(section, peers);
    plan.peers.push_back(std::move(peers));
  });
  each("vary", [&](Section& section) {
    plan.vary.push_back(read_vary(section));
    check.vary(section, plan.vary.back());
  });
  each("refine", [&](Section& section) {
    plan.refine.push_back(read_refine(section));
    check.refine(section, plan.refine.back());
  });
  root.finish();
  if (plan.empty())
    throw UsageError(
        fmt::format("{}: found no part, expected lists of scenes (converge, compare, scorecard or the same "
                    "with quick_) or "
                    "tables [[drift]], [[work]], [[speed]], [[survey]], [[peers]], [[vary]] or [[refine]]",
                    path));
  return plan;
}

}  // namespace gnomon
