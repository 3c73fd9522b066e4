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

void Progress::begin(std::string_view what) {
  ++started_;
  last_counts_ = true;
  if (mode_ == ProgressMode::silent) return;
  const double now = clock_();
  if (mode_ == ProgressMode::lines && line_printed_ && now - last_line_ < seconds_between_lines) return;

  const std::size_t position = started_ + skipped_;
  const std::size_t done = started_ - 1;
  std::string line = counter(position) + ' ' + plain_text(what);
  std::string left;
  if (done > 0 && position <= total_) {
    const double remaining = static_cast<double>(total_ - position + 1);
    left = "  " + duration((now - estimate_from_) / static_cast<double>(done) * remaining) + " left";
  }
  if (mode_ == ProgressMode::live) {
    // The last column stays free: some terminals wrap as soon as it is filled. The time left is kept whole.
    const std::size_t width = (columns_ > 0 ? columns_ : terminal_columns()) - 1;
    line = first_columns(line, width - std::min(width, display_columns(left)));
    out_ << clear_line << line << first_columns(left, width) << std::flush;
  } else {
    out_ << line << left << std::endl;
  }
  line_printed_ = true;
  last_line_ = now;
}

void Progress::skip(std::size_t count) { skipped_ += count; }

void Progress::known() {
  if (!last_counts_) return;
  last_counts_ = false;
  --started_;
  ++skipped_;
  if (started_ == 0) estimate_from_ = clock_();
}

void Progress::finish() {
  if (finished_ || mode_ == ProgressMode::silent) return;
  finished_ = true;
  if (mode_ == ProgressMode::live && line_printed_) out_ << clear_line;
  const std::string known = skipped_ > 0 ? fmt::format(", {} known already", skipped_) : "";
  out_ << counter(started_ + skipped_) << " done in " << duration(clock_() - start_) << known << std::endl;
}

}  // namespace gnomon::output
