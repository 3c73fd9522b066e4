#pragma once
#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

/// The measurements of a study as lines of JSON in one file, DIR/runs.jsonl, each with its "key". A line is
/// appended by one write as soon as its measurement ends, so that a program killed at any moment loses only
/// what was underway. A line cut off at the end of the file, or damaged, counts as not there.
class RunStore {
 public:
  using Json = nlohmann::ordered_json;
  enum class Access { read, append };

  /// Reads what is there. With `append` the file is made if need be, belongs to this store until the end (a
  /// second one throws UsageError), and a cut-off line is removed. Throws std::runtime_error with the
  /// system's reason, and UsageError for reading where there is no file.
  RunStore(const std::string& folder, Access access);
  RunStore(const RunStore&) = delete;
  RunStore& operator=(const RunStore&) = delete;
  ~RunStore();

  const std::string& path() const { return path_; }
  /// What was found damaged, for the user; empty if nothing was.
  const std::vector<std::string>& notes() const { return notes_; }
  std::size_t size() const { return lines_.size(); }

  bool holds(const std::string& key) const { return lines_.contains(key); }
  /// The last record of that key.
  std::optional<Json> find(const std::string& key) const;
  /// The last record with "kind" equal to `kind`.
  std::optional<Json> last(const std::string& kind) const;
  /// Appends a record, which has its key in "key", as a whole line or not at all. Throws std::runtime_error.
  void append(const Json& record);
  /// Puts all records aside as runs.previous.jsonl, which is overwritten, and starts anew.
  void put_aside();
  /// In a child process: gives up the file without a word to the parent's.
  void abandon();

 private:
  void open_for_append();
  void read();

  std::string path_;
  int file_ = -1;
  std::map<std::string, std::string> lines_;
  std::map<std::string, std::string> kinds_;  ///< key of the last record of each kind
  std::vector<std::string> notes_;
};

}  // namespace gnomon
