#include "src/output/files.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "tests/catch.hpp"
#include "tests/output/contains.hpp"
#include "tests/output/temporary_folder.hpp"

using namespace gnomon::output;
using namespace gnomon::test;
using gnomon::test::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

/// The message of the exception that writing throws; empty if it throws none.
std::string failure(const fs::path& path, const std::string& content) {
  try {
    write_file_atomically(path, content);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

/// Files larger than `bytes` cannot be written while this lives.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limited = {bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limited);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  void (*handler_)(int);
  rlimit before_{};
};

}  // namespace

TEST_CASE("output: a file is read back as it was written") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.txt";
  std::string content = "line\r\n";
  content.append(200000, '\0');
  content += "end";
  write_file_atomically(path, content);
  CHECK(read_file(path) == content);
  write_file_atomically(path, "");
  CHECK(read_file(path).empty());
  CHECK(folder.entries() == 1);
}

TEST_CASE("output: parent folders are made and permissions are the usual ones") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a" / "b" / "c.txt";
  write_file_atomically(path, "x");
  CHECK(read_file(path) == "x");
  const mode_t mask = ::umask(0);
  ::umask(mask);
  struct stat status {};
  REQUIRE(::stat(path.c_str(), &status) == 0);
  CHECK((status.st_mode & 0777U) == (0666U & ~mask));
}

TEST_CASE("output: a write that fails keeps the old file and leaves nothing behind") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.txt";
  write_file_atomically(path, "old");
  std::string message;
  {
    const FileSizeLimit limit(1000);
    message = failure(path, std::string(5000, 'x'));
  }
  CHECK(contains(message, path.string()));
  CHECK(contains(message, "File too large"));
  CHECK(read_file(path) == "old");
  CHECK(folder.entries() == 1);
  CHECK(failure(path, std::string(5000, 'x')).empty());  // without the limit the same write succeeds
}

TEST_CASE("output: writing below a file or onto a folder is refused with the reason") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "file";
  write_file_atomically(file, "x");
  const std::string below = failure(file / "a.txt", "y");
  CHECK(contains(below, (file / "a.txt").string()));
  CHECK(contains(below, "Not a directory"));
  const fs::path taken = folder.path() / "taken";
  fs::create_directory(taken);
  CHECK(contains(failure(taken, "y"), "Is a directory"));
  CHECK(folder.entries() == 2);
  CHECK(read_file(file) == "x");
}

TEST_CASE("output: writing into a folder without permission is refused with the reason") {
  const TemporaryFolder folder;
  const fs::path closed = folder.path() / "closed";
  fs::create_directory(closed);
  fs::permissions(folder.path(), fs::perms::others_read | fs::perms::others_exec, fs::perm_options::add);
  fs::permissions(closed, fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                              fs::perms::others_exec);
  // Permissions do not bind root, so the test gives up its rights for a moment.
  const bool root = ::geteuid() == 0;
  const bool bound = !root || ::seteuid(65534) == 0;
  const std::string message = bound ? failure(closed / "a.txt", "x") : "";
  if (root && bound) REQUIRE(::seteuid(0) == 0);
  if (bound) {
    CHECK(contains(message, (closed / "a.txt").string()));
    CHECK(contains(message, "Permission denied"));
    CHECK(fs::is_empty(closed));
  }
  fs::permissions(closed, fs::perms::owner_all);
  CHECK(failure(closed / "a.txt", "x").empty());
}

TEST_CASE("output: a symbolic link is followed") {
  const TemporaryFolder folder;
  const fs::path target = folder.path() / "target.txt";
  const fs::path link = folder.path() / "link.txt";
  write_file_atomically(target, "old");
  fs::create_symlink("target.txt", link);
  write_file_atomically(link, "new");
  CHECK(fs::is_symlink(link));
  CHECK(read_file(target) == "new");
  CHECK(folder.entries() == 2);
}

TEST_CASE("output: a pipe is written, not replaced") {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  REQUIRE(reader >= 0);
  write_file_atomically(pipe, "through");
  char buffer[32] = {};
  CHECK(::read(reader, buffer, sizeof buffer) == 7);
  ::close(reader);
  CHECK(std::string(buffer) == "through");
  CHECK(fs::is_fifo(pipe));
  CHECK(folder.entries() == 1);
}

TEST_CASE("output: reading what is not there names the file and the reason") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "none.txt";
  std::string message;
  try {
    read_file(path);
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  CHECK(contains(message, path.string()));
  CHECK(contains(message, "No such file or directory"));
  CHECK_THROWS_AS(read_file(folder.path()), std::runtime_error);
}
