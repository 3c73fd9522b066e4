// A body that spins about a principal axis is a linear problem. Newton's iteration then converges at once,
// and ARKODE takes its last rate of convergence, by now nearly zero, for granted: where the step changes by
// less than 20 % it keeps the matrix of the old step, accepts the first iterate and misses the stage
// equations by far more than the tolerance. The last step, cut at t_end, is such a one.

#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;

TEST_CASE("sundials: a linear problem is solved to tolerance", "[sundials]") {
  const Catalogue catalogue = full_catalogue();
  const BodyState spinning{Eigen::Matrix3d::Identity(), {0.0, 0.0, 2.0}};
  const auto body = box(RigidBody<Free>({1.0, 2.0, 3.0}, spinning, {}, 10.0));
  for (const SchemeInfo& solver : solvers(catalogue, *body)) {
    for (double tol : {1e-6, 1e-8, 1e-10}) {
      double worst = 0.0;
      for (int k = 0; k < 40; ++k) {
        RunSpec spec;
        spec.t_end = 2.0 + 0.2 * k;
        spec.tol = tol;
        spec.record = false;
        const RunResult result = run_scheme(catalogue, solver.name, *body, spec);
        REQUIRE(result.status == Status::ok);
        const ReferenceStates reference = body->reference({spec.t_end});
        worst = std::max(worst, body->distance(result.state, reference.states.front())[0]);
      }
      INFO(solver.name << ", tolerance " << tol << ": error / tolerance " << worst / tol);
      CHECK(worst <= 500.0 * tol);
    }
  }
}
