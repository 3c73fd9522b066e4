#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "models/planar_beam/read_parts.hpp"

namespace gnomon::planar_beam {
namespace {

using Json = nlohmann::ordered_json;

void read_profile(Section& table, Load& load, Json& resolved) {
  std::string kind = "constant";
  resolved["profile"] = {{"kind", kind}};
  std::optional<Section> profile = table.section("profile");
  if (!profile) return;
  kind = profile->one_of("kind", {"constant", "step", "ramp", "half-sine", "table"});
  resolved["profile"]["kind"] = kind;
  const std::string owner = fmt::format("kind \"{}\"", kind);
  if (kind == "constant") {
    profile->only({"kind"}, owner);
    return;
  }
  if (kind == "table") {
    profile->only({"kind", "t", "value"}, owner);
    load.profile = Profile::table;
    load.table = read_polyline(*profile, "factors of the load", false, resolved["profile"]);
    load.duration = load.table.t.back();
    return;
  }
  const char* key = kind == "step" ? "until" : "over";
  profile->only({"kind", key}, owner);
  load.profile = kind == "step" ? Profile::step : kind == "ramp" ? Profile::ramp : Profile::half_sine;
  load.duration = profile->positive(key, "a positive number (s)");
  resolved["profile"][key] = load.duration;
}

/// Where a load acts; an arc length where it acts inside.
void read_place(Section& table, const Data& data, Load& load, Json& resolved) {
  const std::vector<std::string> places{"start", "end", "distributed"};
  if (table.is_number("at")) {
    const std::string meeting =
        fmt::format("a multiple of {:.6g} m, where two elements meet, inside the beam of {:.6g} m",
                    data.length / data.elements, data.length);
    load.at = Place::inside;
    load.x = table.number("at", meeting);
    if (!is_meeting(load.x, data)) table.fail("at", table.shown("at"), meeting);
    resolved["at"] = load.x;
    return;
  }
  const std::string at = table.one_of("at", places);
  load.at = at == "start" ? Place::start : at == "end" ? Place::end : Place::distributed;
  resolved["at"] = at;
}

}  // namespace

bool is_meeting(double x, const Data& data) {
  const double element = data.length / data.elements;
  return x > 0.5 * element && x < data.length - 0.5 * element &&
         std::abs(x - std::round(x / element) * element) <= 1e-9 * element;
}

bool is_same_meeting(double x, double y, const Data& data) {
  return std::abs(x - y) <= 0.5 * data.length / data.elements;
}

void read_loads(Section& root, Data& data, Json& resolved) {
  resolved["loads"] = Json::array();
  for (Section& table : root.sections("loads")) {
    table.only({"at", "force", "moment", "follower", "profile"});
    Load load;
    Json one;
    read_place(table, data, load, one);
    const std::vector<double> force =
        table.numbers_or("force", {0.0, 0.0}, "two finite numbers (x, z, N or N/m)");
    load.force = {force[0], force[1]};
    load.moment = table.number_or("moment", 0.0, "a finite number (about +y, N m or N m/m)");
    const auto at_load = [&](const Hinge& hinge) { return is_same_meeting(hinge.at, load.x, data); };
    if (load.at == Place::inside && load.moment != 0.0 &&
        std::any_of(data.hinges.begin(), data.hinges.end(), at_load))
      table.fail("moment", fmt::format("{} at a hinge", table.shown("moment")),
                 "a moment elsewhere, as a hinge bears none");
    load.follower = table.flag("follower");
    if (load.follower && load.at != Place::start && load.at != Place::end)
      table.fail("follower", "true for a load that is not at an end", "false, or at = \"start\" or \"end\"");
    one["force"] = load.force;
    one["moment"] = load.moment;
    one["follower"] = load.follower;
    read_profile(table, load, one);
    data.loads.push_back(load);
    resolved["loads"].push_back(one);
  }
}

}  // namespace gnomon::planar_beam
