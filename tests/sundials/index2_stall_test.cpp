// Without the check of the index IDA's steps on the DAE form of index 2 fall below the rounding of t for
// tolerances below about 1e-8: it goes on counting steps at one and the same time until the limit of steps or
// of time ends the run. A run that no longer advances has to end as such.

#include "tests/catch.hpp"
#include "tests/sundials/systems.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;

TEST_CASE("sundials: a solver that no longer advances is stopped", "[sundials]") {
  const Scene scene = load_scene(full_catalogue(), "asymmetric-heavy-top");
  const auto& model = typed<RigidBody<Gravity>>(scene);
  const auto system = erase_dae(model, model.dae_index2());
  for (bool record : {true, false}) {
    RunSpec spec;
    spec.t_end = scene.t_end;
    spec.tol = 1e-9;
    spec.record = record;
    spec.max_steps = 200'000;
    const RunResult result =
        run_adaptive(*gnomon::sundials::make_ida(*system, spec, false), *system, {}, spec);
    INFO(to_string(result.status) << " at " << result.t << " after " << result.cost.steps
                                  << " steps: " << result.message);
    CHECK(result.status == Status::solver_failed);
    CHECK(result.cost.steps <= 20'000);
  }
}
