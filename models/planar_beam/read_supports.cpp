#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "models/planar_beam/read_parts.hpp"

namespace gnomon::planar_beam {
namespace {

using Json = nlohmann::ordered_json;
using Table = Section;
using Keys = std::vector<std::string>;

/// A prescribed motion under `key`; `of` is what moves, with its unit, as (about +y, rad).
Motion read_motion(Table& end, const char* key, const char* of, const char* unit, Json& resolved) {
  std::optional<Table> table = end.section(key);
  if (!table)
    end.fail(key, "nothing", fmt::format("a table {{ kind = \"ramp\", to = .., over = .. }} ({}, s)", unit));
  const std::string kind = table->one_of("kind", {"ramp", "half-sine", "spin-up", "table"});
  const std::string owner = fmt::format("kind \"{}\"", kind);
  Motion motion;
  Json& json = resolved[key] = {{"kind", kind}};
  if (kind == "table") {
    table->only({"kind", "t", "value"}, owner);
    motion.kind = MotionKind::table;
    motion.table = read_polyline(*table, of, true, json);
    motion.over = motion.table.t.back();
    return motion;
  }
  const bool spins = kind == "spin-up";
  const char* amount = spins ? "rate" : "to";
  table->only({"kind", amount, "over"}, owner);
  motion.kind = spins ? MotionKind::spin_up : kind == "ramp" ? MotionKind::ramp : MotionKind::half_sine;
  motion.to = table->number(amount, fmt::format("a finite number ({}{})", of, spins ? "/s" : ""));
  motion.over = table->positive("over", "a positive number (s)");
  json[amount] = motion.to;
  json["over"] = motion.over;
  return motion;
}

/// The rotation of an end whose place slides or moves: free, clamped or, where `may_move`, prescribed.
void read_rotation(Table& end, Support& support, bool may_move, Json& resolved) {
  if (!end.has("rotation")) {
    resolved["rotation"] = "free";
    return;
  }
  if (may_move && end.is_table("rotation")) {
    support.motion = read_motion(end, "rotation", "about +y, rad", "rad", resolved);
    return;
  }
  const std::string text =
      may_move ? "one of free, clamped, or a table { kind = \"ramp\", to = .., over = .. } (rad, s)"
               : "one of free, clamped";
  const std::string rotation = end.text("rotation", text);
  if (rotation != "free" && rotation != "clamped") end.fail("rotation", end.shown("rotation"), text);
  support.rotation = rotation == "clamped";
  resolved["rotation"] = rotation;
}

void read_spring(Table& end, Support& support, Json& resolved) {
  if (!end.has("spring")) return;
  if (support.holds(2))
    end.fail("spring", fmt::format("{} at an end whose rotation is held", end.shown("spring")),
             "a spring at an end that turns freely");
  support.spring = end.positive("spring", "a positive number (torsion spring, N m/rad)");
  resolved["spring"] = support.spring;
}

Support read_table(Table& end, Json& resolved) {
  const std::string kind = end.one_of("kind", {"free", "pinned", "clamped", "rotated", "sliding", "moved"});
  const std::string owner = fmt::format("kind \"{}\"", kind);
  resolved = {{"kind", kind}};
  Support support;
  support.place = kind != "free";
  support.rotation = kind == "clamped" || kind == "rotated";
  if (kind == "clamped") {
    end.only({"kind"}, owner);
  } else if (kind == "rotated") {
    end.only({"kind", "rotation"}, owner);
    support.motion = read_motion(end, "rotation", "about +y, rad", "rad", resolved);
  } else if (kind == "sliding") {
    end.only({"kind", "along", "rotation", "spring"}, owner);
    const std::string along = end.one_of("along", {"x", "z"});
    support.slide = along == "x" ? 0 : 1;
    resolved["along"] = along;
    read_rotation(end, support, false, resolved);
  } else if (kind == "moved") {
    end.only({"kind", "x", "z", "rotation", "spring"}, owner);
    if (!end.has("x") && !end.has("z"))
      end.fail("x", "nothing", "x or z: a table { kind = \"ramp\", to = .., over = .. } (m, s)");
    if (end.has("x")) support.displacement[0] = read_motion(end, "x", "along x, m", "m", resolved);
    if (end.has("z")) support.displacement[1] = read_motion(end, "z", "along z, m", "m", resolved);
    read_rotation(end, support, true, resolved);
  } else {
    end.only({"kind", "spring"}, owner);
  }
  read_spring(end, support, resolved);
  if (resolved.size() == 1) resolved = kind;
  return support;
}

Support read_support(Table& supports, const char* key, Json& resolved) {
  resolved = "free";
  if (!supports.has(key)) return {};
  if (supports.is_table(key)) {
    Table end = *supports.section(key);
    return read_table(end, resolved);
  }
  const Keys kinds{"free", "pinned", "clamped"};
  const std::string expected = choices_text(kinds) + ", or a table { kind = .., .. }";
  const std::string kind = supports.text(key, expected);
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
    supports.fail(key, supports.shown(key), expected);
  resolved = kind;
  Support support;
  support.place = kind != "free";
  support.rotation = kind == "clamped";
  return support;
}

}  // namespace

void read_supports(Table& root, Data& data, Json& resolved) {
  Json& both = resolved["supports"] = {{"start", "free"}, {"end", "free"}};
  if (std::optional<Table> supports = root.section("supports")) {
    supports->only({"start", "end"});
    data.supports[0] = read_support(*supports, "start", both["start"]);
    data.supports[1] = read_support(*supports, "end", both["end"]);
  }
}

Polyline read_polyline(Table& table, const char* meaning, bool from_zero, Json& resolved) {
  Polyline line;
  const char* times = "at least two ascending numbers, the first 0 (s)";
  line.t = table.list("t", times);
  bool ascend = line.t.size() >= 2 && line.t[0] == 0.0;
  for (std::size_t k = 1; k < line.t.size(); ++k) ascend = ascend && line.t[k - 1] < line.t[k];
  if (!ascend) table.fail("t", table.shown("t"), times);
  const std::string values =
      fmt::format("as many numbers as t has{} ({})", from_zero ? ", the first 0" : "", meaning);
  line.value = table.list("value", values);
  if (line.value.size() != line.t.size() || (from_zero && line.value[0] != 0.0))
    table.fail("value", table.shown("value"), values);
  resolved["t"] = line.t;
  resolved["value"] = line.value;
  return line;
}

}  // namespace gnomon::planar_beam
