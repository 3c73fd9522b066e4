#include "src/git_commit.hpp"

#include <filesystem>
#include <fstream>
#include <string_view>

namespace gnomon {
namespace {

namespace fs = std::filesystem;

std::string first_line(const fs::path& path) {
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
  return line;
}

/// What follows a word at the beginning of a line; empty if it does not begin so.
std::string after(const std::string& line, std::string_view word) {
  return line.starts_with(word) ? line.substr(word.size()) : "";
}

bool is_hash(std::string_view text) {
  return text.size() >= 40 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// The hash of a reference in the file of those that have none of their own.
std::string packed(const fs::path& path, const std::string& reference) {
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    const std::size_t blank = line.find(' ');
    if (blank != std::string::npos && line.compare(blank + 1, std::string::npos, reference) == 0)
      return line.substr(0, blank);
  }
  return "";
}

}  // namespace

std::string git_commit(const std::string& checkout) {
  fs::path folder = fs::path(checkout) / ".git";
  // In a linked worktree it is a file that names the folder.
  std::error_code code;
  if (fs::is_regular_file(folder, code)) folder = fs::path(checkout) / after(first_line(folder), "gitdir: ");
  // Which has its own HEAD; the references are in the folder that all worktrees share.
  const std::string shared = first_line(folder / "commondir");
  const fs::path common = shared.empty() ? folder : folder / shared;
  std::string value = first_line(folder / "HEAD");
  for (int depth = 0; depth < 5; ++depth) {
    const std::string reference = after(value, "ref: ");
    if (reference.empty()) break;
    value = first_line(folder / reference);
    if (value.empty()) value = first_line(common / reference);
    if (value.empty()) value = packed(common / "packed-refs", reference);
  }
  return is_hash(value) ? value.substr(0, 12) : "unknown";
}

}  // namespace gnomon
