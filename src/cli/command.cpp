#include "src/cli/command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "src/error.hpp"
#include "src/output/files.hpp"
#include "src/output/latex.hpp"

namespace gnomon::cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& option, const std::string& text, std::string_view expected) {
  throw UsageError(fmt::format("{}: found '{}', expected {}", option, text, expected));
}

constexpr std::string_view nobody_takes_it = "nothing because no chosen integrator takes it";

double number(const std::string& option, const std::string& text, const std::string& expected) {
  const bool plus = text.starts_with("+") && !text.starts_with("+-");
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data() + (plus ? 1 : 0), end, value);
  if (result.ec != std::errc() || result.ptr != end || !std::isfinite(value)) refuse(option, text, expected);
  return value;
}

/// Writes to a file, to standard output where that is "-", or not at all.
void write_text(const std::string& name, const std::string& text) {
  if (name.empty()) return;
  if (name == "-")
    fmt::print("{}", text);
  else
    output::write_file_atomically(name, text);
}

/// Throws if what was printed could not be written, as on a full disk.
void flush_output() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    throw std::runtime_error("standard output cannot be written");
}

/// Refuses steps so short that their number could not be counted exactly.
void check_steps(const Request& request, const std::vector<Scene>& scenes) {
  const StudyOptions options = study_options(request);
  for (const Scene& scene : scenes)
    for (const double step : options.steps)
      if (!(scene.t_end / step <= 1e15))
        refuse(request.step.empty() ? "--steps" : "--step",
               request.step.empty() ? fmt::format("{:g}", step) : request.step,
               fmt::format("at least {:g} s, {:g} s / 1e15", scene.t_end / 1e15, scene.t_end));
}

}  // namespace

int jobs_of(const Request& request, int otherwise) {
  return request.jobs.empty() ? otherwise : static_cast<int>(whole_number("--jobs", request.jobs, 1024));
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  if (!text.empty() && text.back() == ',') parts.emplace_back();
  return parts;
}

double positive_number(const std::string& option, const std::string& text, const std::string& expected) {
  const double value = number(option, text, expected);
  if (value <= 0.0) refuse(option, text, expected);
  return value;
}

long whole_number(const std::string& option, const std::string& text, long most) {
  long value = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end || value < 1 || value > most)
    refuse(option, text, fmt::format("a whole number from 1 to {}, in digits", most));
  return value;
}

/// Of an adaptive solver; below, errors that it estimates are roundoff.
constexpr double least_tolerance = 1e-15;

StudyOptions study_options(const Request& request) {
  StudyOptions options;
  const auto tolerance = [](const std::string& option, const std::string& text, const std::string& expected,
                            double least) {
    const double value = positive_number(option, text, expected);
    if (value < least || value >= 1.0) refuse(option, text, expected);
    return value;
  };
  const auto each = [](const std::string& option, const std::string& list, auto&& read) {
    std::vector<double> values;
    for (const std::string& part : split(list)) {
      const double value = read(option, part);
      if (std::find(values.begin(), values.end(), value) != values.end())
        throw UsageError(fmt::format("{}: found '{}' twice, expected every value once", option, part));
      values.push_back(value);
    }
    return values;
  };
  for (std::string& name : split(request.integrators)) {
    if (name.empty()) refuse("--integrators", request.integrators, "names with one comma between them");
    if (std::find(options.integrators.begin(), options.integrators.end(), name) != options.integrators.end())
      throw UsageError(fmt::format("--integrators: found '{}' twice, expected every name once", name));
    options.integrators.push_back(std::move(name));
  }
  const auto only_one = [](const char* one, const std::string& text, const char* other, bool both) {
    if (both)
      throw UsageError(fmt::format("{}: found '{}' beside {}, expected only one of them", one, text, other));
  };
  only_one("--step", request.step, "--steps", !request.step.empty() && !request.steps.empty());
  only_one("--tol", request.tol, "--tols", !request.tol.empty() && !request.tols.empty());
  options.steps = each("--steps", request.steps, [](const std::string& option, const std::string& text) {
    return positive_number(option, text, "positive numbers (s) with one comma between them");
  });
  options.tols = each("--tols", request.tols, [&](const std::string& option, const std::string& text) {
    return tolerance(
        option, text,
        fmt::format(
            "tolerances from {:g} (about the precision of numbers) to below 1, with one comma between them",
            least_tolerance),
        least_tolerance);
  });
  options.error_times =
      each("--error-at", request.error_at, [](const std::string& option, const std::string& text) {
        return positive_number(option, text, "positive numbers (s) with one comma between them");
      });
  std::ranges::sort(options.error_times);
  const std::string tolerance_text =
      fmt::format("a tolerance from {:g} (about the precision of numbers) to below 1", least_tolerance);
  if (!request.step.empty())
    options.steps = {positive_number("--step", request.step, "a positive number (s)")};
  if (!request.tol.empty()) options.tols = {tolerance("--tol", request.tol, tolerance_text, least_tolerance)};
  if (!request.samples.empty())
    options.samples = static_cast<int>(whole_number("--samples", request.samples, 1'000'000));
  if (!request.max_steps.empty())
    options.max_steps = whole_number("--max-steps", request.max_steps, 1'000'000'000'000'000);
  if (!request.time_limit.empty())
    options.time_limit = positive_number("--time-limit", request.time_limit, "a positive number (s)");
  if (!request.newton_tol.empty())
    options.scheme.newton_tol =
        tolerance("--newton-tol", request.newton_tol, "a tolerance between 0 and 1", 0.0);
  if (!request.spectral_radius.empty()) {
    const std::string expected = "a number from 0 to 1";
    const double value = number("--spectral-radius", request.spectral_radius, expected);
    if (value < 0.0 || value > 1.0) refuse("--spectral-radius", request.spectral_radius, expected);
    options.scheme.spectral_radius = value;
  }
  options.scheme.modified_newton = request.modified_newton;
  if (!request.linear_solver.empty()) {
    const auto found = std::ranges::find(linear_solver_names, request.linear_solver);
    if (found == linear_solver_names.end())
      refuse("--linear-solver", request.linear_solver, "block, band, lapack, klu or sparselu");
    options.scheme.linear_solver = static_cast<LinearSolver>(found - linear_solver_names.begin());
  }
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

std::optional<Variation> variation(const Request& request) {
  if (request.vary.empty()) return std::nullopt;
  return read_variation("--vary", request.vary);
}

std::vector<Scene> load_scenes(const Context& context) {
  std::vector<Scene> scenes;
  const auto load = [&](const std::string& name, const SceneChanges& changes) {
    scenes.push_back(load_scene(context.catalogue, name, changes));
    for (std::size_t k = 0; k + 1 < scenes.size(); ++k)
      if (scenes[k].name == scenes.back().name)
        throw UsageError(fmt::format("SCENE: found two scenes with the name '{}', expected different names",
                                     scenes.back().name));
  };
  const std::optional<Variation> varied = variation(context.request);
  SceneChanges changes = scene_changes(context.request);
  for (const std::string& name : context.request.scenes) {
    if (!varied) load(name, changes);
    for (std::size_t k = 0; varied && k < varied->values.size(); ++k) {
      changes.vary = varied->assignment(k);
      load(name, changes);
    }
  }
  if (scenes.empty())
    throw UsageError("SCENE: found nothing, expected the name of a shipped scene or a .toml file");
  check_steps(context.request, scenes);
  return scenes;
}

void warn(const std::vector<Scene>& scenes) {
  for (const Scene& scene : scenes)
    for (const std::string& warning : scene.warnings) std::cerr << "gnomon: warning: " << warning << '\n';
}

void check_outputs(const Request& request) {
  const auto writable = [](const fs::path& path) { return ::access(path.c_str(), W_OK) == 0; };
  const auto check_file = [&](const std::string& option, const std::string& name) {
    if (name.empty() || name == "-") return;
    const fs::path path(name);
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::error_code code;
    if (fs::is_directory(path, code))
      throw UsageError(fmt::format("{}: found the folder '{}', expected a file", option, name));
    if (!fs::is_directory(folder, code)) refuse(option, name, "a file in a folder that exists");
    if (!writable(fs::is_regular_file(path, code) || !fs::exists(path, code) ? folder : path))
      refuse(option, name, "a file that can be written");
  };
  check_file("--json", request.json);
  check_file("--csv", request.csv);
  check_file("--latex", request.latex);
  if (!request.json.empty() && request.json == request.csv)
    throw UsageError(fmt::format("--csv: found '{}' as in --json, expected another file", request.csv));
  for (const auto& [option, name] : {std::pair{"--json", request.json}, {"--csv", request.csv}})
    if (!name.empty() && name == request.latex)
      throw UsageError(fmt::format("--latex: found '{}' as in {}, expected another file", name, option));
  if (request.out.empty()) return;
  // Folders that are not there are made in the first one above them that is.
  std::error_code code;
  const fs::path asked = fs::absolute(request.out, code);
  fs::path existing = asked;
  while (!fs::exists(existing, code) && existing.has_relative_path()) existing = existing.parent_path();
  if (!fs::is_directory(existing, code))
    throw UsageError(fmt::format("--out: found the file '{}', expected a folder",
                                 existing == asked ? request.out : existing.string()));
  if (!writable(existing)) refuse("--out", request.out, "a folder that can be written");
}

void say(const Request& request, const std::string& line) {
  if (request.json != "-" && request.csv != "-" && request.latex != "-") fmt::print("{}\n", line);
}

void show(const Request& request, const output::Table& table) { say(request, output::to_text(table)); }

void write_outputs(const Request& request, const Document& document, const std::vector<output::Table>& tables,
                   const std::vector<output::Table>& further) {
  write_text(request.json, document.text());
  write_csv(request, tables);
  std::vector<output::Table> all = tables;
  all.insert(all.end(), further.begin(), further.end());
  write_text(request.latex, output::latex_document(all));
}

void write_json(const Request& request, const nlohmann::ordered_json& json) {
  write_text(request.json, json.dump(1) + "\n");
  flush_output();
}

void write_csv(const Request& request, const std::vector<output::Table>& tables) {
  std::string csv;
  for (const output::Table& table : tables) csv += (csv.empty() ? "" : "\n") + output::to_csv(table);
  write_text(request.csv, csv);
  flush_output();
}

void check_scheme_options(const Context& context, const std::vector<Scene>& scenes,
                          const StudyOptions& options) {
  const Request& request = context.request;
  OptionUse used;
  for (const Scene& scene : scenes) {
    bool takes_radius = false;
    for (const SchemeInfo* scheme : select(context.catalogue, scene, options)) {
      used.newton_tol |= scheme->uses.newton_tol;
      used.modified_newton |= scheme->uses.modified_newton;
      used.linear_solver |= scheme->uses.linear_solver;
      if (!scheme->spectral_radii || !options.scheme.spectral_radius) continue;
      takes_radius = true;
      const auto [least, most] = *scheme->spectral_radii;
      if (*options.scheme.spectral_radius < least || *options.scheme.spectral_radius > most)
        throw UsageError(fmt::format("--spectral-radius: found '{}', expected {:g} to {:g} for {}",
                                     request.spectral_radius, least, most, scheme->name));
    }
    if (options.scheme.spectral_radius && !takes_radius)
      refuse("--spectral-radius", request.spectral_radius, nobody_takes_it);
  }
  // Not refused: scripts give it to all implicit schemes, also to those that iterate to rounding.
  if (!request.newton_tol.empty() && !used.newton_tol && !request.quiet)
    std::cerr << "gnomon: --newton-tol: no chosen integrator uses it\n";
  if (!request.linear_solver.empty() && !used.linear_solver)
    refuse("--linear-solver", request.linear_solver, nobody_takes_it);
  if (request.modified_newton && !used.modified_newton)
    throw UsageError(fmt::format("--modified-newton: found --modified-newton, expected {}", nobody_takes_it));
}

void check_ladders(const Context& context, const std::vector<Scene>& scenes, const StudyOptions& options) {
  const Request& request = context.request;
  for (const Scene& scene : scenes) {
    bool fixed = false, adaptive = false;
    for (const SchemeInfo* scheme : select(context.catalogue, scene, options)) {
      fixed = fixed || scheme->stepping == Stepping::fixed;
      adaptive = adaptive || scheme->stepping == Stepping::adaptive;
    }
    const auto check = [&](const std::string& text, const std::string& option, bool used, bool other_used,
                           std::string_view other, std::string_view because) {
      if (text.empty() || used) return;
      if (!other_used)
        throw UsageError(fmt::format("{}: found '{}', expected nothing because only closed forms are to run",
                                     option, text));
      throw UsageError(fmt::format("{}: found '{}', expected {} because no chosen integrator {}", option,
                                   text, other, because));
    };
    const char *equal = "takes equal steps", *own = "chooses its own steps";
    check(request.step, "--step", fixed, adaptive, "--tol", equal);
    check(request.steps, "--steps", fixed, adaptive, "--tols", equal);
    check(request.tol, "--tol", adaptive, fixed, "--step", own);
    check(request.tols, "--tols", adaptive, fixed, "--steps", own);
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
