#include "src/reference.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "src/output/files.hpp"
#include "src/reference_file.hpp"

namespace gnomon {
namespace {

std::string key_text(const Scene& scene, const std::vector<double>& times) {
  std::string text = fmt::format("gnomon reference {} {}", reference_format, scene.physics_hash());
  for (double t : times) text += fmt::format(" {:.17g}", t);
  return text;
}

/// Of the numbers, which must not be damaged.
std::string checksum(const ReferenceStates& reference) {
  const nlohmann::ordered_json json{reference.kind, reference.times, reference.states, reference.bounds};
  return hash_text(json.dump());
}

nlohmann::ordered_json to_json(const Scene& scene, const ReferenceStates& reference, const std::string& key) {
  return {{"key", key},
          {"scene", scene.resolved},
          {"kind", reference.kind},
          {"methods", reference.methods},
          {"times", reference.times},
          {"states", reference.states},
          {"bounds", reference.bounds},
          {"message", reference.message},
          {"checksum", checksum(reference)}};
}

bool read(const std::string& path, const std::string& key, ReferenceStates& reference) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return false;
  try {
    const auto json = nlohmann::json::parse(output::read_file(path));
    if (json.at("key") != key) return false;
    json.at("kind").get_to(reference.kind);
    json.at("methods").get_to(reference.methods);
    json.at("times").get_to(reference.times);
    json.at("states").get_to(reference.states);
    json.at("bounds").get_to(reference.bounds);
    json.at("message").get_to(reference.message);
    return json.at("checksum") == checksum(reference);
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

std::optional<ReferenceStates> ReferenceStore::beside(const Scene& scene,
                                                      const std::vector<double>& times) const {
  const std::string file = beside_scenes_ ? reference_file(scene, times) : "";
  std::error_code error;
  if (file.empty() || !std::filesystem::is_regular_file(file, error)) return std::nullopt;
  try {
    return read_reference_text(output::read_file(file), scene);
  } catch (const std::runtime_error&) {
    return std::nullopt;  // it cannot be read
  }
}

std::string ReferenceStore::path(const Scene& scene, const std::vector<double>& times) const {
  if (scene.model->has_exact() || folder_.empty()) return "";
  return fmt::format("{}/{}.json", folder_, hash_text(key_text(scene, times)));
}

const ReferenceStates& ReferenceStore::get(const Scene& scene, const std::vector<double>& times,
                                           const Fallback& fallback) {
  const std::string key = key_text(scene, times);
  if (const auto known = memory_.find(key); known != memory_.end()) return known->second;
  // What a time limit or an interruption ended may be had another time.
  bool settled = true;
  const auto make = [&] {
    ReferenceStates own = scene.model->reference(times);
    if (!own.kind.empty() || !fallback) return own;
    ReferenceStates other = fallback();
    settled = !other.kind.empty();
    if (!settled) other.message = fmt::format("{}; {}", own.message, other.message);
    return other;
  };
  ReferenceStates reference;
  const std::string file = path(scene, times);
  if (auto kept = beside(scene, times)) {
    reference = std::move(*kept);
  } else if (file.empty()) {
    reference = make();
  } else {
    if (!read(file, key, reference)) {
      reference = make();
      try {
        if (settled) output::write_file_atomically(file, to_json(scene, reference, key).dump(1) + "\n");
      } catch (const std::runtime_error&) {
        // A cache that cannot be written costs time, not correctness.
      }
    }
  }
  return memory_.emplace(key, std::move(reference)).first->second;
}

}  // namespace gnomon
