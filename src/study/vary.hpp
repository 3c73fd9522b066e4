#pragma once
#include <optional>
#include <string>
#include <vector>

#include "src/scene.hpp"

namespace gnomon {

/// One key of a scene, or several keys in step, take each of several values.
struct Variation {
  /// Where the values stand on an axis.
  struct Axis {
    std::string label;
    std::vector<double> values;
  };

  std::string key;                  ///< as in --set, e.g. "beam.EA"; several: "beam.EA,beam.GA"
  std::vector<std::string> values;  ///< as they were written, TOML
  /// The values as numbers; none unless all of them are.
  std::optional<std::vector<double>> numbers() const;
  /// The numbers, or of lists that differ in one place the numbers there; none for other values.
  std::optional<Axis> axis() const;
  /// A value that is there twice, in whatever spelling; empty if there is none.
  std::string repeated() const;
  /// The key and its k-th value, as SceneChanges::vary takes them.
  std::string assignment(std::size_t k) const { return key + "=" + values[k]; }
};

/// Reads "key=v1,v2,.." or "key1,key2,..=v1,v2,.."; commas inside brackets and quotes belong to a value.
/// Throws UsageError, with `option` in the message.
Variation read_variation(const std::string& option, const std::string& text);

}  // namespace gnomon
