#include "src/git_commit.hpp"

#include <filesystem>
#include <fstream>

#include "tests/catch.hpp"
#include "tests/output/temporary_folder.hpp"

using gnomon::git_commit;

namespace {

void write_git_file(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << text << '\n';
}

const std::string one_commit(40, 'a'), other_commit = "0123456789abcdef0123456789abcdef01234567";

}  // namespace

TEST_CASE("commit: loose and packed references", "[environment]") {
  const gnomon::test::TemporaryFolder folder;
  const std::filesystem::path git = folder.path() / ".git";
  const auto commit = [&] { return git_commit(folder.path().string()); };
  CHECK(commit() == "unknown");
  write_git_file(git / "HEAD", "ref: refs/heads/main");
  CHECK(commit() == "unknown");
  write_git_file(git / "packed-refs", "# pack-refs with: peeled fully-peeled sorted\n" + one_commit +
                                          " refs/heads/mainly\n" + other_commit + " refs/heads/main\n^" +
                                          one_commit + "\n" + one_commit + " refs/tags/refs/heads/main");
  CHECK(commit() == "0123456789ab");
  // A loose one is newer.
  write_git_file(git / "refs/heads/main", one_commit);
  CHECK(commit() == "aaaaaaaaaaaa");
  write_git_file(git / "HEAD", other_commit);
  CHECK(commit() == "0123456789ab");
  write_git_file(git / "HEAD", "what is this");
  CHECK(commit() == "unknown");
}

TEST_CASE("commit: linked worktrees", "[environment]") {
  const gnomon::test::TemporaryFolder folder;
  const std::filesystem::path git = folder.path() / "whole" / ".git", own = git / "worktrees" / "other";
  write_git_file(git / "HEAD", one_commit);
  write_git_file(git / "packed-refs", other_commit + " refs/heads/other");
  write_git_file(own / "HEAD", "ref: refs/heads/other");
  write_git_file(own / "commondir", "../..");
  const auto commit = [&] { return git_commit((folder.path() / "linked").string()); };
  for (const std::string& place : {own.string(), std::string("../whole/.git/worktrees/other")}) {
    write_git_file(folder.path() / "linked" / ".git", "gitdir: " + place);
    CHECK(commit() == "0123456789ab");
  }
  write_git_file(git / "refs/heads/other", one_commit);
  CHECK(commit() == "aaaaaaaaaaaa");
}
