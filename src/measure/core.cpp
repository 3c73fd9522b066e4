#include "src/measure/core.hpp"

#include <fmt/format.h>
#include <sched.h>

#include <fstream>
#include <memory>

namespace gnomon {
namespace {

// More than any Linux machine has.
constexpr int most_cores = 8192;

struct FreeSet {
  void operator()(cpu_set_t* set) const { CPU_FREE(set); }
};
using CoreSet = std::unique_ptr<cpu_set_t, FreeSet>;

CoreSet empty_set() {
  CoreSet set(CPU_ALLOC(most_cores));
  if (set) CPU_ZERO_S(CPU_ALLOC_SIZE(most_cores), set.get());
  return set;
}

bool restrict_to(const std::vector<int>& cores) {
  const CoreSet set = empty_set();
  if (!set || cores.empty()) return false;
  for (const int core : cores)
    CPU_SET_S(static_cast<std::size_t>(core), CPU_ALLOC_SIZE(most_cores), set.get());
  return sched_setaffinity(0, CPU_ALLOC_SIZE(most_cores), set.get()) == 0;
}

/// Highest frequency in kHz; 0 where it is not visible, as in most virtual machines.
long highest_frequency(int core) {
  std::ifstream in(fmt::format("/sys/devices/system/cpu/cpu{}/cpufreq/cpuinfo_max_freq", core));
  long frequency = 0;
  return in >> frequency ? frequency : 0;
}

}  // namespace

std::vector<int> allowed_cores() {
  std::vector<int> cores;
  const CoreSet set = empty_set();
  if (!set || sched_getaffinity(0, CPU_ALLOC_SIZE(most_cores), set.get()) != 0) return cores;
  for (int core = 0; core < most_cores; ++core)
    if (CPU_ISSET_S(static_cast<std::size_t>(core), CPU_ALLOC_SIZE(most_cores), set.get()))
      cores.push_back(core);
  return cores;
}

std::optional<int> timing_core() {
  std::optional<int> best;
  long fastest = 0;
  for (const int core : allowed_cores()) {
    const long frequency = highest_frequency(core);
    if (best && frequency < fastest) continue;
    best = core;
    fastest = frequency;
  }
  return best;
}

OnOneCore::OnOneCore() : before_(allowed_cores()) {
  const std::optional<int> core = timing_core();
  if (core && restrict_to({*core})) core_ = core;
}

OnOneCore::~OnOneCore() {
  if (core_) restrict_to(before_);
}

}  // namespace gnomon
