// Counts what the inner loop allocates: through operator new, and through
// malloc, which Eigen calls itself. The counters only run between start and
// stop, so that other tests in the same program are not concerned.

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "integrators/rotation/munjiza.hpp"
#include "src/run.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

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

namespace {

thread_local bool counting = false;
thread_local long allocations = 0;

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

template <class Body>
long allocations_of(Body&& body) {
  allocations = 0;
  counting = true;
  body();
  counting = false;
  return allocations;
}

}  // namespace

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

using namespace gnomon;
using namespace gnomon::test;

namespace {

using FixedSchemes =
    TypeList<rotation::Munjiza, rotation::MunjizaHalfImpulse, rotation::MunjizaStageMoments, rotation::Rkmk4>;

template <class Body, class... S>
void for_each(TypeList<S...>, Body&& body) {
  (body(TypeList<S>{}), ...);
}

// Allocations of 1000 steps in the driver's inner loop.
template <class S, class M>
long allocations_of_steps(const M& model) {
  auto state = S::start(model, model.initial());
  long n = 0;
  Status status = Status::unsupported;
  const long count = allocations_of([&] { status = detail::march<M, S>(model, state, n, 1000, 1e-3); });
  CHECK(status == Status::ok);
  CHECK(n == 1000);
  CHECK(model.distance(S::view(model, state), model.initial())[1] > 0.0);
  return count;
}

// A scheme that keeps its state on the heap.
struct Allocating {
  static constexpr SchemeInfo info{
      .name = "allocating", .family = "test", .summary = "", .citation = "", .form = "rotation"};
  template <class M>
  using State = std::vector<double>;
  template <class M>
  static std::vector<double> start(const M& model, const BodyState& state) {
    return model.flatten(state);
  }
  template <class M>
  static BodyState view(const M& model, const std::vector<double>& state) {
    return model.restore(state);
  }
  template <class M>
  static Cost cost(const M&, const std::vector<double>&, long) {
    return {};
  }
  template <class M>
  static Status step(const M& model, std::vector<double>& state, double, double) {
    BodyState next = model.restore(state);
    next.angular_momentum *= 1.001;
    state = model.flatten(next);
    return Status::ok;
  }
};

}  // namespace

TEST_CASE("schemes: the counters of allocations see what is allocated", "[rotation][allocation]") {
  std::vector<double> values;
  CHECK(allocations_of([&] { values.resize(100); }) >= 1);
  CHECK(allocations_of([&] { values[3] += 1.0; }) == 0);
  struct alignas(64) Wide {
    double values[8];
  };
  std::unique_ptr<Wide> wide;
  CHECK(allocations_of([&] { wide = std::make_unique<Wide>(); }) == 1);
  CHECK(reinterpret_cast<std::size_t>(wide.get()) % 64 == 0);
#if GNOMON_TEST_OWN_MALLOC
  Eigen::MatrixXd matrix;
  CHECK(allocations_of([&] { matrix.resize(50, 50); }) == 1);
#endif
}

TEST_CASE("schemes: steps of equal size allocate nothing", "[rotation][allocation]") {
  const Catalogue catalogue = full_catalogue();
  std::vector<std::string_view> names;
  for_each(FixedSchemes{}, [&]<class S>(TypeList<S>) { names.push_back(S::info.name); });
  // Every scheme of equal steps on rigid bodies is in the list above.
  for (const SchemeInfo& info : schemes(catalogue, Stepping::fixed))
    if (info.form == "rotation") CHECK(std::count(names.begin(), names.end(), info.name) == 1);

  for (const char* name :
       {"asymmetric-free-top", "asymmetric-heavy-top", "space-moment", "body-moment", "rest-then-pushed"}) {
    const Scene scene = load_scene(catalogue, name);
    with_rigid_body(scene, [&](const auto& model) {
      for_each(FixedSchemes{}, [&]<class S>(TypeList<S>) {
        INFO(S::info.name << " on " << name);
        CHECK(allocations_of_steps<S>(model) == 0);
      });
    });
  }
  const Scene scene = load_scene(catalogue, "space-moment");
  CHECK(allocations_of_steps<Allocating>(typed<RigidBody<SpaceMoment>>(scene)) >= 1000);
}

TEST_CASE("rigid body: rates, Jacobians and invariants allocate nothing", "[rigid_body][allocation]") {
  const Catalogue catalogue = full_catalogue();
  for (const ShippedScene& shipped : shipped_scenes(catalogue)) {
    const Scene scene = load_scene(catalogue, shipped.name);
    if (scene.model_name != "rigid_body") continue;
    INFO(shipped.name);
    with_rigid_body(scene, [&](const auto& model) {
      const auto ode = model.ode();
      const auto dae = model.dae();
      double y[8], rate[8], values[64], found[16];
      dae.pack(model.initial(), y, rate);
      CHECK(allocations_of([&] {
              ode.rhs(0.0, y, values);
              ode.jacobian(0.0, y, values);
              dae.residual(0.0, y, rate, values);
              dae.jacobian(0.0, 1.0, y, rate, values);
              model.invariants(0.0, model.initial(), found);
            }) == 0);
    });
  }
}
