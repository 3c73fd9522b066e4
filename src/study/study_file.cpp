#include "src/study/study_file.hpp"

#include <fmt/format.h>

#include "src/error.hpp"
#include "src/scene_reader.hpp"

namespace gnomon {

std::string SurveyPlan::key() const {
  std::string key = label;
  for (char& c : key)
    if (c == ' ' || c == '-') c = '_';
  return key;
}

StudyPlan read_study(const std::string& path) {
  toml::table table;
  try {
    table = toml::parse_file(path);
  } catch (const toml::parse_error& error) {
    throw UsageError(fmt::format("{}: {}", path, error.description()));
  }
  const SceneSource source{path, {}};
  Section root(table, "", source);
  const auto each = [&](const char* key, auto&& read) {
    for (Section& section : root.sections(key)) {
      read(section);
      section.finish();
    }
  };
  StudyPlan plan;
  plan.converge = root.texts("converge", "names of scenes");
  plan.quick_converge = root.texts("quick_converge", "names of scenes");
  plan.compare = root.texts("compare", "names of scenes");
  plan.quick_compare = root.texts("quick_compare", "names of scenes");
  plan.scorecard = root.texts("scorecard", "names of scenes");
  plan.quick_scorecard = root.texts("quick_scorecard", "names of scenes");
  plan.integrators = root.texts("integrators", "names of integrators");
  each("drift", [&](Section& section) {
    section.only({"scene", "t_end", "quick_t_end", "step", "steps", "tol", "integrators"});
    DriftPlan drift;
    drift.scene = section.text("scene", "a scene's name");
    drift.t_end = section.positive("t_end", "a positive number (s)");
    if (section.has("quick_t_end"))
      drift.quick_t_end = section.positive("quick_t_end", "a positive number (s)");
    const char* meaning = "one step, or several as a list";
    if (section.exactly_one("step", "steps", meaning) == "step")
      drift.steps = {section.positive("step", "a positive number (s)")};
    else
      drift.steps = section.positives("steps", "positive numbers (s), at least two");
    if (section.has("tol")) drift.tol = section.positive("tol", "a tolerance");
    drift.integrators = section.texts("integrators", "names of integrators");
    plan.drift.push_back(std::move(drift));
  });
  each("speed", [&](Section& section) {
    section.only({"scene", "step", "steps", "parts", "newton_tol", "set", "instructions_key", "full_only"});
    SpeedPlan speed{section.text("scene", "a scene's name"),
                    section.positive("step", "a positive number (s)")};
    if (section.has("steps")) speed.steps = section.integer("steps", 1, 100'000'000, "a number of steps");
    if (section.has("parts")) speed.parts = section.positive("parts", "a number of parts");
    if (section.has("newton_tol")) speed.newton_tol = section.positive("newton_tol", "a tolerance");
    speed.set = section.texts("set", "texts key.path=value");
    speed.instructions_key = section.text_or("instructions_key", "", "a key of the scene");
    speed.full_only = section.flag("full_only");
    plan.speed.push_back(std::move(speed));
  });
  each("survey", [&](Section& section) {
    section.only({"label", "scene", "step", "t_end"});
    plan.survey.push_back({section.text("label", "a name for the class of scenes"),
                           section.text("scene", "a scene's name"),
                           section.positive("step", "a positive number (s)"),
                           section.positive("t_end", "a positive number (s)")});
  });
  each("peers", [&](Section& section) {
    section.only({"scene", "levels", "goals", "integrators"});
    PeerPlan peers;
    peers.scene = section.text("scene", "a scene's name");
    peers.levels = section.numbers("levels", 4, "four errors, the greatest first");
    peers.goals = section.numbers("goals", 4, "four shares of the best peer's time");
    peers.integrators = section.texts("integrators", "names of integrators");
    plan.peers.push_back(std::move(peers));
  });
  root.finish();
  return plan;
}

}  // namespace gnomon
