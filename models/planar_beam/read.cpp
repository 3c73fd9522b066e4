#include "models/planar_beam/read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "models/planar_beam/planar_beam.hpp"
#include "models/planar_beam/read_parts.hpp"
#include "models/planar_beam/saved_state.hpp"
#include "src/instruction_set.hpp"
#include "src/scene_reader.hpp"

namespace gnomon::planar_beam {
namespace {

using Json = nlohmann::ordered_json;
using Table = Section;

std::array<double, 2> pair(const std::vector<double>& v) { return {v[0], v[1]}; }

/// Where a joint may be.
std::string place_of(const Data& data, std::string_view behind) {
  return fmt::format("a multiple of {:.6g} m, where two elements meet, inside the beam of {:.6g} m{}",
                     data.length / data.elements, data.length, behind);
}

/// Rigid joints, each where two elements meet.
Json read_bends(Table& beam, Data& data) {
  Json resolved = Json::array();
  for (Table& table : beam.sections("bends")) {
    table.only({"at", "angle"});
    const std::string meeting = place_of(data, data.bends.empty() ? "" : ", behind the bend before it");
    Bend bend{};
    bend.at = table.number("at", meeting);
    if (!is_meeting(bend.at, data) || (!data.bends.empty() && !(data.bends.back().at < bend.at)))
      table.fail("at", table.shown("at"), meeting);
    const char* angle = "a number between -pi and pi (rad, from x towards z)";
    bend.angle = table.number("angle", angle);
    if (!(std::abs(bend.angle) < std::numbers::pi)) table.fail("angle", table.shown("angle"), angle);
    data.bends.push_back(bend);
    resolved.push_back({{"at", bend.at}, {"angle", bend.angle}});
  }
  return resolved;
}

/// Joints that turn freely or against a spring, each where two elements meet.
Json read_hinges(Table& beam, Data& data) {
  Json resolved = Json::array();
  for (Table& table : beam.sections("hinges")) {
    table.only({"at", "spring"});
    const std::string meeting = place_of(data, data.hinges.empty() ? "" : ", behind the hinge before it");
    Hinge hinge{};
    hinge.at = table.number("at", meeting);
    if (!is_meeting(hinge.at, data) || (!data.hinges.empty() && !(data.hinges.back().at < hinge.at)))
      table.fail("at", table.shown("at"), meeting);
    resolved.push_back({{"at", hinge.at}});
    if (table.has("spring"))
      resolved.back()["spring"] = hinge.spring =
          table.positive("spring", "a positive number (torsion spring between both sides, N m/rad)");
    data.hinges.push_back(hinge);
  }
  return resolved;
}

void read_beam(Table& beam, Data& data, int& order, Json& resolved) {
  beam.only({"length", "elements", "order", "EA", "GA", "EI", "rhoA", "rhoI", "start", "angle", "curvature",
             "gravity", "damping", "bends", "hinges", "geometry"});
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
  const char* damping = "a number that is not negative (1/s, proportional to mass)";
  data.damping = beam.number_or("damping", 0.0, damping);
  if (data.damping < 0.0) beam.fail("damping", beam.shown("damping"), damping);
  std::string geometry = "interpolated";
  if (beam.has("geometry")) geometry = beam.one_of("geometry", {"interpolated", "exact"});
  data.geometry = geometry == "exact" ? Geometry::exact : Geometry::interpolated;
  // An element that turns by more than this has no sensible shape between its nodes.
  const double turn = std::abs(data.curvature) * data.length / data.elements;
  if (turn > 1.5)
    beam.fail("curvature", fmt::format("{}, {:.3g} rad an element", beam.shown("curvature"), turn),
              "at most 1.5 rad an element");
  const Json bends = read_bends(beam, data), hinges = read_hinges(beam, data);
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
                      {"damping", data.damping},
                      {"bends", bends},
                      {"geometry", geometry}};
  if (!hinges.empty()) resolved["beam"]["hinges"] = hinges;
}

/// True where the beam is to start in equilibrium.
bool read_initial(Table& root, Data& data, Json& resolved) {
  Json& given = resolved["initial"];
  if (std::optional<Table> initial = root.section("initial")) {
    initial->only({"velocity", "angular_velocity", "state"});
    if (initial->has("state")) {
      for (const char* key : {"velocity", "angular_velocity"})
        if (initial->has(key))
          initial->fail(key, fmt::format("both state and {}", key), "only one of them (the motion at t = 0)");
      given["state"] =
          initial->text("state", "\"static\", or the path of a file written by gnomon run --json, in quotes");
      if (given["state"] == "static") return true;
      read_saved_state(*initial, resolved["beam"], data);
      given["state_hash"] = hash_of(data);
      return false;
    }
    data.velocity = pair(initial->numbers_or("velocity", {0.0, 0.0}, "two finite numbers (x, z, m/s)"));
    data.angular_velocity = initial->number_or("angular_velocity", 0.0, "a finite number (about +y, rad/s)");
  }
  given = {{"velocity", data.velocity}, {"angular_velocity", data.angular_velocity}};
  return false;
}

/// How, not what: nothing where the scene says nothing.
void read_execution(Table& root, Data& data, Json& resolved) {
  std::optional<Table> execution = root.section("execution");
  if (!execution) return;
  execution->only({"instructions"});
  std::vector<std::string> here{"scalar"};
  for (const InstructionSet set : instruction_sets()) here.emplace_back(to_string(set));
  data.instructions = execution->one_of("instructions", here);
  resolved["execution"] = {{"instructions", data.instructions}};
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
    for (int i : beam.numbering().tied())
      if (data.u[i] != data.u[i + 3] || data.v[i] != data.v[i + 3])
        root.fail("initial", root.shown("initial"),
                  "a state in which both sides of a hinge are in one place");
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

/// Starts the beam in equilibrium with the loads of t = 0.
void start_at_rest(StaticSystem& system, const Table& root, Data& data) {
  if (const std::string found = system.refusal(); !found.empty())
    root.fail("initial", found, "supports that hold the beam where it is to start in equilibrium");
  const StaticPath path = follow_equilibrium(system);
  if (path.status != Status::ok)
    root.fail("initial", path.message,
              "loads at t = 0 that the beam bears where it is to start in equilibrium");
  const std::vector<double>& state = path.points.back().state;
  data.u.assign(state.begin(), state.begin() + system.size());
  data.v.assign(data.u.size(), 0.0);
}

/// A beam of which supports hold everything has no motion to compute.
template <int p>
void check_free(const PlanarBeam<p>& beam, const Table& root) {
  if (beam.free().empty())
    root.fail("supports", fmt::format("supports that hold all {} unknowns of the beam", beam.unknowns()),
              "an end that can move, or more elements or a higher order ([beam] elements, order)");
}

template <int p>
std::shared_ptr<const AnyModel> make(Data& data, bool at_rest, const Table& root) {
  if (at_rest) {
    const PlanarBeam<p> beam(data);
    check_free(beam, root);
    start_at_rest(*beam.statics(LoadCase::first), root, data);
  }
  PlanarBeam<p> beam(data);
  check_free(beam, root);
  check_motion(beam, root);
  return box(std::move(beam));
}

}  // namespace

ParsedModel read(Section& root, double t_end) {
  root.refuse_misspelt({"beam", "initial", "supports", "loads", "execution"});
  std::optional<Table> table = root.section("beam");
  if (!table)
    root.fail("beam", "nothing", "a table [beam] with length, elements, order and the section's data");
  Data data;
  data.horizon = t_end;
  int order = 1;
  Json resolved;
  read_beam(*table, data, order, resolved);
  const bool at_rest = read_initial(root, data, resolved);
  read_supports(root, data, resolved);
  read_loads(root, data, resolved);
  read_execution(root, data, resolved);
  ParsedModel parsed;
  parsed.model = order == 1   ? make<1>(data, at_rest, root)
                 : order == 2 ? make<2>(data, at_rest, root)
                 : order == 3 ? make<3>(data, at_rest, root)
                              : make<4>(data, at_rest, root);
  parsed.resolved = std::make_shared<Json>(std::move(resolved));
  return parsed;
}

}  // namespace gnomon::planar_beam
