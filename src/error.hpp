#pragma once
#include <stdexcept>
#include <string>

namespace gnomon {

/// Bad usage or a bad scene: the message says where, what was found and what would be right. Exit code 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace gnomon
