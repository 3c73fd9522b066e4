#include "models/rigid_body_ensemble/read.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "models/rigid_body_ensemble/ensemble.hpp"
#include "src/scene_reader.hpp"

namespace gnomon::rigid_body_ensemble {
namespace {

using Json = nlohmann::ordered_json;

Interval read_interval(Section& section, std::string_view key, bool zero_allowed, std::string_view what) {
  const std::string expected =
      fmt::format("two {} numbers, the least and the most ({})",
                  zero_allowed ? "numbers that are not negative, as" : "positive", what);
  const std::vector<double> v = section.numbers(key, 2, expected);
  if (v[0] > v[1] || v[0] < 0.0 || (v[0] == 0.0 && !zero_allowed))
    section.fail(key, section.shown(key), expected);
  return {v[0], v[1]};
}

std::vector<double> list(const Interval& interval) { return {interval.least, interval.most}; }

/// `[execution]`: how, not what.
Execution read_execution(Section& root, Json& resolved) {
  Execution execution{1, instruction_sets().back()};
  if (std::optional<Section> section = root.section("execution")) {
    section->only({"threads", "instructions"});
    if (section->has("threads"))
      execution.threads = section->integer("threads", 1, 1024, "a whole number of threads from 1 to 1024");
    if (section->has("instructions")) {
      std::vector<std::string> here{"widest"};
      for (const InstructionSet set : instruction_sets()) here.emplace_back(to_string(set));
      const std::string name = section->one_of("instructions", here);
      for (const InstructionSet set : instruction_sets())
        if (name == to_string(set)) execution.instructions = set;
    }
  }
  resolved["execution"] = {{"threads", execution.threads},
                           {"instructions", std::string(to_string(execution.instructions))}};
  return execution;
}

}  // namespace

ParsedModel read(Section& root, double t_end) {
  root.refuse_misspelt({"ensemble", "load", "execution"});
  std::optional<Section> section = root.section("ensemble");
  if (!section)
    root.fail("ensemble", "nothing", "a table [ensemble] with bodies, seed, inertia_kg_m2 and spin_rad_s");
  section->only({"bodies", "seed", "inertia_kg_m2", "spin_rad_s"});
  const int bodies = section->integer("bodies", 1, 10'000'000, "a whole number of bodies from 1 to 1e7");
  const int seed = section->integer("seed", 0, 2'147'483'647, "a whole number from 0 to 2147483647");
  Distribution from;
  from.seed = static_cast<std::uint64_t>(seed);
  from.inertia = read_interval(*section, "inertia_kg_m2", false, "principal moments, kg m^2");
  from.spin = read_interval(*section, "spin_rad_s", true, "angular speed, rad/s");

  Json resolved;
  resolved["ensemble"] = {{"bodies", bodies},
                          {"seed", seed},
                          {"inertia_kg_m2", list(from.inertia)},
                          {"spin_rad_s", list(from.spin)}};
  std::string kind = "none";
  if (std::optional<Section> load = root.section("load")) {
    kind = load->one_of("kind", {load_kinds.begin(), load_kinds.end()});
    const std::string owner = fmt::format("kind \"{}\"", kind);
    resolved["load"] = {{"kind", kind}};
    if (kind == "none") {
      load->only({"kind"}, owner);
    } else {
      const std::string key = kind == "gravity" ? "weight_times_arm_N_m" : "moment_N_m";
      load->only({"kind", key}, owner);
      from.load = read_interval(*load, key, true, "N m");
      resolved["load"][key] = list(from.load);
    }
  }
  const Execution execution = read_execution(root, resolved);
  ParsedModel parsed;
  const auto make = [&]<class L>(L*) {
    parsed.model = box(Ensemble<L>(draw_bodies(from, static_cast<std::size_t>(bodies)), execution, t_end));
  };
  if (kind == "gravity")
    make(static_cast<rigid_body::Gravity*>(nullptr));
  else if (kind == "space_moment")
    make(static_cast<rigid_body::SpaceMoment*>(nullptr));
  else
    make(static_cast<rigid_body::Free*>(nullptr));
  parsed.resolved = std::make_shared<Json>(std::move(resolved));
  return parsed;
}

}  // namespace gnomon::rigid_body_ensemble
