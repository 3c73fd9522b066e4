#pragma once

namespace gnomon::test {

/// Not inlined: a compiler may take malloc for a function that changes no variable of the program.
void start_counting();
long stop_counting();
/// Whether calls of malloc are counted, too: not under the address sanitizer, nor with other C libraries.
extern const bool counts_malloc;

/// Number of allocations of this thread while `body` runs.
template <class Body>
long allocations_of(Body&& body) {
  start_counting();
  body();
  return stop_counting();
}

}  // namespace gnomon::test
