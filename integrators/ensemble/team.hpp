#pragma once
#include <atomic>
#include <thread>
#include <vector>

namespace gnomon::ensemble {

/// Threads that wait for the parts of a piece of work; the calling thread does one of them itself.
class Team {
 public:
  /// `part` counts from 0 to size() - 1.
  using Task = void (*)(const void* context, int part);

  /// At least 1 thread, the calling one counted. Throws std::system_error if they cannot be had.
  explicit Team(int threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int size() const { return static_cast<int>(helpers_.size()) + 1; }
  /// Does all parts, one a thread, and returns when the last is done. Allocates nothing. Not to be called by
  /// two threads at once; the task must not throw.
  void run(Task task, const void* context);
  /// CPU time used so far by the threads other than the calling one, waiting included [s].
  double helper_cpu_seconds() const;

 private:
  void help(int part);
  void stop();

  Task task_ = nullptr;
  const void* context_ = nullptr;
  std::atomic<int> round_{0};  // of work; a change sets the helpers going
  std::atomic<int> open_{0};   // helpers that are not done with the round
  std::atomic<bool> over_{false};
  std::vector<std::thread> helpers_;
};

}  // namespace gnomon::ensemble
