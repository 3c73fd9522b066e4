#pragma once
#include <nlohmann/json_fwd.hpp>

#include "models/planar_beam/data.hpp"
#include "src/scene_reader.hpp"

namespace gnomon::planar_beam {

/// Whether two elements meet at arc length x.
bool is_meeting(double x, const Data& data);

/// Whether two such places are the same.
bool is_same_meeting(double x, double y, const Data& data);

/// Reads `[supports]`; missing ends are free.
void read_supports(Section& root, Data& data, nlohmann::ordered_json& resolved);

/// Reads `[[loads]]`.
void read_loads(Section& root, Data& data, nlohmann::ordered_json& resolved);

/// Reads the lists t and value of a function given by points, the first at t = 0 and there, where
/// `from_zero`, with the value 0. `meaning` is that of the values, with their unit.
Polyline read_polyline(Section& table, const char* meaning, bool from_zero, nlohmann::ordered_json& resolved);

}  // namespace gnomon::planar_beam
