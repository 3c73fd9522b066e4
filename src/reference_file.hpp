#pragma once
#include <optional>
#include <string>
#include <vector>

#include "src/reference_states.hpp"
#include "src/scene.hpp"

namespace gnomon {

/// Raised whenever the way references are computed changes.
inline constexpr int reference_format = 7;

/// Where the reference of a scene is kept beside it: "folder/name.reference.txt" of "folder/name.toml". Empty
/// for a scene that is not as it stands in its file, for other times than its end, and for a closed form.
std::string reference_file(const Scene& scene, const std::vector<double>& times);

/// A reference at one time as a small text that people can read: scene and hash of its physics, kind,
/// methods with their tolerances, bounds, the state with 17 digits a number, and a checksum of all of it.
std::string reference_text(const Scene& scene, const ReferenceStates& reference);

/// Back again; nothing if the text is damaged, or of another scene, another version or another end.
std::optional<ReferenceStates> read_reference_text(const std::string& text, const Scene& scene);

}  // namespace gnomon
