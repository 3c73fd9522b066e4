#include "models/planar_beam/read.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "models/planar_beam/planar_beam.hpp"
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

void read_supports(Table& root, Data& data, Json& resolved) {
  std::string kinds[2] = {"free", "free"};
  if (std::optional<Table> supports = root.section("supports")) {
    supports->only({"start", "end"});
    const char* ends[2] = {"start", "end"};
    for (int k = 0; k < 2; ++k) {
      if (!supports->has(ends[k])) continue;
      if (supports->is_table(ends[k]))
        supports->fail(ends[k], supports->shown(ends[k]),
                       "one of free, pinned, clamped (this version has no rotated supports)");
      kinds[k] = supports->one_of(ends[k], {"free", "pinned", "clamped"});
      data.supports[k] = {kinds[k] != "free", kinds[k] == "clamped"};
    }
  }
  resolved["supports"] = {{"start", kinds[0]}, {"end", kinds[1]}};
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
  if (std::optional<Table> initial = root.section("initial")) {
    initial->only({"velocity", "angular_velocity", "state"});
    if (initial->has("state"))
      initial->fail("state", initial->shown("state"),
                    "velocity and angular_velocity (this version starts from no saved state)");
    data.velocity = pair(initial->numbers_or("velocity", {0.0, 0.0}, "two finite numbers (x, z, m/s)"));
    data.angular_velocity = initial->number_or("angular_velocity", 0.0, "a finite number (about +y, rad/s)");
  }
  resolved["initial"] = {{"velocity", data.velocity}, {"angular_velocity", data.angular_velocity}};
}

/// The initial motion must be one that the supports allow.
template <int p>
void check_motion(const PlanarBeam<p>& beam, const Table& root) {
  const Data& data = beam.data();
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
