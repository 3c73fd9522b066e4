#include "models/rigid_body/read.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "models/rigid_body/rigid_body.hpp"
#include "src/scene_reader.hpp"

namespace gnomon::rigid_body {
namespace {

using Json = nlohmann::ordered_json;

Eigen::Vector3d vector(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }
std::vector<double> list(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

Eigen::Quaterniond read_orientation(Section& body) {
  const bool quaternion = body.has("orientation"), rotation = body.has("rotation_vector");
  if (quaternion || rotation) {
    const std::string key = body.exactly_one("orientation", "rotation_vector", "the attitude at t = 0");
    if (key == "rotation_vector") {
      const Eigen::Vector3d p = vector(body.numbers(key, 3, "three finite numbers (rotation vector, rad)"));
      const double angle = p.norm();
      if (!std::isfinite(angle))
        body.fail(key, body.shown(key), "three numbers with a finite norm (rotation vector, rad)");
      return angle > 0.0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, p / angle))
                         : Eigen::Quaterniond::Identity();
    }
    const auto v = body.numbers(key, 4, "four finite numbers (unit quaternion w, x, y, z, body -> space)");
    Eigen::Quaterniond q(v[0], v[1], v[2], v[3]);
    if (std::abs(q.norm() - 1.0) > 1e-6)
      body.fail(key, fmt::format("{} with norm {:.9g}", body.shown(key), q.norm()),
                "a unit quaternion (norm 1 to 1e-6)");
    return q.normalized();
  }
  return Eigen::Quaterniond::Identity();
}

AttitudePotential read_potential(Section& load, const Eigen::Quaterniond& start, Json& resolved) {
  load.only({"kind", "stiffness", "rest", "attraction", "attractor"}, "kind \"attitude_potential\"");
  AttitudePotential potential{};
  potential.stiffness = load.number_or("stiffness", 0.0, "a finite number (of the spring, J)");
  potential.rest = load.number_or("rest", 0.0, "a finite number (length of the spring at rest)");
  potential.attraction = load.number_or("attraction", 0.0, "a finite number (J)");
  const Eigen::Vector3d p =
      vector(load.numbers("attractor", 3, "three finite numbers (rotation vector of the attractor, rad)"));
  const double angle = p.norm();
  const Eigen::Quaterniond q(
      Eigen::AngleAxisd(angle, angle > 0.0 ? Eigen::Vector3d(p / angle) : Eigen::Vector3d::UnitX()));
  potential.attractor = {q.w(), q.x(), q.y(), q.z()};
  if (potential.attraction != 0.0 && (q.conjugate() * start).vec().norm() <= 1e-14)
    load.fail("attractor", load.shown("attractor"),
              "another attitude than the one at t = 0: the potential is infinite at the attractor");
  resolved["stiffness"] = potential.stiffness;
  resolved["rest"] = potential.rest;
  resolved["attraction"] = potential.attraction;
  resolved["attractor"] = list(p);
  return potential;
}

}  // namespace

ParsedModel read(Section& root, double t_end) {
  root.refuse_misspelt({"body", "load"});
  std::optional<Section> body = root.section("body");
  if (!body)
    root.fail("body", "nothing", "a table [body] with inertia and angular_momentum or angular_velocity");
  body->only({"inertia", "orientation", "rotation_vector", "angular_momentum", "angular_velocity"});

  const Eigen::Vector3d inertia =
      vector(body->numbers("inertia", 3, "three positive numbers (principal moments, kg m^2)"));
  if (inertia.minCoeff() <= 0.0)
    body->fail("inertia", body->shown("inertia"), "three positive numbers (principal moments, kg m^2)");
  const Eigen::Quaterniond q = read_orientation(*body);
  const std::string key = body->exactly_one("angular_momentum", "angular_velocity", "the motion at t = 0");
  const bool momentum = key == "angular_momentum";
  const Eigen::Vector3d given =
      vector(body->numbers(key, 3,
                           momentum ? "three finite numbers (body components, kg m^2/s)"
                                    : "three finite numbers (body components, rad/s)"));
  const Eigen::Vector3d m = momentum ? given : Eigen::Vector3d(given.cwiseProduct(inertia));
  if (!m.allFinite())
    body->fail(key, body->shown(key), "three numbers whose products with the inertia are finite (rad/s)");

  ParsedModel parsed;
  const double coefficients[4] = {q.w(), q.x(), q.y(), q.z()};
  const State initial{homogeneous_matrix(coefficients), m};
  Json resolved;
  resolved["body"] = {{"inertia", list(inertia)},
                      {"orientation", std::vector<double>(coefficients, coefficients + 4)},
                      {"angular_momentum", list(m)}};
  const double sum = inertia.sum(), largest = inertia.maxCoeff();
  if (2.0 * largest > sum * (1.0 + 1e-12))
    parsed.warnings.push_back(
        fmt::format("body.inertia: no real body has a principal moment larger than the sum of the two others "
                    "({:g} > {:g}); the equations are valid all the same",
                    largest, sum - largest));

  if (std::optional<Section> load = root.section("load")) {
    const std::string kind = load->one_of("kind", {load_kinds.begin(), load_kinds.end()});
    const std::string owner = fmt::format("kind \"{}\"", kind);
    resolved["load"] = {{"kind", kind}};
    if (kind == "gravity") {
      load->only({"kind", "weight", "centre"}, owner);
      const double weight = load->positive("weight", "a positive number (weight, N, along -z of space)");
      const Eigen::Vector3d centre =
          vector(load->numbers("centre", 3, "three finite numbers (body point, m)"));
      resolved["load"]["weight"] = weight;
      resolved["load"]["centre"] = list(centre);
      parsed.model = box(RigidBody<Gravity>(inertia, initial, {weight, centre}, t_end));
    } else if (kind == "attitude_potential") {
      parsed.model = box(
          RigidBody<AttitudePotential>(inertia, initial, read_potential(*load, q, resolved["load"]), t_end));
    } else if (kind != "none") {
      load->only({"kind", "moment"}, owner);
      const Eigen::Vector3d moment = vector(load->numbers("moment", 3, "three finite numbers (N m)"));
      resolved["load"]["moment"] = list(moment);
      if (kind == "space_moment")
        parsed.model = box(RigidBody<SpaceMoment>(inertia, initial, {moment}, t_end));
      else
        parsed.model = box(RigidBody<BodyMoment>(inertia, initial, {moment}, t_end));
    } else {
      load->only({"kind"}, owner);
    }
  }
  if (!parsed.model) parsed.model = box(RigidBody<Free>(inertia, initial, {}, t_end));
  parsed.resolved = std::make_shared<Json>(std::move(resolved));
  return parsed;
}

}  // namespace gnomon::rigid_body
