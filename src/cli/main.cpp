#include <atomic>
#include <csignal>
#include <cstdio>
#include <functional>
#include <iostream>

#include <fmt/format.h>

#include "integrators/catalogue.hpp"
#include "models/catalogue.hpp"
#include "src/cli/command.hpp"
#include "src/cli/parse.hpp"
#include "src/error.hpp"

namespace {

// The one place that a signal handler can reach.
std::atomic<bool> stop_requested{false};

void request_stop(int signal) {
  stop_requested.store(true);
  std::signal(signal, SIG_DFL);  // a second Ctrl-C ends at once
}

}  // namespace

int main(int argc, char** argv) {
  using namespace gnomon;
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  try {
    Catalogue catalogue;
    add_models(catalogue);
    add_integrators(catalogue);
    return cli::parse_and_run(catalogue, stop_requested, argc, argv);
  } catch (const UsageError& error) {
    std::cerr << "gnomon: " << error.what() << '\n';
    return cli::bad_usage;
  } catch (const std::exception& error) {
    std::cerr << "gnomon: " << error.what() << '\n';
    return cli::run_failed;
  }
}
