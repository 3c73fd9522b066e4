// Below a tolerance of about 1e-8 IDA's steps on the DAE form of index 2 fall
// below the rounding of t: it goes on counting steps at one and the same time
// until the limit of steps or of time ends the run. A run that no longer
// advances has to end as such.

#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;

TEST_CASE("sundials: a solver that no longer advances is stopped", "[sundials]") {
  const Catalogue catalogue = full_catalogue();
  const Scene scene = load_scene(catalogue, "asymmetric-heavy-top");
  for (bool record : {true, false}) {
    RunSpec spec;
    spec.t_end = scene.t_end;
    spec.tol = 1e-9;
    spec.record = record;
    spec.max_steps = 200'000;
    const RunResult result = run_scheme(catalogue, "ida-bdf-index2", *scene.model, spec);
    INFO(to_string(result.status) << " at " << result.t << " after " << result.cost.steps
                                  << " steps: " << result.message);
    CHECK(result.status == Status::solver_failed);
    CHECK(result.cost.steps <= 20'000);
  }
}
