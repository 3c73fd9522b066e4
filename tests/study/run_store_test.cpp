// The store of a study: lines that are whole or not there.
#include "src/study/run_store.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "src/error.hpp"
#include "tests/catch.hpp"
#include "tests/output/temporary_folder.hpp"

using namespace gnomon;

namespace {

using StoreJson = RunStore::Json;
using Access = RunStore::Access;

StoreJson store_record(int number) {
  return {{"key", "k" + std::to_string(number)}, {"kind", "number"}, {"result", number}};
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void append_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary | std::ios::app) << text;
}

}  // namespace

TEST_CASE("store: what is appended is there for the next one", "[store]") {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "new" / "folder").string();
  {
    RunStore store(path, Access::append);
    CHECK(store.size() == 0);
    for (int k = 0; k < 3; ++k) store.append(store_record(k));
    CHECK(store.find("k1").value() == store_record(1));
  }
  const RunStore store(path, Access::read);
  CHECK(store.size() == 3);
  CHECK(store.notes().empty());
  CHECK(store.find("k2").value() == store_record(2));
  CHECK(store.last("number").value() == store_record(2));
  CHECK_FALSE(store.find("k3"));
  CHECK_FALSE(store.last("session"));
  CHECK(text_of(store.path()) ==
        store_record(0).dump() + "\n" + store_record(1).dump() + "\n" + store_record(2).dump() + "\n");
}

TEST_CASE("store: a line that is cut off or damaged is ignored, and said", "[store]") {
  const test::TemporaryFolder folder;
  const std::string path = folder.path().string();
  { RunStore(path, Access::append).append(store_record(0)); }
  const std::string whole = text_of(folder.path() / "runs.jsonl");
  // Every place at which the last line can be cut off.
  const std::string line = store_record(1).dump() + "\n";
  for (std::size_t length = 1; length < line.size(); ++length) {
    std::ofstream(folder.path() / "runs.jsonl", std::ios::binary) << whole + line.substr(0, length);
    const RunStore reading(path, Access::read);
    CHECK(reading.size() == 1);
    REQUIRE(reading.notes().size() == 1);
    CHECK(reading.notes()[0].find("the last line is cut off and ignored") != std::string::npos);
  }
  {
    RunStore store(path, Access::append);
    CHECK(store.size() == 1);
    store.append(store_record(1));
  }
  CHECK(text_of(folder.path() / "runs.jsonl") == whole + line);
  append_text(folder.path() / "runs.jsonl", std::string(5, '\0') + "\n{\"kind\":\"number\"}\n[]\n\n" + line);
  const RunStore damaged(path, Access::read);
  CHECK(damaged.size() == 2);
  REQUIRE(damaged.notes().size() == 1);
  CHECK(damaged.notes()[0].find("4 damaged lines are ignored") != std::string::npos);
}

TEST_CASE("store: it belongs to one writer, and readers find it", "[store]") {
  const test::TemporaryFolder folder;
  const std::string path = folder.path().string();
  CHECK_THROWS_AS(RunStore(path, Access::read), UsageError);
  {
    RunStore store(path, Access::append);
    store.append(store_record(0));
    CHECK_THROWS_AS(RunStore(path, Access::append), UsageError);
    CHECK(RunStore(path, Access::read).size() == 1);
    store.put_aside();
    CHECK(store.size() == 0);
    CHECK_THROWS_AS(RunStore(path, Access::append), UsageError);
    store.append(store_record(1));
  }
  CHECK(text_of(folder.path() / "runs.previous.jsonl") == store_record(0).dump() + "\n");
  CHECK(RunStore(path, Access::append).find("k1").has_value());
}

TEST_CASE("store: one that cannot be written says so and keeps what it has", "[store]") {
  CHECK_THROWS_AS(RunStore("/proc/none", Access::append), std::exception);
  const test::TemporaryFolder folder;
  RunStore store(folder.path().string(), Access::append);
  store.append(store_record(0));
  store.abandon();
  CHECK_THROWS_AS(store.append(store_record(1)), std::runtime_error);
  CHECK(text_of(folder.path() / "runs.jsonl") == store_record(0).dump() + "\n");
}
