// The negative control: IDA on a DAE form of index 2 has to end with a reason, not with a wrong answer.

#include <cmath>

#include "integrators/sundials/index.hpp"
#include "tests/catch.hpp"
#include "tests/sundials/systems.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/silence.hpp"

using namespace gnomon;
using namespace gnomon::test;
using gnomon::sundials::index_exceeds_one;

namespace {

/// What IDA does with the form on its own.
RunResult run_unchecked(const DaeSystem& system, const RunSpec& spec) {
  return run_adaptive(*gnomon::sundials::make_ida(system, spec, false), system, {}, spec);
}

/// 0 = a y'_1 + y_1 - y_2, 0 = b y_2 + c y_1 - sin t: index 1 where b is not 0, else 2 where c is not 0.
TestDae two_equations(double a, double b, double c, bool sparse) {
  TestDae system;
  system.initial = {0.0, 0.0};
  system.is_algebraic = {0, 1};
  system.F = [=](double t, const double* y, const double* rate, double* value) {
    value[0] = a * rate[0] + y[0] - y[1];
    value[1] = b * y[1] + c * y[0] - std::sin(t);
  };
  system.dF = [=](double, double cj, const double*, double* dense) {
    dense[0] = a * cj + 1.0, dense[1] = c, dense[2] = -1.0, dense[3] = b;
  };
  if (sparse) system.pattern = pattern_of(2, {{0, 0}, {1, 0}, {0, 1}, {1, 1}});
  return system;
}

}  // namespace

TEST_CASE("sundials: the DAE form of index 2 ends with a reason", "[sundials]") {
  const Catalogue catalogue = full_catalogue();
  REQUIRE(catalogue.scheme("ida-bdf-index2"));
  CHECK(catalogue.scheme("ida-bdf-index2")->control);
  const StderrCapture capture;
  int scenes = 0;
  for (const ShippedScene& shipped : shipped_scenes(catalogue)) {
    const Scene scene = load_scene(catalogue, shipped.name);
    if (scene.model_name != "rigid_body") continue;
    ++scenes;
    // It is not among the solvers that run unless it is asked for.
    for (const SchemeInfo* info : catalogue.schemes_for(*scene.model)) CHECK(info->name != "ida-bdf-index2");
    for (double tol : {1e-1, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-11, 1e-13}) {
      RunSpec spec;
      spec.t_end = scene.t_end;
      spec.tol = tol;
      spec.record = tol < 1e-6;
      const RunResult result = run_scheme(catalogue, "ida-bdf-index2", *scene.model, spec);
      INFO(shipped.name << ", tolerance " << tol << ": " << result.message);
      CHECK(result.status == Status::solver_failed);
      CHECK(result.message.find("index 2") != std::string::npos);
      CHECK(result.t == 0.0);
    }
  }
  CHECK(scenes >= 11);
  CHECK(capture.text() == "");
}

TEST_CASE("sundials: IDA on its own ends well on the form of index 2 and is wrong", "[sundials]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "rest-then-pushed");
  const auto& model = typed<RigidBody<SpaceMoment>>(scene);
  const auto reference = scene.model->reference({scene.t_end}).states.front();
  const auto good = erase_dae(model, model.dae());
  const auto bad = erase_dae(model, model.dae_index2());
  const auto error = [&](const DaeSystem& system, double tol) {
    RunSpec spec;
    spec.t_end = scene.t_end;
    spec.tol = tol;
    spec.max_steps = 100'000;
    const RunResult result = run_unchecked(system, spec);
    return result.status == Status::ok ? scene.model->distance(result.state, reference)[0] : NAN;
  };
  CHECK(error(*good, 1e-7) <= 100.0 * 1e-7);
  CHECK(error(*bad, 1e-7) >= 1000.0 * 1e-7);
  CHECK(error(*bad, 1e-7) >= error(*bad, 1e-6));  // a tighter tolerance makes it worse
}

TEST_CASE("sundials: the index of the forms of all models", "[sundials]") {
  const Catalogue catalogue = full_catalogue();
  int beams = 0, bodies = 0, constrained = 0;
  const auto check_beam = [&]<int p>(std::integral_constant<int, p>, const Scene& scene) {
    using Beam = planar_beam::PlanarBeam<p>;
    if (scene.model->type() != typeid(Beam)) return;
    const auto& model = typed<Beam>(scene);
    ++beams;
    CHECK(!index_exceeds_one(*erase_dae(model, model.dae())));
    if (!model.is_constrained()) return;
    ++constrained;
    CHECK(!index_exceeds_one(*erase_dae(model, model.dae_constraints())));
  };
  for (const ShippedScene& shipped : shipped_scenes(catalogue)) {
    INFO(shipped.name);
    const Scene scene = load_scene(catalogue, shipped.name);
    if (scene.model_name == "rigid_body") {
      ++bodies;
      with_rigid_body(scene, [&](const auto& model) {
        CHECK(!index_exceeds_one(*erase_dae(model, model.dae())));
        CHECK(index_exceeds_one(*erase_dae(model, model.dae_index2())));
      });
      continue;
    }
    check_beam(std::integral_constant<int, 1>{}, scene);
    check_beam(std::integral_constant<int, 2>{}, scene);
  }
  CHECK(bodies >= 11);
  CHECK(beams >= 7);
  CHECK(constrained >= 3);
}

TEST_CASE("sundials: the index of small systems", "[sundials]") {
  for (bool sparse : {false, true}) {
    // Index 0, and index 1 in whatever units.
    CHECK(!index_exceeds_one(as_dae([&] {
      TestOde ode;
      ode.initial = {1.0, 1e6};
      ode.f = [](double, const double* y, double* rate) { rate[0] = -1e9 * y[0], rate[1] = y[0]; };
      ode.df = [](double, const double*, double* dense) { dense[0] = -1e9, dense[1] = 1.0; };
      if (sparse) ode.pattern = pattern_of(2, {{0, 0}, {1, 0}, {1, 1}});
      return ode;
    }())));
    for (double unit : {1e-9, 1.0, 1e9}) {
      CHECK(!index_exceeds_one(two_equations(unit, 1.0, 0.0, sparse)));
      CHECK(!index_exceeds_one(two_equations(unit, 1.0, 1.0, sparse)));
      CHECK(!index_exceeds_one(two_equations(1.0, unit, 0.0, sparse)));
      // y_2 follows only from the derivative of the second equation.
      CHECK(index_exceeds_one(two_equations(unit, 0.0, 1.0, sparse)));
      CHECK(index_exceeds_one(two_equations(1.0, 0.0, unit, sparse)));
    }
    const RunResult refused = run_dae(two_equations(1.0, 0.0, 1.0, sparse), tolerance(1.0, 1e-6));
    CHECK(refused.status == Status::solver_failed);
    const RunResult solved = run_dae(two_equations(1.0, 1.0, 1.0, sparse), tolerance(1.0, 1e-6));
    CHECK(solved.status == Status::ok);
    // y' = sin t - 2 y
    const double exact = (2.0 * std::sin(1.0) - std::cos(1.0) + std::exp(-2.0)) / 5.0;
    CHECK(std::abs(solved.state[0] - exact) <= 1e-4);
  }
}
