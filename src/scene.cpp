#include "src/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "src/output/text.hpp"
#include "src/scene_reader.hpp"

namespace gnomon {
namespace {

/// What stands on one line (from 1) of a text, fit for a message.
std::string line_of(const std::string& text, std::size_t number) {
  std::stringstream stream(text);
  std::string line;
  for (std::size_t k = 0; k < number; ++k)
    if (!std::getline(stream, line)) line.clear();
  line = output::plain_text(line);
  const std::size_t begin = line.find_first_not_of(' ');
  if (begin == std::string::npos) return number > 1 ? "nothing more" : "nothing";
  line = line.substr(begin, line.find_last_not_of(' ') + 1 - begin);
  return fmt::format("'{}'",
                     output::display_columns(line) > 60 ? output::first_columns(line, 57) + "..." : line);
}

toml::table parse_file(const std::string& path) {
  namespace fs = std::filesystem;
  const auto refuse = [&](std::string_view found) {
    throw UsageError(fmt::format("{}: found {}, expected a scene file", path, found));
  };
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) refuse("no such file");
  if (fs::is_directory(status)) refuse("a folder");
  std::ifstream in(path, std::ios::binary);
  if (!in) refuse("a file that cannot be read");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (text.empty()) refuse("an empty file");
  try {
    return toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    const std::size_t line = error.source().begin.line;
    throw UsageError(fmt::format("{}:{}: found {}, expected valid TOML ({})", path, line, line_of(text, line),
                                 error.description()));
  }
}

/// The value of a `--set` option in TOML.
toml::table parse_value(const std::string& label, const std::string& value) {
  const auto refuse = [&] {
    throw UsageError(fmt::format(
        "{}: found '{}', expected a TOML value: a number, a \"text\" in double quotes, a [list] or true",
        label, value));
  };
  if (value.find_first_of("\r\n") != std::string::npos) refuse();
  toml::table parsed;
  try {
    parsed = toml::parse("x = " + value);
  } catch (const toml::parse_error&) {
    refuse();
  }
  return parsed;
}

/// Writes one `--set key.path=value`, or what another option says in the same form, into the tree.
void apply_override(toml::table& root, const std::string& option, SceneSource& source,
                    const std::string& option_name = "--set") {
  const std::string label = fmt::format("{} {}", option_name, option);
  const std::size_t equals = option.find('=');
  if (equals == std::string::npos)
    throw UsageError(fmt::format("{}: found no '=', expected key.path=value", label));
  const std::string path = option.substr(0, equals);
  std::vector<std::string> keys;
  std::stringstream stream(path);
  for (std::string key; std::getline(stream, key, '.');) keys.push_back(key);
  if (keys.empty() || path.back() == '.' || std::find(keys.begin(), keys.end(), "") != keys.end())
    throw UsageError(fmt::format("{}: found '{}' as the key, expected key.path=value", label, path));
  const toml::table parsed = parse_value(label, option.substr(equals + 1));
  toml::table* table = &root;
  for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
    toml::node* node = table->get(keys[k]);
    if (!node) node = &table->insert(keys[k], toml::table{}).first->second;
    if (!node->is_table())
      throw UsageError(fmt::format(
          "{}: found '{}', which is not a table of the scene, expected key.path=value", label, keys[k]));
    table = node->as_table();
  }
  parsed.get("x")->visit([&](const auto& typed) { table->insert_or_assign(keys.back(), typed); });
  std::erase_if(source.overrides, [&](const auto& earlier) { return earlier.first.starts_with(path + "."); });
  source.overrides[path] = label;
}

/// "a.b,c.d=value" as "a.b=value" and "c.d=value".
std::vector<std::string> assignments(const std::string& option) {
  const std::size_t equals = std::min(option.find('='), option.size());
  std::vector<std::string> list;
  for (std::size_t begin = 0; begin <= equals;) {
    const std::size_t end = std::min(option.find(',', begin), equals);
    list.push_back(option.substr(begin, end - begin) + option.substr(equals));
    begin = end + 1;
  }
  return list;
}

/// Names become names of files and parts of tables.
bool is_plain_name(std::string_view name) {
  return name.size() <= 100 && name.front() != '.' && name.front() != '-' &&
         std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
                  c == '_' || c == '.';
         });
}

/// The path of a scene: itself, or that of the shipped scene of that name.
std::string find_scene(const Catalogue& catalogue, const std::string& name_or_path) {
  if (name_or_path.ends_with(".toml")) return name_or_path;
  std::vector<std::string> names;
  for (const ShippedScene& scene : shipped_scenes(catalogue)) {
    if (scene.name == name_or_path) return scene.path;
    names.push_back(scene.name);
  }
  const std::string near = nearest(name_or_path, names);
  throw UsageError(
      fmt::format("scene '{}': found no shipped scene of that name, expected {} or a path that "
                  "ends in .toml",
                  name_or_path, near.empty() ? choices_text(names) : near));
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

Scene Scene::with_end(double time) const {
  Scene scene = *this;
  if (time == t_end) return scene;
  // Some models take scales from how far they were to run.
  if (!scene.resolved.contains("horizon")) scene.resolved["horizon"] = t_end;
  scene.resolved["t_end"] = scene.t_end = time;
  scene.file.clear();
  return scene;
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
  const std::string path = find_scene(catalogue, name_or_path);
  SceneSource source{path, {}, std::filesystem::path(path).parent_path().string()};
  if (path != name_or_path) source.file = std::filesystem::path(path).filename().string();

  toml::table table = parse_file(path);
  for (const std::string& option : changes.set) apply_override(table, option, source);
  if (changes.vary)
    for (const std::string& option : assignments(*changes.vary))
      apply_override(table, option, source, "--vary");

  Section root(table, "", source);
  root.refuse_misspelt({"name", "description", "model", "t_end"});
  Scene scene;
  const char* name =
      "a name in quotes: at most 100 letters, digits, - _ and . that begin with a letter or digit";
  scene.name = root.text("name", name);
  if (!is_plain_name(scene.name)) root.fail("name", root.shown("name"), name);
  if (changes.vary) scene.name += fmt::format("[{}]", *changes.vary);
  scene.description = root.text_or("description", "", "a text in quotes on one line");
  if (output::plain_text(scene.description) != scene.description)
    root.fail("description", root.shown("description"), "a text in quotes on one line");
  std::vector<std::string> models;
  for (const ModelEntry& entry : catalogue.models) models.emplace_back(entry.name);
  scene.model_name = root.one_of("model", models);
  scene.t_end = root.positive("t_end", "a positive number (s)");
  const bool as_it_stands =
      changes.set.empty() && !changes.vary && changes.t_end.value_or(scene.t_end) == scene.t_end;
  if (as_it_stands) scene.file = path;
  if (changes.t_end) scene.t_end = *changes.t_end;

  const auto entry = std::find_if(catalogue.models.begin(), catalogue.models.end(),
                                  [&](const ModelEntry& model) { return model.name == scene.model_name; });
  ParsedModel parsed = entry->read(root, scene.t_end);
  root.finish();
  scene.model = parsed.model;
  // More steps than this no scheme can take, and they could not be counted exactly; in much shorter a time
  // than that nothing moves, and squares of steps vanish.
  if (const double span = scene.t_end / scene.model->time_scale(); !(span <= 1e15 && span >= 1e-100)) {
    const std::string found =
        fmt::format("{:g} s, {:.3g} times the time scale of the motion", scene.t_end, span);
    const char* expected = span < 1.0 ? "at least 1e-100 times" : "at most 1e15 times";
    if (changes.t_end) throw UsageError(fmt::format("--t-end: found {}, expected {}", found, expected));
    root.fail("t_end", found, expected);
  }
  for (const std::string& warning : parsed.warnings)
    scene.warnings.push_back(output::plain_text(fmt::format("{}: {}", source.file, warning)));
  scene.resolved["name"] = scene.name;
  scene.resolved["model"] = scene.model_name;
  if (!scene.description.empty()) scene.resolved["description"] = scene.description;
  scene.resolved["t_end"] = scene.t_end;
  scene.resolved.update(*parsed.resolved);
  return scene;
}

}  // namespace gnomon
