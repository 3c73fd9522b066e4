// What the inner loop allocates.

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <vector>

#include "integrators/rotation/discrete_element.hpp"
#include "integrators/rotation/families.hpp"
#include "src/run.hpp"
#include "tests/catch.hpp"
#include "tests/support/allocations.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

template <class Body, class... S>
void for_each(TypeList<S...>, Body&& body) {
  (body(TypeList<S>{}), ...);
}

template <class Body>
void for_each_scheme(Body&& body) {
  for_each(rotation::MunjizaSchemes{}, body);
  for_each(rotation::SplittingSchemes{}, body);
  for_each(rotation::HighSplittingSchemes{}, body);
  for_each(rotation::MoserVeselovSchemes{}, body);
  for_each(rotation::MoserVeselovSplittings{}, body);
  for_each(rotation::HighMoserVeselovSplittings{}, body);
  for_each(rotation::SecondOrderSchemes{}, body);
  for_each(rotation::ExplicitSchemes{}, body);
  for_each(rotation::DiscreteElementSchemes{}, body);
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
  if (counts_malloc) {
    Eigen::MatrixXd matrix;
    CHECK(allocations_of([&] { matrix.resize(50, 50); }) == 1);
  }
}

TEST_CASE("schemes: steps of equal size allocate nothing", "[rotation][allocation][long]") {
  const Catalogue catalogue = full_catalogue();
  std::vector<std::string_view> names;
  for_each_scheme([&]<class S>(TypeList<S>) { names.push_back(S::info.name); });
  // Every scheme of equal steps on rigid bodies is in the list above.
  for (const SchemeInfo& info : schemes(catalogue, Stepping::fixed))
    if (info.form == "rotation") CHECK(std::count(names.begin(), names.end(), info.name) == 1);

  for (const char* name :
       {"asymmetric-free-top", "asymmetric-heavy-top", "space-moment", "body-moment", "rest-then-pushed"}) {
    const Scene scene = load_scene(catalogue, name);
    with_rigid_body(scene, [&](const auto& model) {
      for_each_scheme([&]<class S>(TypeList<S>) {
        INFO(S::info.name << " on " << name);
        CHECK(allocations_of_steps<S>(model) == 0);
      });
    });
  }
  const Scene scene = load_scene(catalogue, "space-moment");
  CHECK(allocations_of_steps<Allocating>(typed<RigidBody<SpaceMoment>>(scene)) >= 1000);
}

TEST_CASE("schemes: a run of a million steps keeps no more than one of ten thousand",
          "[rotation][allocation]") {
  const Scene scene = load_scene(full_catalogue(), "asymmetric-free-top");
  const auto& body = typed<RigidBody<Free>>(scene);
  struct Seen {
    long allocations;
    std::size_t kept;
  };
  const auto run_of = [](const auto& model, auto list, long steps) {
    return [&]<class S>(TypeList<S>) {
      RunSpec spec;
      spec.step = 0.01;
      spec.t_end = 0.01 * static_cast<double>(steps);
      spec.watch = 2048;
      RunResult result;
      const long count = allocations_of([&] { result = run<std::decay_t<decltype(model)>, S>(model, spec); });
      CHECK(result.status == Status::ok);
      CHECK(result.t == spec.t_end);
      return Seen{count, result.invariants.t.size() + result.invariants.values.size() +
                             result.sample_times.size() + result.state.size()};
    }(list);
  };
  const Seen few = run_of(body, TypeList<rotation::Munjiza>{}, 10'000),
             many = run_of(body, TypeList<rotation::Munjiza>{}, 1'000'000);
  INFO(few.allocations << " and " << many.allocations << " allocations");
  // Where steps are few, some watched times fall on the same step.
  CHECK(many.kept <= few.kept + few.kept / 50);
  CHECK(many.kept >= few.kept);
  // Looking at the state every few milliseconds costs some, whatever the speed of the machine.
  CHECK(many.allocations <= few.allocations + 20'000);
  // A scheme that allocates in every step is seen.
  const Scene pushed = load_scene(full_catalogue(), "space-moment");
  const auto& driven = typed<RigidBody<SpaceMoment>>(pushed);
  const Seen less = run_of(driven, TypeList<Allocating>{}, 10'000),
             more = run_of(driven, TypeList<Allocating>{}, 40'000);
  CHECK(more.allocations >= less.allocations + 30'000);
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
      dae.pack(0.0, model.initial(), y);
      dae.resume(0.0, y, rate);
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
