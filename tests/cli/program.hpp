#pragma once
// Runs the built program as a user does, in a folder of its own.

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/output/temporary_folder.hpp"

namespace gnomon::test {

inline std::string content_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  if (!(out << text)) throw std::runtime_error("cannot write " + path.string());
}

/// The environment's GNOMON_PROGRAM, else the program of this build.
inline std::string program_path() {
  if (const char* path = std::getenv("GNOMON_PROGRAM")) return path;
#ifdef GNOMON_PROGRAM
  return GNOMON_PROGRAM;
#else
  return GNOMON_BINARY_DIR "/gnomon";
#endif
}

struct Outcome {
  int exit_code = -1;  ///< -1 where a signal ended it
  int signal = 0;      ///< that signal
  std::string out;
  std::string err;
};

/// One call of the program, running from the construction on. Its standard input is empty.
class Call {
 public:
  Call(const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
    std::vector<std::string> words{program_path()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    const auto open = [&](int descriptor, const std::string& path, int flags) {
      ::posix_spawn_file_actions_addopen(&actions, descriptor, path.c_str(), flags, 0644);
    };
    open(STDIN_FILENO, "/dev/null", O_RDONLY);
    open(STDOUT_FILENO, out_path(), O_WRONLY | O_CREAT | O_TRUNC);
    open(STDERR_FILENO, err_path(), O_WRONLY | O_CREAT | O_TRUNC);
    ::posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    const int error = ::posix_spawn(&pid_, argv[0], &actions, nullptr, argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::runtime_error("cannot start " + words[0]);
  }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;
  ~Call() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }

  void interrupt() const { ::kill(pid_, SIGINT); }

  /// Waits until standard error holds `text`.
  void await_error_output(const std::string& text) const {
    poll([&] { return content_of(err_path()).find(text) != std::string::npos; },
         "no '" + text + "' appeared");
  }

  Outcome wait() {
    int status = 0;
    poll([&] { return ::waitpid(pid_, &status, WNOHANG) == pid_; }, "the program did not end");
    pid_ = 0;
    Outcome outcome;
    if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
    outcome.out = content_of(out_path());
    outcome.err = content_of(err_path());
    return outcome;
  }

 private:
  std::string out_path() const { return (output_.path() / "out").string(); }
  std::string err_path() const { return (output_.path() / "err").string(); }

  template <class Condition>
  static void poll(Condition&& condition, const std::string& otherwise) {
    using Clock = std::chrono::steady_clock;
    const auto deadline = Clock::now() + std::chrono::seconds(60);
    while (!condition()) {
      if (Clock::now() > deadline) throw std::runtime_error(otherwise + " within a minute");
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  TemporaryFolder output_;
  pid_t pid_ = 0;
};

inline Outcome run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
  return Call(arguments, folder).wait();
}

}  // namespace gnomon::test
