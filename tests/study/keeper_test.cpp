// Measurements in child processes: made once, kept as they end, and nothing they do harms the study.
#include "src/study/keeper.hpp"

#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/catch.hpp"
#include "tests/output/temporary_folder.hpp"

using namespace gnomon;

namespace {

using KeeperJson = Keeper::Json;

/// What the work of a child may do: by its number.
KeeperJson misbehave(std::size_t k) {
  switch (k) {
    case 1:
      std::abort();
    case 2:
      for (volatile bool forever = true; forever;) {
      }
      break;
    case 3:
      for (std::vector<char*> all;;) all.push_back(new char[std::size_t{1} << 24]);
    case 4:
      throw std::runtime_error("no such luck");
    case 5:
      ::raise(SIGSEGV);
      break;
    case 6:
      ::_exit(7);
    default:
      break;
  }
  return {{"number", k}, {"text", "a\nb"}};
}

std::vector<KeeperJson> identities(std::size_t count) {
  std::vector<KeeperJson> list;
  for (std::size_t k = 0; k < count; ++k) list.push_back({{"work", k}});
  return list;
}

struct Tally {
  std::vector<std::size_t> begun;
  std::vector<Keeper::Kept> kept;
};

template <class Work>
Tally keep_all(Keeper& keeper, std::size_t count, Work&& work) {
  Tally tally;
  keeper.get_all(
      "test", identities(count), false, [&](std::size_t k, Pulse&) { return work(k); },
      [&](std::size_t k) { tally.begun.push_back(k); },
      [&](std::size_t k, const Keeper::Kept& kept) {
        CHECK(k == tally.kept.size());
        tally.kept.push_back(kept);
        return true;
      });
  return tally;
}

/// A number that parent and children share.
class Shared {
 public:
  Shared()
      : value_(static_cast<std::atomic<int>*>(::mmap(
            nullptr, sizeof(std::atomic<int>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {
    new (value_) std::atomic<int>(0);
  }
  ~Shared() { ::munmap(value_, sizeof(std::atomic<int>)); }
  std::atomic<int>& operator*() { return *value_; }

 private:
  std::atomic<int>* value_;
};

}  // namespace

TEST_CASE("keeper: a crash, a loop or memory without end costs one measurement", "[store]") {
  const test::TemporaryFolder folder;
  RunStore store(folder.path().string(), RunStore::Access::append);
  const bool limited = default_memory_limit() > 0;
  Keeper keeper(store, {"code", "machine", true, {0.3, limited ? std::uint64_t{2} << 30 : 0, nullptr}});
  const auto work = [&](std::size_t k) { return misbehave(k == 3 && !limited ? 4 : k); };
  const Tally tally = keep_all(keeper, 8, work);
  CHECK(tally.begun == std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6, 7});
  REQUIRE(tally.kept.size() == 8);
  const auto told = [&](std::size_t k, Status status, const std::string& words) {
    INFO(k << ": " << tally.kept[k].message);
    CHECK(tally.kept[k].status == status);
    CHECK(tally.kept[k].message.find(words) != std::string::npos);
    CHECK(tally.kept[k].result.is_null());
  };
  for (const std::size_t k : {0, 7}) {
    CHECK(tally.kept[k].status == Status::ok);
    CHECK(tally.kept[k].message.empty());
    CHECK(tally.kept[k].result == misbehave(k));
  }
  told(1, Status::crashed, "ended by SIGABRT");
  told(2, Status::time_limit, "did not end within 0.3 s");
  if (limited) told(3, Status::crashed, "out of memory, limit 2.0 GiB");
  told(4, Status::crashed, "threw an exception: no such luck");
  told(5, Status::crashed, "ended by SIGSEGV");
  told(6, Status::crashed, "ended the program with code 7");
  CHECK(keeper.made() == 8);

  // All of it is known now, failures too; another program or machine knows nothing.
  Keeper again(store, {"code", "machine", true, {0.3, 0, nullptr}});
  const Tally known = keep_all(again, 8, [](std::size_t) -> KeeperJson { std::abort(); });
  CHECK(again.known() == 8);
  CHECK(again.made() == 0);
  for (std::size_t k = 0; k < 8; ++k) {
    CHECK(known.kept[k].status == tally.kept[k].status);
    CHECK(known.kept[k].message == tally.kept[k].message);
    CHECK(known.kept[k].result == tally.kept[k].result);
  }
  Keeper other(store, {"other code", "machine", false, {}});
  CHECK(keep_all(other, 8, misbehave).kept[7].message == "not in the store");
  CHECK(other.missing() == 8);
}

TEST_CASE("keeper: times belong to the machine, results to the program", "[store]") {
  const test::TemporaryFolder folder;
  RunStore store(folder.path().string(), RunStore::Access::append);
  Keeper here(store, {"code", "here", true, {}}), there(store, {"code", "there", false, {}});
  for (const bool timed : {false, true})
    CHECK(here.get(timed ? "times" : "run", {1}, timed, [](Pulse&) { return KeeperJson(7); }).result == 7);
  CHECK(there.get("run", {1}, false, [](Pulse&) { return KeeperJson(8); }).result == 7);
  CHECK(there.get("times", {1}, true, [](Pulse&) { return KeeperJson(8); }).status == Status::interrupted);
  CHECK(there.get("run", {2}, false, [](Pulse&) { return KeeperJson(8); }).status == Status::interrupted);
}

TEST_CASE("keeper: signs of life put off the limit, and tell where a child was", "[store]") {
  const test::TemporaryFolder folder;
  RunStore store(folder.path().string(), RunStore::Access::append);
  Keeper keeper(store, {"code", "machine", true, {0.4, 0, nullptr}});
  const auto pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds(100)); };
  CHECK(keeper
            .get("alive", {}, false,
                 [&](Pulse& pulse) {
                   for (int k = 0; k < 8; ++k, pause()) pulse.beat(k);
                   return KeeperJson("done");
                 })
            .result == "done");
  const Keeper::Kept dead = keeper.get("dead", {}, false, [&](Pulse& pulse) {
    for (int k = 0; k < 3; ++k) pulse.beat(k);
    for (;;) pause();
    return KeeperJson();
  });
  CHECK(dead.status == Status::time_limit);
  CHECK(dead.task == 2);
}

TEST_CASE("keeper: an interruption ends what is underway and keeps nothing of it", "[store]") {
  const test::TemporaryFolder folder;
  RunStore store(folder.path().string(), RunStore::Access::append);
  std::atomic<bool> stop{false};
  Keeper keeper(store, {"code", "machine", true, {0.0, 0, &stop}});
  Tally tally;
  keeper.get_all(
      "test", identities(5), false,
      [&](std::size_t k, Pulse&) {
        if (k == 2) std::this_thread::sleep_for(std::chrono::hours(1));
        return KeeperJson(k);
      },
      [&](std::size_t k) { stop = k == 2; },
      [&](std::size_t, const Keeper::Kept& kept) {
        tally.kept.push_back(kept);
        return true;
      });
  REQUIRE(tally.kept.size() == 3);
  CHECK(tally.kept[1].result == 1);
  CHECK(tally.kept[2].status == Status::interrupted);
  CHECK(store.size() == 2);
}

TEST_CASE("keeper: a program killed at any moment loses what was underway and nothing else", "[store]") {
  const test::TemporaryFolder folder;
  const std::string path = folder.path().string();
  constexpr std::size_t count = 400;
  Shared executed;
  const auto study = [&] {
    RunStore store(path, RunStore::Access::append);
    Keeper keeper(store, {"code", "machine", true, {}});
    keep_all(keeper, count, [&](std::size_t k) {
      ++*executed;
      return KeeperJson(std::string(200 + 37 * (k % 11), 'x'));
    });
  };
  int killed = 0;
  for (int attempt = 0; attempt < 12; ++attempt) {
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      study();
      ::_exit(0);
    }
    // Later and later, wherever it may be.
    std::this_thread::sleep_for(std::chrono::microseconds(1500 + 1700 * attempt));
    ::kill(child, SIGKILL);
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    if (WIFSIGNALED(status)) ++killed;
    // Its own child dies with it, and only then is the store free.
    for (int wait = 0;; ++wait) {
      try {
        RunStore(path, RunStore::Access::append);
        break;
      } catch (const std::exception&) {
        REQUIRE(wait < 1000);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    }
  }
  CHECK(killed >= 3);
  const std::size_t kept = RunStore(path, RunStore::Access::read).size();
  study();
  const RunStore store(path, RunStore::Access::read);
  CHECK(store.size() == count);
  CHECK(store.notes().empty());
  INFO(killed << " times killed, " << kept << " kept before the last call");
  CHECK(*executed >= static_cast<int>(count));
  // What was made twice was underway at a kill: one each time.
  CHECK(*executed <= static_cast<int>(count) + killed);
}
