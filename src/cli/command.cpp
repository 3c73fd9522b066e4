#include "src/cli/command.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "src/error.hpp"
#include "src/output/files.hpp"

namespace gnomon::cli {
namespace {

double number(const std::string& option, const std::string& text, const std::string& expected) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end || !std::isfinite(value))
    throw UsageError(fmt::format("{}: found '{}', expected {}", option, text, expected));
  return value;
}

long whole(const std::string& option, const std::string& text, long least, const std::string& expected) {
  long value = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end || value < least)
    throw UsageError(fmt::format("{}: found '{}', expected {}", option, text, expected));
  return value;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  if (!text.empty() && text.back() == ',') parts.emplace_back();
  return parts;
}

}  // namespace

double positive_number(const std::string& option, const std::string& text, const std::string& expected) {
  const double value = number(option, text, expected);
  if (value <= 0.0) throw UsageError(fmt::format("{}: found '{}', expected {}", option, text, expected));
  return value;
}

StudyOptions study_options(const Request& request) {
  StudyOptions options;
  options.integrators = split(request.integrators);
  const auto numbers = [](const std::string& option, const std::string& text, const std::string& expected) {
    std::vector<double> values;
    for (const std::string& part : split(text)) values.push_back(positive_number(option, part, expected));
    return values;
  };
  const auto tolerance = [](const std::string& option, const std::string& text) {
    const double value = positive_number(option, text, "a tolerance between 0 and 1");
    if (value >= 1.0)
      throw UsageError(fmt::format("{}: found '{}', expected a tolerance between 0 and 1", option, text));
    return value;
  };
  options.steps = numbers("--steps", request.steps, "positive numbers separated by commas (s)");
  for (const std::string& part : split(request.tols)) options.tols.push_back(tolerance("--tols", part));
  if (!request.step.empty())
    options.steps = {positive_number("--step", request.step, "a positive number (s)")};
  if (!request.tol.empty()) options.tols = {tolerance("--tol", request.tol)};
  if (!request.samples.empty())
    options.samples = static_cast<int>(whole("--samples", request.samples, 1, "a positive whole number"));
  if (!request.max_steps.empty())
    options.max_steps = whole("--max-steps", request.max_steps, 1, "a positive whole number");
  if (!request.time_limit.empty())
    options.time_limit = positive_number("--time-limit", request.time_limit, "a positive number (s)");
  if (!request.newton_tol.empty()) options.newton_tol = tolerance("--newton-tol", request.newton_tol);
  options.reference = !request.no_reference;
  options.timing = !request.no_timing;
  options.quick = request.quick;
  return options;
}

SceneChanges scene_changes(const Request& request) {
  SceneChanges changes;
  changes.set = request.set;
  if (!request.t_end.empty())
    changes.t_end = positive_number("--t-end", request.t_end, "a positive number (s)");
  return changes;
}

std::vector<Scene> load_scenes(const Context& context) {
  std::vector<Scene> scenes;
  for (const std::string& name : context.request.scenes)
    scenes.push_back(load_scene(context.catalogue, name, scene_changes(context.request)));
  if (scenes.empty())
    throw UsageError("SCENE: found nothing, expected the name of a shipped scene or a .toml file");
  for (const Scene& scene : scenes)
    for (const std::string& warning : scene.warnings) std::cerr << "gnomon: warning: " << warning << '\n';
  return scenes;
}

void check_outputs(const Request& request) {
  namespace fs = std::filesystem;
  const auto check_file = [](const std::string& option, const std::string& name) {
    if (name.empty() || name == "-") return;
    const fs::path path(name);
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (fs::is_directory(path))
      throw UsageError(fmt::format("{}: found '{}', a folder, expected a file name", option, name));
    if (!fs::is_directory(folder))
      throw UsageError(fmt::format("{}: found '{}', expected a file in a folder that exists", option, name));
  };
  check_file("--json", request.json);
  check_file("--csv", request.csv);
  if (!request.out.empty() && fs::exists(request.out) && !fs::is_directory(request.out))
    throw UsageError(fmt::format("--out: found '{}', a file, expected a folder", request.out));
}

void say(const Request& request, const std::string& line) {
  if (request.json != "-" && request.csv != "-") fmt::print("{}\n", line);
}

void show(const Request& request, const output::Table& table) { say(request, output::to_text(table)); }

void write_outputs(const Request& request, const Document& document,
                   const std::vector<output::Table>& tables) {
  const auto write = [](const std::string& name, const std::string& text) {
    if (name.empty()) return;
    if (name == "-")
      fmt::print("{}", text);
    else
      output::write_file_atomically(name, text);
  };
  write(request.json, document.text());
  std::string csv;
  for (const output::Table& table : tables) csv += (csv.empty() ? "" : "\n") + output::to_csv(table);
  write(request.csv, csv);
  std::fflush(stdout);
}

void write_json(const Request& request, const nlohmann::ordered_json& json) {
  if (request.json.empty()) return;
  if (request.json == "-")
    fmt::print("{}\n", json.dump(1));
  else
    output::write_file_atomically(request.json, json.dump(1) + "\n");
}

void check_ladders(const Context& context, const std::vector<Scene>& scenes, const StudyOptions& options) {
  for (const Scene& scene : scenes) {
    bool fixed = false, adaptive = false;
    for (const SchemeInfo* scheme : select(context.catalogue, scene, options)) {
      fixed = fixed || scheme->stepping == Stepping::fixed;
      adaptive = adaptive || scheme->stepping == Stepping::adaptive;
    }
    if (!options.steps.empty() && !fixed)
      throw UsageError(
          "--steps: found steps, expected --tols because every chosen integrator chooses its own steps");
    if (!options.tols.empty() && !adaptive)
      throw UsageError(
          "--tols: found tolerances, expected --steps because every chosen integrator takes equal steps");
  }
}

std::string reference_folder() { return std::string(GNOMON_BINARY_DIR) + "/references"; }

int verdict(const Context& context, const std::vector<const SceneStudy*>& studies) {
  bool failed = false;
  for (const SceneStudy* study : studies)
    for (const Row& row : study->rows) {
      if (row.result.status == Status::ok || row.result.status == Status::interrupted) continue;
      failed = true;
      if (!context.request.integrators.empty())
        std::cerr << fmt::format("gnomon: {} / {}, {}: {}: {}\n", study->scene.name, row.scheme->name,
                                 row.setting.text(), to_string(row.result.status), row.result.message);
    }
  if (context.stop.load()) {
    std::cerr << "gnomon: interrupted; what was finished is kept\n";
    return interrupted;
  }
  return failed && !context.request.integrators.empty() ? run_failed : done;
}

}  // namespace gnomon::cli
