#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "models/planar_beam/data.hpp"
#include "src/scene_reader.hpp"

namespace gnomon::planar_beam {

/// Reads u and v at the end of the first run in the file that `initial.state` names, relative to the scene's
/// own folder. The file is one of `gnomon run --json`; its beam must have the same mesh and rest shape as
/// `beam`, the resolved keys of [beam]. Throws UsageError.
void read_saved_state(Section& initial, const nlohmann::ordered_json& beam, Data& data);

/// Of the saved u and v, by which references are told apart.
std::string hash_of(const Data& data);

}  // namespace gnomon::planar_beam
