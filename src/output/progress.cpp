#include "src/output/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ostream>
#include <utility>

#include "src/output/text.hpp"

namespace gnomon::output {
namespace {

constexpr double seconds_between_lines = 10.0;
constexpr double few_runs = 8.0;
constexpr std::size_t columns_for_a_bar = 70;
constexpr const char* clear_line = "\r\033[K";

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::size_t terminal_columns() {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

}  // namespace

std::string duration(double seconds) {
  if (!std::isfinite(seconds) || seconds < 0.0 || seconds > 1e15) return "unknown time";
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

ProgressMode progress_mode(bool quiet) {
  if (quiet) return ProgressMode::silent;
  const char* terminal = std::getenv("TERM");
  const bool can_rewrite = terminal != nullptr && std::string_view(terminal) != "dumb";
  return can_rewrite && ::isatty(STDERR_FILENO) == 1 ? ProgressMode::live : ProgressMode::lines;
}

Progress::Progress(std::size_t total, ProgressMode mode, std::ostream& out, std::size_t columns, Clock clock)
    : total_(total),
      mode_(mode),
      out_(out),
      columns_(columns),
      clock_(clock ? std::move(clock) : Clock(steady_seconds)),
      start_(clock_()),
      estimate_from_(start_) {}

Progress::~Progress() {
  if (mode_ == ProgressMode::live && line_printed_ && !finished_) out_ << clear_line << std::flush;
}

std::string Progress::counter(std::size_t position) const {
  const std::string total = std::to_string(total_);
  return fmt::format("[{:>{}}/{}]", position, total.size(), total);
}

std::string Progress::bar(std::size_t position) const {
  const std::size_t cells = 10, done = std::min(position > 0 ? position - 1 : 0, total_);
  const std::size_t filled = total_ > 0 ? cells * done / total_ : 0;
  return std::string(filled, '#') + std::string(cells - filled, '.');
}

void Progress::settle() {
  if (known_ && !made_) {
    --started_;
    ++skipped_;
  }
  known_ = made_ = false;
}

std::string Progress::time_left(std::size_t position, double now) const {
  const std::size_t made = started_ - 1;
  if (position > total_ || made + timed_ == 0) return "";
  std::size_t left = total_ - position + 1;
  if (to_make_) left = std::min(left, std::max<std::size_t>(1, *to_make_ - std::min(*to_make_, made)));
  // What known runs took says as much as a few that are made.
  const double known = std::min(static_cast<double>(timed_), few_runs);
  const double seconds =
      now - estimate_from_ + (timed_ > 0 ? timed_seconds_ / static_cast<double>(timed_) * known : 0.0);
  return "  " + duration(seconds / (static_cast<double>(made) + known) * static_cast<double>(left)) + " left";
}

void Progress::begin(std::string_view what) {
  settle();
  const double now = mode_ == ProgressMode::silent ? 0.0 : clock_();
  if (started_ == 0) estimate_from_ = now;
  ++started_;
  if (mode_ == ProgressMode::silent) return;
  if (mode_ == ProgressMode::lines && line_printed_ && now - last_line_ < seconds_between_lines) return;

  const std::size_t position = started_ + skipped_;
  const std::string left = time_left(position, now);
  if (mode_ == ProgressMode::live) {
    // The last column stays free: some terminals wrap as soon as it is filled. The time left is kept whole.
    const std::size_t columns = columns_ > 0 ? columns_ : terminal_columns(), width = columns - 1;
    std::string line = counter(position);
    if (columns >= columns_for_a_bar) line.insert(line.size() - 1, ' ' + bar(position));
    line += ' ' + plain_text(what);
    line = first_columns(line, width - std::min(width, display_columns(left)));
    out_ << clear_line << line << first_columns(left, width) << std::flush;
  } else {
    out_ << counter(position) << ' ' << plain_text(what) << left << std::endl;
  }
  line_printed_ = true;
  last_line_ = now;
}

void Progress::skip(std::size_t count) { skipped_ += count; }

void Progress::known(double seconds) {
  known_ = true;
  if (!std::isfinite(seconds)) return;
  ++timed_;
  timed_seconds_ += seconds;
}

void Progress::made() { made_ = true; }

void Progress::expect(std::size_t to_make) { to_make_ = to_make; }

std::size_t Progress::made_so_far() const { return started_ - (known_ && !made_ ? 1 : 0); }

void Progress::finish() {
  settle();
  if (finished_ || mode_ == ProgressMode::silent) return;
  finished_ = true;
  if (mode_ == ProgressMode::live && line_printed_) out_ << clear_line;
  const std::string known = skipped_ > 0 ? fmt::format(", {} known already", skipped_) : "";
  out_ << counter(started_ + skipped_) << " done in " << duration(clock_() - start_) << known << std::endl;
}

}  // namespace gnomon::output
