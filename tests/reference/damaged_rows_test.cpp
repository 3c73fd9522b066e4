// A reference file whose states or bounds have lost a number is damaged like any other: `restore` would read
// beyond the end of a state that is too short.

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "src/reference.hpp"
#include "tests/catch.hpp"
#include "tests/output/temporary_folder.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;

TEST_CASE("reference: a file that has lost a number is computed anew", "[reference]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "space-moment");
  const TemporaryFolder folder;
  const ReferenceStates direct = ReferenceStore(folder.path().string()).get(scene, {5.0});
  const auto file = std::filesystem::directory_iterator(folder.path())->path();
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  for (const char* key : {"states", "bounds"}) {
    auto json = nlohmann::json::parse(text.str());
    json[key][0].erase(1);
    std::ofstream(file) << json.dump();
    INFO(key);
    const ReferenceStates read = ReferenceStore(folder.path().string()).get(scene, {5.0});
    CHECK(read.states == direct.states);
    CHECK(read.bounds == direct.bounds);
  }
}
