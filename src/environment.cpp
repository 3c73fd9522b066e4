#include "src/environment.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <Eigen/Core>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <thread>

#include "src/git_commit.hpp"
#include "src/measure/core.hpp"
#include "src/measure/timing.hpp"

namespace gnomon {
namespace {

std::string first_line(const std::string& path) {
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  return line;
}

std::string cpu_name() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

std::string compiler() {
#if defined(__clang__)
  return std::string("clang ") + __clang_version__;
#else
  return std::string("gcc ") + __VERSION__;
#endif
}

std::string governor() {
  const std::string value = first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  return value.empty() ? "not visible" : value;
}

/// Spread of a fixed piece of work over 50 repetitions of about 2 ms: what timing has to live with here.
TimingStats timer_noise() {
  std::vector<double> seconds;
  volatile double sink = 0.0;
  for (int k = 0; k < 50; ++k) {
    const double begin = thread_cpu_seconds();
    double x = 1.0;
    for (int i = 0; i < 400'000; ++i) x = x * 0.999999 + 1e-6;
    sink = sink + x;
    seconds.push_back(thread_cpu_seconds() - begin);
  }
  return summarise(seconds);
}

const Library* find(const Catalogue& catalogue, const std::string& name) {
  for (const Library& library : catalogue.libraries)
    if (library.name == name) return &library;
  return nullptr;
}

}  // namespace

nlohmann::ordered_json environment(const Catalogue& catalogue) {
  nlohmann::ordered_json json;
  json["cpu"] = cpu_name();
  json["cores"] = std::thread::hardware_concurrency();
  const std::optional<int> core = timing_core();
  json["timing_core"] = core ? nlohmann::ordered_json(*core) : nlohmann::ordered_json(nullptr);
  json["governor"] = governor();
  json["load"] = first_line("/proc/loadavg");
  json["compiler"] = compiler();
  json["flags"] = GNOMON_FLAGS;
  for (const Library& library : catalogue.libraries) {
    if (!library.optimised) {
      json[library.name] = library.version;
      continue;
    }
    json[library.name] = {
        {"version", library.version}, {"optimised", *library.optimised}, {"build", library.build}};
  }
  json["eigen"] = fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
  json["git"] = git_commit(GNOMON_SOURCE_DIR);
  json["date"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  return json;
}

std::string sundials_line(const Catalogue& catalogue) {
  const Library* library = find(catalogue, "sundials");
  if (!library) return "no SUNDIALS";
  return fmt::format(
      "SUNDIALS {} ({})", library->version,
      library->optimised.value_or(false)
          ? "compiled with optimisation: " + library->build
          : "no record of an optimised build; packaged libraries are compiled without, and take 2 to 4 "
            "times as long");
}

std::vector<Finding> examine(const Catalogue& catalogue) {
  const std::size_t thread_may_use = allowed_cores().size();
  std::vector<Finding> findings;
  const auto add = [&](bool good, std::string text) { findings.push_back({good, std::move(text)}); };
  add(true,
      fmt::format("gnomon {}, commit {}, {}", gnomon_version, git_commit(GNOMON_SOURCE_DIR), compiler()));
  const std::string flags = GNOMON_FLAGS;
  const bool optimised = flags.find("-O2") != std::string::npos || flags.find("-O3") != std::string::npos;
  add(optimised,
      fmt::format("compiler flags: {}{}", flags, optimised ? "" : "; times are meaningless without -O2"));
  const Library* sundials = find(catalogue, "sundials");
  add(sundials && sundials->optimised.value_or(false),
      sundials_line(catalogue) +
          (sundials && sundials->optimised.value_or(false)
               ? ""
               : "; let ./gnomon build it from source (it needs the network once), or set GNOMON_SUNDIALS"));
  for (const Library& library : catalogue.libraries)
    if (library.name != "sundials") add(true, fmt::format("{} {}", library.name, library.version));
  add(true, fmt::format("Eigen {}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION));
  const bool gnuplot = std::system("gnuplot --version >/dev/null 2>&1") == 0;
  add(gnuplot,
      gnuplot ? "gnuplot found: figures are drawn" : "gnuplot is missing: no figures; install gnuplot-nox");
  add(true, fmt::format("CPU: {}, {} cores", cpu_name(), std::thread::hardware_concurrency()));
  const OnOneCore pinned;
  add(pinned.core().has_value(),
      pinned.core()
          ? fmt::format("timed runs stay on core {} of the {} allowed", *pinned.core(), thread_may_use)
          : "timed runs cannot be kept on one core: they may be moved while they run");
  const std::string mode = governor();
  add(mode == "performance" || mode == "not visible",
      fmt::format(
          "frequency governor: {}{}", mode,
          mode == "performance" || mode == "not visible" ? "" : "; 'performance' gives steadier times"));
  double load[1] = {0.0};
  if (getloadavg(load, 1) == 1) {
    const bool quiet = load[0] < 0.5 * std::max(1U, std::thread::hardware_concurrency());
    add(quiet, fmt::format("load {:.2f}{}", load[0], quiet ? "" : "; other programs disturb timing"));
  }
  const TimingStats noise = timer_noise();
  add(!noise.unstable && noise.max < 1.5 * noise.min,
      fmt::format(
          "timer: {:.0f} ns a call; the same work takes {:.3f} to {:.3f} ms, median deviation {:.2f} %{}",
          1e9 * timer_cost(), 1e3 * noise.min, 1e3 * noise.max, 100.0 * noise.mdape,
          noise.unstable || noise.max >= 1.5 * noise.min ? "; noisy: look at spreads before comparing" : ""));
  return findings;
}

}  // namespace gnomon
