#include "models/planar_beam/read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "models/planar_beam/planar_beam.hpp"
#include "models/planar_beam/saved_state.hpp"
#include "src/scene_reader.hpp"

namespace gnomon::planar_beam {
namespace {

using Json = nlohmann::ordered_json;
using Table = Section;

std::array<double, 2> pair(const std::vector<double>& v) { return {v[0], v[1]}; }

void read_beam(Table& beam, Data& data, int& order, Json& resolved) {
  beam.only({"length", "elements", "order", "EA", "GA", "EI", "rhoA", "rhoI", "start", "angle", "curvature",
             "gravity", "geometry"});
  data.length = beam.positive("length", "a positive number (m)");
  data.elements = beam.integer("elements", 1, 1'000'000, "a whole number from 1 to 1000000");
  order = beam.integer("order", 1, 4, "a whole number from 1 to 4 (polynomial order of an element)");
  data.section = {beam.positive("EA", "a positive number (axial stiffness, N)"),
                  beam.positive("GA", "a positive number (shear stiffness, N)"),
                  beam.positive("EI", "a positive number (bending stiffness, N m^2)"),
                  beam.positive("rhoA", "a positive number (mass per length, kg/m)"),
                  beam.positive("rhoI", "a positive number (rotary inertia per length, kg m)")};
  data.start = pair(beam.numbers_or("start", {0.0, 0.0}, "two finite numbers (x, z of the start, m)"));
  data.angle = beam.number_or("angle", 0.0, "a finite number (rad, from x towards z)");
  data.curvature = beam.number_or("curvature", 0.0, "a finite number (1/m)");
  data.gravity = beam.number_or("gravity", 0.0, "a finite number (m/s^2, along -z)");
  std::string geometry = "interpolated";
  if (beam.has("geometry")) geometry = beam.one_of("geometry", {"interpolated", "exact"});
  data.geometry = geometry == "exact" ? Geometry::exact : Geometry::interpolated;
  // An element that turns by more than this has no sensible shape between its nodes.
  const double turn = std::abs(data.curvature) * data.length / data.elements;
  if (turn > 1.5)
    beam.fail("curvature", fmt::format("{}, {:.3g} rad an element", beam.shown("curvature"), turn),
              "at most 1.5 rad an element");
  const planar_beam::CrossSection& s = data.section;
  resolved["beam"] = {{"length", data.length},
                      {"elements", data.elements},
                      {"order", order},
                      {"EA", s.EA},
                      {"GA", s.GA},
                      {"EI", s.EI},
                      {"rhoA", s.rhoA},
                      {"rhoI", s.rhoI},
                      {"start", data.start},
                      {"angle", data.angle},
                      {"curvature", data.curvature},
                      {"gravity", data.gravity},
                      {"geometry", geometry}};
}

/// The prescribed rotation of an end.
Motion read_motion(Table& end, Json& resolved) {
  std::optional<Table> rotation = end.section("rotation");
  if (!rotation) end.fail("rotation", "nothing", "a table { kind = \"ramp\", to = .., over = .. } (rad, s)");
  const std::string kind = rotation->one_of("kind", {"ramp"});
  rotation->only({"kind", "to", "over"}, fmt::format("kind \"{}\"", kind));
  Motion motion;
  motion.to = rotation->number("to", "a finite number (about +y, rad)");
  motion.over = rotation->positive("over", "a positive number (s)");
  resolved["rotation"] = {{"kind", kind}, {"to", motion.to}, {"over", motion.over}};
  return motion;
}

Support read_support(Table& supports, const char* key, Json& resolved) {
  std::string kind = "free";
  Support support;
  if (!supports.has(key)) {
    resolved = kind;
    return support;
  }
  const std::vector<std::string> kinds{"free", "pinned", "clamped"};
  if (supports.is_table(key)) {
    Table end = *supports.section(key);
    kind = end.one_of("kind", {"free", "pinned", "clamped", "rotated"});
    const bool rotated = kind == "rotated";
    end.only(rotated ? std::vector<std::string>{"kind", "rotation"} : std::vector<std::string>{"kind"},
             fmt::format("kind \"{}\"", kind));
    if (rotated) {
      resolved = {{"kind", kind}};
      return {true, true, read_motion(end, resolved)};
    }
  } else {
    const std::string expected =
        choices_text(kinds) + ", or a table { kind = \"rotated\", rotation = { .. } }";
    kind = supports.text(key, expected);
    if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
      supports.fail(key, supports.shown(key), expected);
  }
  resolved = kind;
  return {kind != "free", kind == "clamped", std::nullopt};
}

void read_supports(Table& root, Data& data, Json& resolved) {
  Json& both = resolved["supports"] = {{"start", "free"}, {"end", "free"}};
  if (std::optional<Table> supports = root.section("supports")) {
    supports->only({"start", "end"});
    data.supports[0] = read_support(*supports, "start", both["start"]);
    data.supports[1] = read_support(*supports, "end", both["end"]);
  }
}

void read_profile(Table& table, Load& load, Json& resolved) {
  std::string kind = "constant";
  resolved["profile"] = {{"kind", kind}};
  std::optional<Table> profile = table.section("profile");
  if (!profile) return;
  kind = profile->one_of("kind", {"constant", "step", "ramp", "half-sine"});
  resolved["profile"]["kind"] = kind;
  const std::string owner = fmt::format("kind \"{}\"", kind);
  if (kind == "constant") {
    profile->only({"kind"}, owner);
    return;
  }
  const char* key = kind == "step" ? "until" : "over";
  profile->only({"kind", key}, owner);
  load.profile = kind == "step" ? Profile::step : kind == "ramp" ? Profile::ramp : Profile::half_sine;
  load.duration = profile->positive(key, "a positive number (s)");
  resolved["profile"][key] = load.duration;
}

void read_loads(Table& root, Data& data, Json& resolved) {
  resolved["loads"] = Json::array();
  for (Table& table : root.sections("loads")) {
    table.only({"at", "force", "moment", "profile"});
    Load load;
    Json one;
    const std::string at = table.one_of("at", {"start", "end", "distributed"});
    load.at = at == "start" ? Place::start : at == "end" ? Place::end : Place::distributed;
    load.force = pair(table.numbers_or("force", {0.0, 0.0}, "two finite numbers (x, z, N or N/m)"));
    load.moment = table.number_or("moment", 0.0, "a finite number (about +y, N m or N m/m)");
    one["at"] = at;
    one["force"] = load.force;
    one["moment"] = load.moment;
    read_profile(table, load, one);
    data.loads.push_back(load);
    resolved["loads"].push_back(one);
  }
}

void read_initial(Table& root, Data& data, Json& resolved) {
  Json& given = resolved["initial"];
  if (std::optional<Table> initial = root.section("initial")) {
    initial->only({"velocity", "angular_velocity", "state"});
    if (initial->has("state")) {
      for (const char* key : {"velocity", "angular_velocity"})
        if (initial->has(key))
          initial->fail(key, fmt::format("both state and {}", key), "only one of them (the motion at t = 0)");
      given["state"] = initial->text("state", "the path of a file written by gnomon run --json, in quotes");
      read_saved_state(*initial, resolved["beam"], data);
      given["state_hash"] = hash_of(data);
      return;
    }
    data.velocity = pair(initial->numbers_or("velocity", {0.0, 0.0}, "two finite numbers (x, z, m/s)"));
    data.angular_velocity = initial->number_or("angular_velocity", 0.0, "a finite number (about +y, rad/s)");
  }
  given = {{"velocity", data.velocity}, {"angular_velocity", data.angular_velocity}};
}

/// The initial motion must be one that the supports allow.
template <int p>
void check_motion(const PlanarBeam<p>& beam, const Table& root) {
  const Data& data = beam.data();
  if (!data.u.empty()) {
    for (int i : beam.held())
      if (data.u[i] != 0.0 || data.v[i] != 0.0)
        root.fail("initial", root.shown("initial"),
                  "a state in which the supported ends are at rest in place");
    return;
  }
  const double w = data.angular_velocity,
               size = std::hypot(data.velocity[0], data.velocity[1]) + std::abs(w) * data.length;
  for (int i : beam.held()) {
    const double arm[2] = {beam.positions()[2 * (i / 3)] - beam.centre()[0],
                           beam.positions()[2 * (i / 3) + 1] - beam.centre()[1]};
    const double rate[3] = {data.velocity[0] + w * arm[1], data.velocity[1] - w * arm[0], w};
    if (std::abs(rate[i % 3]) > 1e-6 * size)
      root.fail("initial", root.shown("initial"), "a rigid motion in which the supported ends do not move");
  }
}

template <int p>
std::shared_ptr<const AnyModel> make(const Data& data, const Table& root) {
  PlanarBeam<p> beam(data);
  check_motion(beam, root);
  return box(std::move(beam));
}

}  // namespace

ParsedModel read(Section& root, double t_end) {
  root.refuse_misspelt({"beam", "initial", "supports", "loads"});
  std::optional<Table> table = root.section("beam");
  if (!table)
    root.fail("beam", "nothing", "a table [beam] with length, elements, order and the section's data");
  Data data;
  data.horizon = t_end;
  int order = 1;
  Json resolved;
  read_beam(*table, data, order, resolved);
  read_initial(root, data, resolved);
  read_supports(root, data, resolved);
  read_loads(root, data, resolved);
  ParsedModel parsed;
  parsed.model = order == 1   ? make<1>(data, root)
                 : order == 2 ? make<2>(data, root)
                 : order == 3 ? make<3>(data, root)
                              : make<4>(data, root);
  parsed.resolved = std::make_shared<Json>(std::move(resolved));
  return parsed;
}

}  // namespace gnomon::planar_beam
