#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace gnomon {

/// What a piece of work in a child process may use.
struct ChildLimits {
  double seconds = 300.0;                   ///< wall-clock time without a sign of life; 0: no limit
  std::uint64_t bytes = 0;                  ///< of address space; 0: no limit
  const std::atomic<bool>* stop = nullptr;  ///< becomes true when the user interrupts
};

/// Half of the machine's memory, at least 1 GiB; 0 in a build with sanitizers, which reserve terabytes.
std::uint64_t default_memory_limit();

/// Signs of life of a child: which of its tasks it is at. Costs a nanosecond, so that it may stand in what is
/// timed.
class Pulse {
 public:
  void beat(int task) {
    task_.store(task, std::memory_order_relaxed);
    count_.fetch_add(1, std::memory_order_relaxed);
  }
  int task() const { return task_.load(std::memory_order_relaxed); }
  std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }

 private:
  std::atomic<int> task_{-1};
  std::atomic<std::uint64_t> count_{0};
};

enum class ChildEnd { done, crashed, time_limit, interrupted };

struct ChildResult {
  ChildEnd end = ChildEnd::done;
  std::string text;  ///< how it ended, unless it is done
  int task = -1;     ///< the last one of which there was a sign of life
};

/// Does `work` in a child process; `hear` is given each line that the work says, as it does. Whatever the
/// work does, a crash, an exception, memory without end or a loop, ends the child only. The child dies with
/// its parent. The caller must have no other threads. Throws std::runtime_error if there can be no child.
using Say = std::function<void(const std::string& line)>;
ChildResult in_child(const std::function<void(Pulse&, const Say&)>& work, const ChildLimits& limits,
                     const Say& hear);

/// Several pieces of work, each in a child process of its own.
struct ChildWork {
  std::size_t count = 0;
  std::function<void(std::size_t k, Pulse&, const Say&)> work;
  std::function<void(std::size_t k)> begin;                          ///< before number k starts
  std::function<void(std::size_t k, const std::string& line)> hear;  ///< what number k says
  std::function<void(std::size_t k, const ChildResult&)> ended;
};
/// As in_child, at most `jobs` children at a time, which start in order and end in any. After an interruption
/// none starts; those that have not are never heard of.
void in_children(const ChildWork& work, int jobs, const ChildLimits& limits);

}  // namespace gnomon
