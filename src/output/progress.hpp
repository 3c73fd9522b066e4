#pragma once
// How far a study is, on standard error.

#include <chrono>
#include <cstddef>
#include <functional>
#include <iosfwd>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace gnomon::output {

/// "7 s", "1 min 10 s", "2 h 05 min": a duration for people; negative or non-finite is "unknown time".
std::string duration(double seconds);

enum class ProgressMode {
  silent,
  lines,  ///< plain lines, the first at once, then at most one in ten seconds
  live    ///< one line that is rewritten
};

/// silent if `quiet`, live if standard error is a terminal that can rewrite a line, else lines.
ProgressMode progress_mode(bool quiet);

/// Reports runs as they start: "[ 37/128 ###.......] scene / integrator  step 0.01  1 min 10 s left", without
/// the bar in plain lines. The time left assumes that runs still to be made cost as much as those made on
/// average; while these are few, what known runs took when they were made counts, too. For one thread.
class Progress {
 public:
  using Clock = std::function<double()>;  ///< seconds since any fixed time

  /// `columns` is the width a live line is cut to; 0 asks the terminal. Without a clock the steady clock is
  /// used.
  Progress(std::size_t total, ProgressMode mode, std::ostream& out, std::size_t columns = 0,
           Clock clock = {});
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Clears a live line that finish() has not ended, as when a study is left by an exception.
  ~Progress();

  /// The next run begins; the previous one, if any, is done.
  void begin(std::string_view what);
  /// The next `count` runs need not be made (they are known already), so they say nothing about time left.
  void skip(std::size_t count);
  /// What the run that has begun last consists of was known already; it took `seconds` when it was made, if
  /// that is a number.
  void known(double seconds = std::numeric_limits<double>::quiet_NaN());
  /// A part of it was not. A run of which nothing is said counts as made.
  void made();
  /// This many runs have to be made, and the rest are known; without it all that have not begun count.
  void expect(std::size_t to_make);
  /// Runs that were not known, so far.
  std::size_t made_so_far() const;
  /// All is done: prints the number of runs and the time they took. Further calls do nothing.
  void finish();

 private:
  std::string counter(std::size_t position) const;
  std::string bar(std::size_t position) const;
  std::string time_left(std::size_t position, double now) const;
  void settle();

  std::size_t total_;
  ProgressMode mode_;
  std::ostream& out_;
  std::size_t columns_;
  Clock clock_;
  double start_;
  double estimate_from_;
  /// Of the run that has begun last: whether anything was known, or made.
  bool known_ = false, made_ = false;
  std::optional<std::size_t> to_make_;
  std::size_t timed_ = 0;  ///< known ones that say how long they took
  double timed_seconds_ = 0.0;
  double last_line_ = 0.0;
  std::size_t started_ = 0;
  std::size_t skipped_ = 0;
  bool line_printed_ = false;
  bool finished_ = false;
};

}  // namespace gnomon::output
