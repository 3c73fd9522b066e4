// Counts what is allocated through operator new, and through malloc, which Eigen calls itself. The counters
// only run between start and stop, so that other tests in the same program are not concerned.
#include "tests/support/allocations.hpp"

#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>

#if defined(__SANITIZE_ADDRESS__)
#define GNOMON_TEST_OWN_MALLOC 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define GNOMON_TEST_OWN_MALLOC 0
#endif
#endif
#if !defined(GNOMON_TEST_OWN_MALLOC) && defined(__GLIBC__)
#define GNOMON_TEST_OWN_MALLOC 1
#endif
#if !defined(GNOMON_TEST_OWN_MALLOC)
#define GNOMON_TEST_OWN_MALLOC 0
#endif

namespace {

constinit thread_local bool counting = false;
constinit thread_local long allocations = 0;

void note() {
  if (counting) ++allocations;
}

void* allocate(std::size_t size, std::size_t alignment) {
  note();
  const bool counted = std::exchange(counting, false);
  if (size == 0) size = 1;
  void* memory = alignment <= alignof(std::max_align_t)
                     ? std::malloc(size)
                     : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  counting = counted;
  return memory;
}

void* checked(void* memory) {
  if (!memory) throw std::bad_alloc();
  return memory;
}

// Not inlined, because GCC would see free() given what operator new returned and warn.
[[gnu::noinline]] void release(void* memory) { std::free(memory); }

}  // namespace

namespace gnomon::test {

const bool counts_malloc = GNOMON_TEST_OWN_MALLOC != 0;

void start_counting() {
  allocations = 0;
  counting = true;
}
long stop_counting() {
  counting = false;
  return allocations;
}

}  // namespace gnomon::test

// All forms of new and delete, because one form's memory may be given to another's delete.
void* operator new(std::size_t size) { return checked(allocate(size, 1)); }
void* operator new[](std::size_t size) { return checked(allocate(size, 1)); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return allocate(size, 1); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return allocate(size, 1); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return checked(allocate(size, static_cast<std::size_t>(alignment)));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return checked(allocate(size, static_cast<std::size_t>(alignment)));
}
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { release(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t, const std::nothrow_t&) noexcept { release(memory); }
void operator delete[](void* memory, std::align_val_t, const std::nothrow_t&) noexcept { release(memory); }

#if GNOMON_TEST_OWN_MALLOC
// The C library's own malloc under its other name.
extern "C" void* __libc_malloc(std::size_t size) noexcept;
extern "C" void* malloc(std::size_t size) noexcept {
  note();
  return __libc_malloc(size);
}
#endif
