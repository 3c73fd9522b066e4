#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/reference_states.hpp"
#include "src/scene.hpp"

namespace gnomon {

/// Obtains references and keeps the certified ones as small files in a folder, by the hash of the scene's
/// physics and the times. A file that does not fit, or is damaged, is computed anew.
class ReferenceStore {
 public:
  /// An empty folder name keeps nothing. With `beside_scenes` a reference that stands beside its scene (see
  /// reference_file) is taken from there if it fits.
  explicit ReferenceStore(std::string folder, bool beside_scenes = false)
      : folder_(std::move(folder)), beside_scenes_(beside_scenes) {}
  /// Makes a reference where the model's own methods give none.
  using Fallback = std::function<ReferenceStates()>;
  /// States at ascending times. Kept in memory too.
  const ReferenceStates& get(const Scene& scene, const std::vector<double>& times,
                             const Fallback& fallback = {});
  /// The file in which a certified reference is kept, whether it is there or not; empty for a closed form or
  /// where nothing is kept.
  std::string path(const Scene& scene, const std::vector<double>& times) const;
  /// What stands beside the scene, if it fits.
  std::optional<ReferenceStates> beside(const Scene& scene, const std::vector<double>& times) const;

 private:
  std::string folder_;
  bool beside_scenes_;
  std::map<std::string, ReferenceStates> memory_;
};

}  // namespace gnomon
