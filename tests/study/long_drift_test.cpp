// Runs of any number of steps hold as much memory as short ones.
#include <cmath>

#include "src/study/study.hpp"
#include "tests/catch.hpp"
#include "tests/support/allocations.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

struct LongRun {
  long allocations;
  std::size_t looked_at, kept, thinned;
  DriftVerdict energy;
};

LongRun long_run(const Catalogue& catalogue, const char* scheme, long steps, int samples = 0) {
  const double step = 0.02, t_end = step * static_cast<double>(steps);
  const Scene scene = load_scene(catalogue, "asymmetric-free-top", {t_end, {}});
  RunSpec spec;
  spec.t_end = t_end;
  spec.step = step;
  spec.watch = 2048;
  spec.samples = samples;
  LongRun run{};
  RunResult result;
  std::vector<InvariantSummary> invariants;
  run.allocations = allocations_of([&] { result = run_scheme(catalogue, scheme, *scene.model, spec); });
  REQUIRE(result.status == Status::ok);
  REQUIRE(result.cost.steps == steps);
  invariants = summarise_invariants(*scene.model, result.invariants);
  run.looked_at = result.invariants.t.size();
  run.kept = result.samples.size();
  for (InvariantSummary& invariant : invariants) {
    if (invariant.info.name != "energy") continue;
    run.energy = invariant.measured.verdict;
    thin(invariant);
    run.thinned = invariant.times.size();
  }
  return run;
}

}  // namespace

TEST_CASE("study: what a drift run holds does not depend on the number of its steps", "[study][long]") {
  const Catalogue catalogue = full_catalogue();
  for (const char* scheme : {"munjiza", "rkmk4"}) {
    const LongRun few = long_run(catalogue, scheme, 10'000), many = long_run(catalogue, scheme, 1'000'000);
    INFO(scheme << ": " << few.allocations << " and " << many.allocations << " allocations");
    CHECK(few.looked_at <= 2049);
    CHECK(few.looked_at >= 1500);  // two of the jittered times may share a step
    CHECK(many.looked_at == 2049);
    // A dozen a decade of the time.
    CHECK(many.thinned <= few.thinned + 24);
    CHECK(many.allocations <= 2 * few.allocations);
    CHECK(many.energy == DriftVerdict::secular);
    CHECK(long_run(catalogue, scheme, 10'000, 5'000).allocations >= 2 * few.allocations);  // which are kept
    CHECK(long_run(catalogue, scheme, 10'000, 5'000).kept == 5'001);
  }
}
