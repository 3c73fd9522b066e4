#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

#include "src/error.hpp"
#include "src/nearest.hpp"

namespace gnomon {

/// Where a value of a scene came from, for messages.
struct SceneSource {
  std::string file;                              ///< as the user wrote it
  std::map<std::string, std::string> overrides;  ///< key path -> the --set option that wrote it
  std::string folder{};                          ///< of the file; other files are named relative to it
};

/// One table of a scene file, read strictly: every key that is asked for is checked for type and range, and
/// `finish` refuses the keys that nobody asked for. All failures are UsageErrors "file:line: key: found ..,
/// expected ..".
class Section {
 public:
  Section(const toml::table& table, std::string path, const SceneSource& source);

  bool has(std::string_view key) const;
  double number(std::string_view key, std::string_view expected);
  double number_or(std::string_view key, double fallback, std::string_view expected);
  /// A whole number from `least` to `most`.
  int integer(std::string_view key, int least, int most, std::string_view expected);
  double positive(std::string_view key, std::string_view expected);
  /// Exactly `count` finite numbers.
  std::vector<double> numbers(std::string_view key, std::size_t count, std::string_view expected);
  /// Makes a key that is absent known, and gives its default.
  std::vector<double> numbers_or(std::string_view key, std::vector<double> fallback,
                                 std::string_view expected);
  /// Finite numbers, any count of them.
  std::vector<double> list(std::string_view key, std::string_view expected);
  /// Whether the key is there and true.
  bool flag(std::string_view key);
  /// Two or more positive numbers.
  std::vector<double> positives(std::string_view key, std::string_view expected);
  std::string text(std::string_view key, std::string_view expected);
  std::string text_or(std::string_view key, std::string_view fallback, std::string_view expected);
  /// A list of texts; none when the key is absent.
  std::vector<std::string> texts(std::string_view key, std::string_view expected);
  /// A list of one or more values of any kind, each as it would stand in a TOML file.
  std::vector<std::string> values(std::string_view key, std::string_view expected);
  std::string one_of(std::string_view key, const std::vector<std::string>& choices);
  /// A table inside this one; none when the key is absent.
  std::optional<Section> section(std::string_view key);
  /// The tables of an array `[[key]]`, in their order; none when the key is absent.
  std::vector<Section> sections(std::string_view key);
  /// Whether the key is there and a table.
  bool is_table(std::string_view key) const;
  /// Whether the key is there and a number.
  bool is_number(std::string_view key) const;
  /// Exactly one of two keys must be there; returns it.
  std::string exactly_one(std::string_view first, std::string_view second, std::string_view meaning);

  /// Refuses the keys that nobody asked for; suggests the nearest one that is not there.
  void finish() const;
  /// Refuses keys other than these. Called before any is read, it names a misspelt key rather than the key
  /// that is missing then. `owner` is what has only these keys, in the message.
  void only(const std::vector<std::string>& keys, std::string_view owner = "") const;
  /// Refuses keys that look like a misspelling of one of these that is not there; allows all others.
  void refuse_misspelt(const std::vector<std::string>& keys) const;

  /// Reports a value of this table that is wrong for a reason only the model knows.
  [[noreturn]] void fail(std::string_view key, std::string_view found, std::string_view expected) const;
  /// The same in words of another kind, at one entry of a list if its number is given.
  [[noreturn]] void refuse(std::string_view key, std::string_view why,
                           std::optional<std::size_t> entry = std::nullopt) const;
  /// The path of another file that the scene names: relative to the scene's folder.
  std::string beside(const std::string& name) const;
  /// The value of a key as it stands in the file, shortened for messages.
  std::string shown(std::string_view key) const;

 private:
  const toml::node* find(std::string_view key);
  const toml::node& require(std::string_view key, std::string_view expected);
  double finite(const toml::node& node, std::string_view key, std::string_view expected) const;
  std::string where(std::string_view key, std::optional<std::size_t> entry = std::nullopt) const;
  std::string full(std::string_view key) const;
  std::string nearest_absent(std::string_view name, const std::vector<std::string>& keys) const;

  const toml::table* table_;
  std::string path_;
  const SceneSource* source_;
  std::vector<std::string> known_;
};

}  // namespace gnomon
