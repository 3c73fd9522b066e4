#include "integrators/ensemble/team.hpp"

#include <pthread.h>
#include <time.h>

#include <cstddef>

namespace gnomon::ensemble {

Team::Team(int threads) {
  try {
    for (int part = 1; part < threads; ++part) helpers_.emplace_back([this, part] { help(part); });
  } catch (...) {
    stop();
    throw;
  }
}

Team::~Team() { stop(); }

void Team::stop() {
  over_.store(true);
  round_.fetch_add(1);
  round_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
  helpers_.clear();
}

void Team::run(Task task, const void* context) {
  if (!helpers_.empty()) {
    task_ = task;
    context_ = context;
    open_.store(static_cast<int>(helpers_.size()), std::memory_order_relaxed);
    round_.fetch_add(1, std::memory_order_release);
    round_.notify_all();
  }
  task(context, 0);
  for (int open; (open = open_.load(std::memory_order_acquire)) > 0;)
    open_.wait(open, std::memory_order_acquire);
}

void Team::help(int part) {
  for (int seen = 0;;) {
    round_.wait(seen, std::memory_order_acquire);
    seen = round_.load(std::memory_order_acquire);
    if (over_.load()) return;
    task_(context_, part);
    if (open_.fetch_sub(1, std::memory_order_release) == 1) open_.notify_one();
  }
}

double Team::helper_cpu_seconds() const {
  double sum = 0.0;
  for (const std::thread& helper : helpers_) {
    clockid_t clock;
    timespec time{};
    if (pthread_getcpuclockid(const_cast<std::thread&>(helper).native_handle(), &clock) == 0 &&
        clock_gettime(clock, &time) == 0)
      sum += static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  return sum;
}

}  // namespace gnomon::ensemble
