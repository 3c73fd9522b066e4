#include "src/study/study_file.hpp"

#include <fmt/format.h>

#include "src/error.hpp"
#include "src/scene_reader.hpp"

namespace gnomon {

StudyPlan read_study(const std::string& path) {
  toml::table table;
  try {
    table = toml::parse_file(path);
  } catch (const toml::parse_error& error) {
    throw UsageError(fmt::format("{}: {}", path, error.description()));
  }
  const SceneSource source{path, {}};
  const auto texts = [&](const toml::table& from, const char* key) {
    std::vector<std::string> list;
    if (const toml::array* array = from[key].as_array())
      for (const toml::node& node : *array) list.push_back(node.value_or(std::string()));
    return list;
  };
  const auto each = [&](const char* key, auto&& read) {
    if (const toml::array* array = table[key].as_array())
      for (const toml::node& node : *array)
        if (const toml::table* entry = node.as_table()) read(*entry, Section(*entry, key, source));
  };
  StudyPlan plan;
  plan.converge = texts(table, "converge");
  plan.compare = texts(table, "compare");
  plan.quick_compare = texts(table, "quick_compare");
  each("drift", [&](const toml::table& entry, Section section) {
    DriftPlan drift;
    drift.scene = section.text("scene", "a scene's name");
    drift.t_end = section.positive("t_end", "a positive number (s)");
    if (section.has("quick_t_end"))
      drift.quick_t_end = section.positive("quick_t_end", "a positive number (s)");
    drift.step = section.positive("step", "a positive number (s)");
    drift.tol = section.positive("tol", "a tolerance");
    drift.integrators = texts(entry, "integrators");
    plan.drift.push_back(std::move(drift));
  });
  each("speed", [&](const toml::table&, Section section) {
    plan.speed.push_back(
        {section.text("scene", "a scene's name"), section.positive("step", "a positive number (s)")});
  });
  return plan;
}

}  // namespace gnomon
