#pragma once
#include <atomic>

#include "src/catalogue.hpp"

namespace gnomon::cli {

/// Reads the command line, runs the command and returns its exit code. Throws UsageError.
int parse_and_run(const Catalogue& catalogue, const std::atomic<bool>& stop, int argc,
                  const char* const* argv);

}  // namespace gnomon::cli
