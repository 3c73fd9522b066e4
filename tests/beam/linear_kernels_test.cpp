// The beam schemes' kernels for linear elements against the general stepper.
#include <cmath>
#include <limits>
#include <vector>

#include "integrators/beam/midpoint.hpp"
#include "tests/catch.hpp"
#include "tests/planar_beam/beams.hpp"
#include "tests/support/allocations.hpp"

using namespace gnomon;
using namespace gnomon::test;
using beam::Turning;
using beam::linear::Kernels;

namespace {

using LinearBeam = PlanarBeam<1>;
template <Turning turning>
using Fast = beam::linear::FastStepper<LinearBeam, turning>;
template <Turning turning>
using General = beam::Stepper<LinearBeam, turning>;

/// All that this machine has.
std::vector<const Kernels*> all_kernels() {
  std::vector<const Kernels*> all{&beam::linear::scalar_kernels(), &beam::linear::paired_kernels()};
  for (InstructionSet set : instruction_sets())
    if (const Kernels* kernels = beam::linear::kernels(set)) all.push_back(kernels);
  return all;
}

/// A moving beam with a load at its middle and ends, its ends held as told.
LinearBeam moving_beam(int elements, const planar_beam::Support& start, const planar_beam::Support& end,
                       double curvature) {
  Data data = flying_beam(elements, 500.0);
  data.curvature = curvature;
  data.gravity = 0.3;
  data.supports = {start, end};
  data.loads.push_back({planar_beam::Place::end, {1.0, -2.0}, 5.0, planar_beam::Profile::half_sine, 1.0});
  return LinearBeam(data);
}

/// Largest difference of two states, of displacements, velocities and strains alike.
double difference(const planar_beam::State& a, const planar_beam::State& b) {
  return std::max({(a.u - b.u).lpNorm<Eigen::Infinity>(), (a.v - b.v).lpNorm<Eigen::Infinity>(),
                   (a.strain - b.strain).lpNorm<Eigen::Infinity>()});
}

/// Both steppers over the same steps. The fast one is to have made all of them but the first `slow`.
template <Turning turning>
void compare(const LinearBeam& model, const Kernels& kernels, double h, int steps, int slow = 0) {
  const SchemeOptions options{.newton_tol = 1e-12};
  Fast<turning> fast(model, model.initial(), options, &kernels);
  General<turning> general(model, model.initial(), options);
  for (int n = 0; n < steps; ++n) {
    REQUIRE(fast.step(model, n * h, h) == Status::ok);
    REQUIRE(general.step(model, n * h, h) == Status::ok);
  }
  const auto found = fast.view(model), expected = general.view(model);
  CHECK(difference(found, expected) <= 1e-9);
  CHECK((expected.u - model.initial().u).norm() >= 1e-3);  // it has moved
  CHECK(fast.fast_steps() >= (model.elements() >= kernels.lanes ? steps - slow : 0));
  CHECK((fast.fast_steps() > 0) == (model.elements() >= kernels.lanes));
}

}  // namespace

TEST_CASE("beam kernels: the general stepper's results, free, pinned, clamped and driven", "[planar_beam]") {
  const planar_beam::Support free{}, pinned{true, false}, clamped{true, true},
      driven{true, true, planar_beam::Motion{-0.5, 0.2}};
  for (const Kernels* kernels : all_kernels())
    for (int elements : {1, 2, 7, 8, 9, 20, 33}) {
      INFO(kernels->lanes << " lanes, " << elements << " elements");
      compare<Turning::documented>(moving_beam(elements, free, free, 0.0), *kernels, 0.01, 40);
      compare<Turning::cayley>(moving_beam(elements, free, free, 0.1), *kernels, 0.01, 40);
      compare<Turning::documented>(moving_beam(elements, clamped, free, 0.1), *kernels, 0.01, 40);
      compare<Turning::cayley>(moving_beam(elements, free, clamped, 0.0), *kernels, 0.01, 40);
      compare<Turning::cayley>(moving_beam(elements, pinned, pinned, 0.1), *kernels, 0.01, 40);
      // A jump of the prescribed rate is a step of the general stepper; both ends in turn, and past the ramp.
      compare<Turning::documented>(moving_beam(elements, driven, free, 0.0), *kernels, 0.01, 40, 2);
      compare<Turning::cayley>(moving_beam(elements, pinned, driven, 0.0), *kernels, 0.01, 40, 2);
    }
}

TEST_CASE("beam kernels: a step back undoes a step", "[planar_beam]") {
  const LinearBeam model(spinning_beam(20, true));
  for (const Kernels* kernels : all_kernels()) {
    Fast<Turning::cayley> state(model, model.initial(), SchemeOptions{.newton_tol = 1e-12}, kernels);
    REQUIRE(state.step(model, 0.0, 0.01) == Status::ok);
    CHECK(difference(state.view(model), model.initial()) >= 1e-3);
    REQUIRE(state.step(model, 0.01, -0.01) == Status::ok);
    CHECK(state.fast_steps() == 2);
    CHECK(difference(state.view(model), model.initial()) <= 1e-11);
  }
}

TEST_CASE("beam kernels: steps that are too hard for them are the general stepper's", "[planar_beam]") {
  for (const Kernels* kernels : all_kernels()) {
    const LinearBeam model(flying_beam(10, 100.0));
    Fast<Turning::cayley> fast(model, model.initial(), SchemeOptions{}, kernels);
    General<Turning::cayley> general(model, model.initial(), SchemeOptions{});
    for (int n = 0; n < 40; ++n) {
      REQUIRE(fast.step(model, 0.25 * n, 0.25) == Status::ok);
      REQUIRE(general.step(model, 0.25 * n, 0.25) == Status::ok);
    }
    CHECK(fast.fast_steps() < 40);
    CHECK(difference(fast.view(model), general.view(model)) <= 1e-3);
    // From there on small steps are the kernels' again, after a while.
    const long before = fast.fast_steps();
    for (int n = 0; n < 100; ++n) REQUIRE(fast.step(model, 10.0 + 1e-3 * n, 1e-3) == Status::ok);
    CHECK(fast.fast_steps() - before >= 80);
  }
}

TEST_CASE("beam kernels: values that are not finite end with a status", "[planar_beam]") {
  for (double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200})
    for (const Kernels* kernels : all_kernels())
      for (int node : {0, 5, 20}) {
        const LinearBeam model(flying_beam(20, 500.0));
        auto start = model.initial();
        start.v[3 * node] = bad;
        Fast<Turning::documented> state(model, start, SchemeOptions{}, kernels);
        CHECK(state.step(model, 0.0, 0.01) == Status::newton_failed);
        CHECK(state.fast_steps() == 0);
      }
}

TEST_CASE("beam kernels: steps allocate nothing, not even where they change hands",
          "[planar_beam][allocation]") {
  for (const Kernels* kernels : all_kernels()) {
    const LinearBeam model(soft_arm(12, 0.1));
    Fast<Turning::documented> state(model, model.initial(), SchemeOptions{}, kernels);
    bool ok = true;
    CHECK(allocations_of([&] {
            for (int n = 0; n < 40; ++n) ok = ok && state.step(model, 0.01 * n, 0.01) == Status::ok;
          }) == 0);
    CHECK(ok);
    CHECK(state.fast_steps() > 0);
    CHECK(state.fast_steps() < 40);
  }
}

TEST_CASE("beam kernels: scalar ones give the paired ones' results to the last bit", "[planar_beam]") {
  for (int elements : {7, 20}) {
    LinearBeam models[] = {moving_beam(elements, {true, false}, {}, 0.1), moving_beam(elements, {}, {}, 0.0)};
    for (const LinearBeam& model : models) {
      Fast<Turning::cayley> scalar(model, model.initial(), {}, &beam::linear::scalar_kernels()),
          paired(model, model.initial(), {}, &beam::linear::paired_kernels());
      for (int n = 0; n < 50; ++n) {
        REQUIRE(scalar.step(model, 0.01 * n, 0.01) == Status::ok);
        REQUIRE(paired.step(model, 0.01 * n, 0.01) == Status::ok);
      }
      CHECK(scalar.fast_steps() == 50);
      CHECK(difference(scalar.view(model), paired.view(model)) == 0.0);
      CHECK(difference(scalar.view(model), model.initial()) >= 1e-3);
    }
  }
}

TEST_CASE("beam kernels: a scene chooses its instructions by name", "[planar_beam]") {
  using beam::linear::kernels_named;
  CHECK(kernels_named("scalar") == &beam::linear::scalar_kernels());
  CHECK(kernels_named("baseline") == &beam::linear::paired_kernels());
  CHECK(kernels_named("sse9") == nullptr);
  CHECK(&beam::linear::scalar_kernels() != &beam::linear::paired_kernels());
  for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512})
    CHECK(kernels_named(to_string(set)) == beam::linear::kernels(set));
  // Wider sets solve in another order, so a choice shows in the last digits.
  const auto last = [](const std::string& instructions) {
    SceneChanges changes;
    if (!instructions.empty()) changes.set = {"execution.instructions=\"" + instructions + "\""};
    const Scene scene = load_scene(beam_catalogue(), "flying-beam", changes);
    CHECK(scene.resolved.contains("execution") == !instructions.empty());
    const auto& model = typed<LinearBeam>(scene);
    CHECK(model.data().instructions == instructions);
    auto state = beam::BeamMidpoint::start(model, model.initial());
    for (int n = 0; n < 20; ++n)
      REQUIRE(beam::BeamMidpoint::step(model, state, 0.005 * n, 0.005) == Status::ok);
    CHECK(state.fast_steps() == 20);
    return beam::BeamMidpoint::view(model, state);
  };
  const auto scalar = last("scalar"), fitting = last("");
  CHECK(difference(scalar, last("baseline")) == 0.0);
  CHECK(difference(scalar, fitting) <= 1e-7);
  if (beam::linear::fitting_kernels(10)->lanes > 2) CHECK(difference(scalar, fitting) > 0.0);
}

TEST_CASE("beam kernels: schemes on linear elements take the kernels that fit", "[planar_beam]") {
  CHECK(beam::linear::fitting_kernels(1) == nullptr);
  CHECK(beam::linear::fitting_kernels(2) == &beam::linear::paired_kernels());
  const LinearBeam model(flying_beam(20, 500.0));
  auto state = beam::BeamMidpoint::start(model, model.initial());
  for (int n = 0; n < 10; ++n)
    REQUIRE(beam::BeamMidpoint::step(model, state, 0.005 * n, 0.005) == Status::ok);
  CHECK(state.fast_steps() == 10);
}
