#pragma once

namespace gnomon::test {

extern constinit thread_local bool counting;
extern constinit thread_local long allocations;
/// Whether calls of malloc are counted, too: not under the address sanitizer, nor with other C libraries.
extern const bool counts_malloc;

/// Number of allocations of this thread while `body` runs.
template <class Body>
long allocations_of(Body&& body) {
  allocations = 0;
  counting = true;
  body();
  counting = false;
  return allocations;
}

}  // namespace gnomon::test
