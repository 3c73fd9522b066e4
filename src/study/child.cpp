#include "src/study/child.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <vector>

#include "src/output/text.hpp"

#if defined(__SANITIZE_ADDRESS__)
#define GNOMON_ADDRESS_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define GNOMON_ADDRESS_SANITIZER 1
#endif
#endif

namespace gnomon {
namespace {

constexpr int exit_no_memory = 81, exit_exception = 82;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

[[noreturn]] void fail(const char* what) {
  throw std::runtime_error(fmt::format("cannot {}: {}", what, std::strerror(errno)));
}

/// A descriptor that is closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { reset(); }
  int get() const { return number_; }
  void reset(int number = -1) {
    if (number_ >= 0) ::close(number_);
    number_ = number;
  }

 private:
  int number_;
};

/// A Pulse in memory that parent and child share.
class SharedPulse {
 public:
  SharedPulse()
      : memory_(::mmap(nullptr, sizeof(Pulse), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
    if (memory_ == MAP_FAILED) fail("share memory");
    pulse_ = new (memory_) Pulse;
  }
  SharedPulse(const SharedPulse&) = delete;
  SharedPulse& operator=(const SharedPulse&) = delete;
  ~SharedPulse() { ::munmap(memory_, sizeof(Pulse)); }
  Pulse& operator*() { return *pulse_; }
  Pulse* operator->() { return pulse_; }

 private:
  void* memory_;
  Pulse* pulse_ = nullptr;
};

void limit(decltype(RLIMIT_AS) what, std::uint64_t most) {
  rlimit old{};
  ::getrlimit(what, &old);
  const rlimit wanted{std::min<rlim_t>(most, old.rlim_max), old.rlim_max};
  ::setrlimit(what, &wanted);
}

void write_all(int file, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = ::write(file, text.data() + done, text.size() - done);
    if (count > 0)
      done += static_cast<std::size_t>(count);
    else if (errno != EINTR)
      return;
  }
}

[[noreturn]] void live(const std::function<void(Pulse&, const Say&)>& work, const ChildLimits& limits,
                       Pulse& pulse, pid_t parent, int results, int words) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(exit_exception);
  // The parent alone decides what an interruption ends.
  ::signal(SIGINT, SIG_IGN);
  for (const int each : {SIGTERM, SIGSEGV, SIGABRT, SIGFPE, SIGILL, SIGBUS}) ::signal(each, SIG_DFL);
  ::dup2(words, STDOUT_FILENO);
  ::dup2(words, STDERR_FILENO);
  limit(RLIMIT_CORE, 0);
  if (limits.bytes > 0) limit(RLIMIT_AS, limits.bytes);
  try {
    work(pulse, [&](const std::string& line) {
      write_all(results, line + '\n');
      // Nothing more is done before the parent has it.
      char heard = 0;
      if (::read(results, &heard, 1) != 1) ::_exit(exit_exception);
    });
    ::_exit(0);
  } catch (const std::bad_alloc&) {
    ::_exit(exit_no_memory);
  } catch (const std::exception& error) {
    write_all(words, error.what());
    ::_exit(exit_exception);
  } catch (...) {
    ::_exit(exit_exception);
  }
}

/// The last words of a child, one line.
std::string last_words(int words) {
  std::array<char, 2000> text{};
  const off_t size = std::max<off_t>(::lseek(words, 0, SEEK_END), 0);
  const off_t from = std::max<off_t>(size - static_cast<off_t>(text.size()), 0);
  const ssize_t count = ::pread(words, text.data(), text.size(), from);
  std::string all(text.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  while (!all.empty() && (all.back() == '\n' || all.back() == ' ')) all.pop_back();
  return output::first_columns(output::plain_text(all.substr(all.rfind('\n') + 1)), 160);
}

std::string how_it_ended(int status, int words, const ChildLimits& limits) {
  std::string text;
  if (WIFEXITED(status) && WEXITSTATUS(status) == exit_no_memory)
    return fmt::format("out of memory, limit {:.1f} GiB", static_cast<double>(limits.bytes) / 1073741824.0);
  if (WIFSIGNALED(status)) {
    const char* name = ::sigabbrev_np(WTERMSIG(status));
    text = fmt::format("ended by SIG{}", name ? name : "?");
    if (WTERMSIG(status) == SIGKILL) text += ", as the system does when memory runs out";
  } else if (WEXITSTATUS(status) == exit_exception) {
    text = "threw an exception";
  } else {
    text = fmt::format("ended the program with code {}", WEXITSTATUS(status));
  }
  const std::string said = last_words(words);
  return said.empty() ? text : text + ": " + said;
}

/// One child at its work. It does not outlive this object.
class Child {
 public:
  Child(const std::function<void(Pulse&, const Say&)>& work, const ChildLimits& limits)
      : limits_(limits), words_(::memfd_create("gnomon-child", MFD_CLOEXEC)) {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail("make a connection");
    results_.reset(ends[0]);
    Descriptor answers(ends[1]);
    const pid_t parent = ::getpid();
    child_ = ::fork();
    if (child_ < 0) fail("start a child process");
    if (child_ == 0) {
      results_.reset();
      live(work, limits, *pulse_, parent, answers.get(), words_.get());
    }
    count_ = pulse_->count();
    last_ = now();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    bury();
  }

  int results() const { return results_.get(); }

  /// Takes what has arrived; false where nothing more will.
  bool take(const Say& hear) {
    std::array<char, 65536> buffer;
    const ssize_t got = ::read(results_.get(), buffer.data(), buffer.size());
    if (got == 0 || (got < 0 && errno == ECONNRESET)) return false;
    if (got > 0) text_.append(buffer.data(), static_cast<std::size_t>(got));
    for (std::size_t end; (end = text_.find('\n')) != std::string::npos; text_.erase(0, end + 1)) {
      hear(text_.substr(0, end));
      ::send(results_.get(), "\n", 1, MSG_NOSIGNAL);
    }
    last_ = now();
    return true;
  }

  /// Whether it has been silent for too long.
  bool is_silent() {
    if (pulse_->count() != count_) {
      count_ = pulse_->count();
      last_ = now();
    }
    return limits_.seconds > 0.0 && now() - last_ > limits_.seconds;
  }

  /// Ends it, unless it has ended by itself (nothing for `how`).
  ChildResult end(std::optional<ChildEnd> how) {
    if (how) ::kill(child_, SIGKILL);
    const int status = bury();
    ChildResult result;
    result.task = pulse_->task();
    if (how == ChildEnd::time_limit)
      result.text = fmt::format("did not end within {:g} s", limits_.seconds);
    else if (how == ChildEnd::interrupted)
      result.text = "interrupted";
    else if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
      result.text = how_it_ended(status, words_.get(), limits_);
    else
      return result;
    result.end = how.value_or(ChildEnd::crashed);
    return result;
  }

 private:
  int bury() {
    int status = 0;
    while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
    }
    child_ = -1;
    return status;
  }

  ChildLimits limits_;
  Descriptor words_;
  Descriptor results_;
  SharedPulse pulse_;
  pid_t child_ = -1;
  std::string text_;  ///< not yet a whole line
  std::uint64_t count_ = 0;
  double last_ = 0.0;  ///< sign of life
};

struct Numbered {
  std::size_t number;
  std::unique_ptr<Child> child;
};

}  // namespace

std::uint64_t default_memory_limit() {
#ifdef GNOMON_ADDRESS_SANITIZER
  return 0;
#else
  const long pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGESIZE);
  const std::uint64_t least = std::uint64_t{1} << 30;
  if (pages <= 0 || size <= 0) return least;
  return std::max(least, static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size) / 2);
#endif
}

void in_children(const ChildWork& work, int jobs, const ChildLimits& limits) {
  const auto stopped = [&] { return limits.stop && limits.stop->load(std::memory_order_relaxed); };
  std::vector<Numbered> alive;
  for (std::size_t next = 0;;) {
    while (next < work.count && alive.size() < static_cast<std::size_t>(std::max(1, jobs)) && !stopped()) {
      const std::size_t k = next++;
      if (work.begin) work.begin(k);
      alive.push_back(
          {k, std::make_unique<Child>([&work, k](Pulse& pulse, const Say& say) { work.work(k, pulse, say); },
                                      limits)});
    }
    if (alive.empty()) return;
    std::vector<pollfd> waiting;
    for (const Numbered& each : alive) waiting.push_back({each.child->results(), POLLIN, 0});
    const bool ready = ::poll(waiting.data(), waiting.size(), 50) > 0;
    std::vector<Numbered> still;
    for (std::size_t i = 0; i < alive.size(); ++i) {
      Numbered& each = alive[i];
      const auto hear = [&](const std::string& line) { work.hear(each.number, line); };
      std::optional<ChildEnd> how;
      bool over = ready && waiting[i].revents != 0 && !each.child->take(hear);
      if (!over && stopped()) how = ChildEnd::interrupted;
      if (!over && !how && each.child->is_silent()) how = ChildEnd::time_limit;
      if (over || how)
        work.ended(each.number, each.child->end(how));
      else
        still.push_back(std::move(each));
    }
    alive = std::move(still);
  }
}

ChildResult in_child(const std::function<void(Pulse&, const Say&)>& work, const ChildLimits& limits,
                     const Say& hear) {
  ChildResult result{ChildEnd::interrupted, "interrupted", -1};
  in_children({1,
               [&](std::size_t, Pulse& pulse, const Say& say) { work(pulse, say); },
               {},
               [&](std::size_t, const std::string& line) { hear(line); },
               [&](std::size_t, const ChildResult& end) { result = end; }},
              1, limits);
  return result;
}

}  // namespace gnomon
