#pragma once
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "src/any_model.hpp"
#include "src/catalogue.hpp"

namespace gnomon {

/// A scene with every key resolved and its model made.
struct Scene {
  std::string name;
  std::string model_name;
  std::string description;
  double t_end = 0.0;  ///< s
  std::shared_ptr<const AnyModel> model;
  nlohmann::ordered_json resolved;  ///< name, model, t_end and the model's own keys
  std::vector<std::string> warnings;
  std::string file{};  ///< that it is as it stands there; empty where something was changed
  /// Hash of what decides the motion: everything resolved but the name and the description.
  std::string physics_hash() const;
  /// The same model up to another time.
  Scene with_end(double time) const;
};

/// What the command line changes of a scene.
struct SceneChanges {
  std::optional<double> t_end;
  std::vector<std::string> set;  ///< "key.path=value"
  /// One more of them, by which the scene is a variant: its name becomes "name[key.path=value]".
  std::optional<std::string> vary{};
};

/// A shipped scene by its name, or a file that ends in .toml. Throws UsageError.
Scene load_scene(const Catalogue& catalogue, const std::string& name_or_path,
                 const SceneChanges& changes = {});

struct ShippedScene {
  std::string name;
  std::string path;
};
/// All shipped scenes by name.
std::vector<ShippedScene> shipped_scenes(const Catalogue& catalogue);

/// 64-bit FNV-1a as 16 hexadecimal digits.
std::string hash_text(std::string_view text);

}  // namespace gnomon
