#pragma once
// Catches what is written to standard error, also by C code.

#include <unistd.h>

#include <cstdio>
#include <stdexcept>
#include <string>

namespace gnomon::test {

/// From its making to its end file descriptor 2 goes to a temporary file.
class StderrCapture {
 public:
  StderrCapture() : file_(std::tmpfile()), saved_(::dup(2)) {
    std::fflush(stderr);
    if (!file_ || saved_ < 0 || ::dup2(::fileno(file_), 2) < 0)
      throw std::runtime_error("standard error could not be redirected");
  }
  StderrCapture(const StderrCapture&) = delete;
  StderrCapture& operator=(const StderrCapture&) = delete;
  ~StderrCapture() {
    std::fflush(stderr);
    ::dup2(saved_, 2);
    ::close(saved_);
    std::fclose(file_);
  }

  /// What has been written so far.
  std::string text() const {
    std::fflush(stderr);
    std::string text;
    char part[4096];
    for (off_t at = 0;;) {
      const ssize_t count = ::pread(::fileno(file_), part, sizeof part, at);
      if (count <= 0) return text;
      text.append(part, static_cast<std::size_t>(count));
      at += count;
    }
  }

 private:
  std::FILE* file_;
  int saved_;
};

}  // namespace gnomon::test
