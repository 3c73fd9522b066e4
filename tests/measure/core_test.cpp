#include "src/measure/core.hpp"

#include <algorithm>
#include <thread>

#include "tests/catch.hpp"

using namespace gnomon;

TEST_CASE("measure: a timed thread stays on one core, and may move again afterwards") {
  const std::vector<int> before = allowed_cores();
  REQUIRE_FALSE(before.empty());
  CHECK(std::is_sorted(before.begin(), before.end()));
  const std::optional<int> core = timing_core();
  REQUIRE(core);
  CHECK(std::count(before.begin(), before.end(), *core) == 1);
  {
    const OnOneCore here;
    REQUIRE(here.core());
    CHECK(*here.core() == *core);
    CHECK(allowed_cores() == std::vector<int>{*core});
    // What it starts stays there, too; what runs beside it does not.
    std::vector<int> inherited;
    std::thread([&] { inherited = allowed_cores(); }).join();
    CHECK(inherited == std::vector<int>{*core});
  }
  CHECK(allowed_cores() == before);
  std::vector<int> beside;
  std::thread other([&] {
    const OnOneCore there;
    beside = allowed_cores();
  });
  other.join();
  CHECK(beside == std::vector<int>{*core});
  CHECK(allowed_cores() == before);
}
