// CVODE with GMRES in the place of the beam's own elimination, which preconditions it.
#include <algorithm>
#include <cmath>

#include "integrators/beam/large_meshes.hpp"
#include "tests/planar_beam/beams.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;

TEST_CASE("sundials: GMRES runs where a form eliminates its own systems, and nowhere else", "[sundials]") {
  const Catalogue& catalogue = beam_catalogue();
  CHECK(catalogue.pair("cvode-bdf-gmres", *load_scene(catalogue, "soft-beam").model));
  CHECK(catalogue.pair("cvode-bdf-gmres", *load_scene(catalogue, "flying-beam").model));
  CHECK_FALSE(catalogue.pair("cvode-bdf-gmres", *load_scene(catalogue, "asymmetric-free-top").model));
  CHECK(catalogue.pair("cvode-bdf", *load_scene(catalogue, "asymmetric-free-top").model));
}

TEST_CASE("sundials: GMRES gives the direct solver's motion from fewer linearisations than steps",
          "[sundials][planar_beam]") {
  const auto runs = [](const auto& model, double t_end, double tol) {
    RunSpec spec;
    spec.t_end = t_end;
    spec.tol = tol;
    spec.record = false;
    const RunResult direct = run_beam("cvode-bdf", model, spec);
    const RunResult krylov = run_beam("cvode-bdf-gmres", model, spec);
    REQUIRE(direct.status == Status::ok);
    REQUIRE(krylov.status == Status::ok);
    const auto error = model.distance(model.restore(krylov.state), model.restore(direct.state));
    CHECK(error[0] > 0.0);
    CHECK(error[0] <= 1e2 * tol * model.data().length);
    // The product with the Jacobian costs an evaluation of the rates for each of GMRES's iterations.
    CHECK(2 * krylov.cost.rhs > 3 * krylov.cost.newton_iterations);
    CHECK(2 * direct.cost.rhs < 3 * direct.cost.newton_iterations);
    CHECK(krylov.cost.rhs <= 6 * krylov.cost.steps);
    CHECK(krylov.cost.jacobians > 0);
    CHECK(krylov.cost.jacobians <= krylov.cost.factorizations);
    CHECK(2 * krylov.cost.factorizations <= krylov.cost.steps);
    CHECK(2 * krylov.cost.steps <= 3 * direct.cost.steps);
  };
  runs(PlanarBeam<2>(soft_beam(4)), 1.0, 1e-6);
  runs(PlanarBeam<1>(flying_beam(200, 500.0)), 0.1, 1e-4);
  runs(PlanarBeam<3>(soft_arm(3, 0.4)), 1.0, 1e-6);  // begins anew at jumps
}

TEST_CASE("sundials: the solvers of large meshes are timed", "[sundials][planar_beam]") {
  const std::vector<PartTask> tasks = beam::large_mesh_tasks();
  REQUIRE(tasks.size() == 4);
  for (const PartTask& task : tasks) {
    CHECK(task.full_only);
    CHECK(task.run(task.index, 8) > 0.0);
  }
}
