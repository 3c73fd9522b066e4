// What the README shows must work when it is pasted.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/output/temporary_folder.hpp"

namespace {

std::vector<std::string> commands_of_readme() {
  std::ifstream in(GNOMON_SOURCE_DIR "/README.md");
  std::vector<std::string> commands;
  bool shell = false;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("```"))
      shell = line == "```sh";
    else if (shell && line.starts_with("./gnomon "))
      commands.push_back(line.substr(9));
  }
  return commands;
}

}  // namespace

TEST_CASE("cli: the README's examples work as printed", "[cli][long]") {
  namespace fs = std::filesystem;
  const std::vector<std::string> commands = commands_of_readme();
  REQUIRE(commands.size() >= 6);
  const gnomon::test::TemporaryFolder temporary;
  const fs::path& folder = temporary.path();
  // One comparison is timed, for the others that takes long and shows nothing more.
  bool timed = false;
  for (const std::string& command : commands) {
    const bool times = command.starts_with("compare ") || command.starts_with("scorecard ");
    INFO(command);
    const std::string line = "cd '" + folder.string() + "' && '" GNOMON_PROGRAM "' " + command +
                             (times && timed ? " --no-timing" : "") + " >out.txt 2>err.txt";
    timed = timed || times;
    CHECK(std::system(line.c_str()) == 0);
    CHECK(fs::file_size(folder / "out.txt") > 0);
  }
  CHECK(fs::exists(folder / "run.json"));
  CHECK(fs::exists(folder / "compare" / "compare-asymmetric-heavy-top.svg"));
  CHECK(fs::exists(folder / "drift" / "drift-asymmetric-free-top.png"));
}
