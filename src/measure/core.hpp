#pragma once
// The core that timed runs stay on.

#include <optional>
#include <vector>

namespace gnomon {

/// The cores that the calling thread may run on, ascending; empty if the system does not say.
std::vector<int> allowed_cores();

/// The core for timed runs: of the allowed ones with the highest clock frequency (all, where that is not
/// visible) the last, as systems keep the first ones busy. Nothing where no core can be chosen.
std::optional<int> timing_core();

/// While it exists, the calling thread stays on timing_core(), so that moves to other cores and their cold
/// caches are not measured. Threads that are made meanwhile stay there, too: what is measured of them is CPU
/// time. Does nothing where the system does not let it.
class OnOneCore {
 public:
  OnOneCore();
  OnOneCore(const OnOneCore&) = delete;
  OnOneCore& operator=(const OnOneCore&) = delete;
  ~OnOneCore();
  /// The core; nothing if the thread may be moved.
  std::optional<int> core() const { return core_; }

 private:
  std::vector<int> before_;
  std::optional<int> core_;
};

}  // namespace gnomon
