#include "src/study/run_store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "src/error.hpp"
#include "src/output/files.hpp"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& what, const std::string& path) {
  throw std::runtime_error(fmt::format("cannot {} '{}': {}", what, path, std::strerror(errno)));
}

}  // namespace

RunStore::RunStore(const std::string& folder, Access access) : path_(folder + "/runs.jsonl") {
  if (access == Access::append) {
    fs::create_directories(folder);
    open_for_append();
  } else if (!fs::exists(path_)) {
    throw UsageError(fmt::format("{}: found no runs.jsonl, expected a folder that `gnomon bench` has written",
                                 folder.empty() ? "." : folder));
  }
  try {
    read();
  } catch (...) {
    abandon();
    throw;
  }
}

RunStore::~RunStore() { abandon(); }

void RunStore::abandon() {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

void RunStore::open_for_append() {
  file_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0644);
  if (file_ < 0) fail("write", path_);
  if (::flock(file_, LOCK_EX | LOCK_NB) == 0) return;
  const bool taken = errno == EWOULDBLOCK;
  abandon();
  if (!taken) fail("lock", path_);
  throw UsageError(fmt::format("{}: found another gnomon that writes to it, expected another --out", path_));
}

void RunStore::read() {
  const std::string content = output::read_file(path_);
  std::size_t damaged = 0, begin = 0;
  for (std::size_t end; (end = content.find('\n', begin)) != std::string::npos; begin = end + 1) {
    std::string line = content.substr(begin, end - begin);
    const Json record = Json::parse(line, nullptr, false);
    const auto text = [&](const char* name) -> std::string {
      return record.is_object() && record.contains(name) && record[name].is_string() ? record[name]
                                                                                     : Json("");
    };
    const std::string key = text("key");
    if (key.empty()) {
      ++damaged;
      continue;
    }
    kinds_[text("kind")] = key;
    lines_[key] = std::move(line);
  }
  if (damaged > 0) notes_.push_back(fmt::format("{}: {} damaged lines are ignored", path_, damaged));
  if (begin == content.size()) return;
  notes_.push_back(fmt::format("{}: the last line is cut off and ignored", path_));
  if (file_ >= 0 && ::ftruncate(file_, static_cast<off_t>(begin)) != 0) fail("shorten", path_);
}

std::optional<RunStore::Json> RunStore::find(const std::string& key) const {
  const auto line = lines_.find(key);
  if (line == lines_.end()) return std::nullopt;
  return Json::parse(line->second);
}

std::optional<RunStore::Json> RunStore::last(const std::string& kind) const {
  const auto key = kinds_.find(kind);
  return key == kinds_.end() ? std::nullopt : find(key->second);
}

void RunStore::append(const Json& record) {
  std::string line = record.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
  struct stat before {};
  if (::fstat(file_, &before) != 0) fail("write", path_);
  ssize_t written = 0;
  do written = ::write(file_, line.data(), line.size());
  while (written < 0 && errno == EINTR);
  if (written != static_cast<ssize_t>(line.size())) {
    if (written >= 0) errno = ENOSPC;
    const int reason = errno;
    // Half a line would spoil the next one.
    if (written > 0 && ::ftruncate(file_, before.st_size) != 0) abandon();
    errno = reason;
    fail("write", path_);
  }
  line.pop_back();
  const std::string key = record.at("key");
  kinds_[record.value("kind", "")] = key;
  lines_[key] = std::move(line);
}

void RunStore::put_aside() {
  const std::string previous =
      path_.substr(0, path_.size() - std::strlen("runs.jsonl")) + "runs.previous.jsonl";
  if (::rename(path_.c_str(), previous.c_str()) != 0) fail("rename", path_);
  abandon();
  open_for_append();
  lines_.clear();
  kinds_.clear();
}

}  // namespace gnomon
