#include "src/scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "src/scene_reader.hpp"

namespace gnomon {
namespace {

toml::table parse_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  if (!in || std::filesystem::is_directory(path) || !(text << in.rdbuf()))
    throw UsageError(fmt::format("{}: cannot be read, expected a scene file", path));
  try {
    return toml::parse(text.str(), path);
  } catch (const toml::parse_error& error) {
    throw UsageError(
        fmt::format("{}:{}: not valid TOML: {}", path, error.source().begin.line, error.description()));
  }
}

/// Writes one `--set key.path=value` into the tree.
void apply_override(toml::table& root, const std::string& option, SceneSource& source) {
  const std::size_t equals = option.find('=');
  const std::string label = fmt::format("--set {}", option);
  if (equals == std::string::npos || equals == 0)
    throw UsageError(fmt::format("{}: found '{}', expected key.path=value", label, option));
  const std::string path = option.substr(0, equals), value = option.substr(equals + 1);
  toml::table parsed;
  try {
    parsed = toml::parse("x = " + value);
  } catch (const toml::parse_error&) {
    throw UsageError(fmt::format("{}: found '{}', expected a TOML value (a number, \"text\", [list] or true)",
                                 label, value));
  }
  toml::table* table = &root;
  std::stringstream stream(path);
  std::vector<std::string> keys;
  for (std::string key; std::getline(stream, key, '.');) keys.push_back(key);
  if (keys.empty() || path.back() == '.' || std::find(keys.begin(), keys.end(), "") != keys.end())
    throw UsageError(fmt::format("{}: found '{}', expected key.path=value", label, path));
  for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
    toml::node* node = table->get(keys[k]);
    if (!node) node = &table->insert(keys[k], toml::table{}).first->second;
    if (!node->is_table())
      throw UsageError(fmt::format("{}: '{}' is not a table of the scene", label, keys[k]));
    table = node->as_table();
  }
  const toml::node& node = *parsed.get("x");
  node.visit([&](const auto& typed) { table->insert_or_assign(keys.back(), typed); });
  source.overrides[path] = label;
}

}  // namespace

std::string hash_text(std::string_view text) {
  std::uint64_t hash = 14695981039346656037U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
  return fmt::format("{:016x}", hash);
}

std::string Scene::physics_hash() const {
  nlohmann::ordered_json physics = resolved;
  physics.erase("name");
  physics.erase("description");
  return hash_text(physics.dump());
}

std::vector<ShippedScene> shipped_scenes(const Catalogue& catalogue) {
  std::vector<ShippedScene> scenes;
  for (const std::string& folder : catalogue.scene_folders) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error))
      if (entry.path().extension() == ".toml")
        scenes.push_back({entry.path().stem().string(), entry.path().string()});
  }
  std::sort(scenes.begin(), scenes.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return scenes;
}

Scene load_scene(const Catalogue& catalogue, const std::string& name_or_path, const SceneChanges& changes) {
  SceneSource source{name_or_path, {}};
  std::string path = name_or_path;
  if (!path.ends_with(".toml")) {
    const std::vector<ShippedScene> shipped = shipped_scenes(catalogue);
    const auto found = std::find_if(shipped.begin(), shipped.end(),
                                    [&](const auto& scene) { return scene.name == name_or_path; });
    if (found == shipped.end()) {
      std::vector<std::string> names;
      for (const ShippedScene& scene : shipped) names.push_back(scene.name);
      const std::string near = nearest(name_or_path, names);
      throw UsageError(
          fmt::format("scene '{}': no shipped scene of that name, expected {} or a path that ends in .toml",
                      name_or_path, near.empty() ? fmt::format("{}", fmt::join(names, ", ")) : near));
    }
    path = found->path;
    source.file = std::filesystem::path(path).filename().string();
  }

  toml::table table = parse_file(path);
  for (const std::string& option : changes.set) apply_override(table, option, source);

  Section root(table, "", source);
  Scene scene;
  scene.name = root.text("name", "a name in quotes");
  if (root.has("description"))
    scene.description = root.text("description", "a text in quotes");
  else
    root.numbers_or("description", {}, "");
  std::vector<std::string> models;
  for (const ModelEntry& entry : catalogue.models) models.emplace_back(entry.name);
  scene.model_name = root.one_of("model", models);
  scene.t_end = root.positive("t_end", "a positive number (s)");
  if (changes.t_end) scene.t_end = *changes.t_end;

  const auto entry = std::find_if(catalogue.models.begin(), catalogue.models.end(),
                                  [&](const ModelEntry& model) { return model.name == scene.model_name; });
  ParsedModel parsed = entry->read(root, scene.t_end);
  root.finish();
  scene.model = parsed.model;
  for (const std::string& warning : parsed.warnings)
    scene.warnings.push_back(fmt::format("{}: {}", source.file, warning));
  scene.resolved["name"] = scene.name;
  scene.resolved["model"] = scene.model_name;
  if (!scene.description.empty()) scene.resolved["description"] = scene.description;
  scene.resolved["t_end"] = scene.t_end;
  scene.resolved.update(*parsed.resolved);
  return scene;
}

}  // namespace gnomon
