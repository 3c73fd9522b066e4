#include "src/study/refine.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <sstream>

#include "src/error.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

Refinement study(const RefinePlan& plan, const StudyOptions& options) {
  const Catalogue catalogue = full_catalogue();
  ReferenceStore references("");
  const std::atomic<bool> stop{false};
  Runner runner(catalogue, references, stop);
  std::ostringstream log;
  output::Progress progress(0, output::ProgressMode::silent, log);
  Refinement result = refine(runner, plan, options, progress);
  result.scheme = nullptr;  // the catalogue ends here
  return result;
}

std::string refusal(const RefinePlan& plan, const StudyOptions& options) {
  try {
    study(plan, options);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "nothing";
}

}  // namespace

TEST_CASE("refine: the displacement of a smooth motion converges with order p + 1", "[study][long]") {
  StudyOptions options;
  options.watch = 1;
  for (int p : {1, 2}) {
    RefinePlan plan{"curved-free", {0.5, {fmt::format("beam.order={}", p)}}, "beam.elements", {2, 4, 8, 16}};
    if (p == 1) plan.values.push_back(32);
    options.tols = {p == 1 ? 1e-6 : 1e-7};
    const Refinement result = study(plan, options);
    REQUIRE(result.meshes.size() == plan.values.size());
    REQUIRE(result.orders.size() == 4);
    const ObservedOrder& order = result.orders.front().order;
    INFO("p = " << p << ": " << order.verdict);
    REQUIRE(order.observed);
    CHECK(std::abs(*order.observed - (p + 1)) <= 0.1);
    CHECK(order.points >= 4);
    for (std::size_t k = 0; k < result.meshes.size(); ++k) {
      const Row& row = result.meshes[k].rows.front();
      CHECK(row.error[0] > result.meshes[k].reference.bounds[0][0]);
      CHECK(result.time_errors[k][0] < 0.1 * row.error[0]);
    }
  }
}

TEST_CASE("refine: a run that fails on one mesh is a row without error", "[study]") {
  StudyOptions options;
  options.watch = 1;
  options.integrators = {"cvode-bdf"};
  options.max_steps = 3;
  const Refinement result = study({"curved-free", {0.1, {}}, "beam.elements", {4, 8}}, options);
  REQUIRE(result.meshes.size() == 2);
  CHECK(!result.message.empty());
  CHECK(result.orders.empty());
  CHECK(result.meshes[0].rows.front().error.empty());
  CHECK(result.meshes[0].rows.front().result.status == Status::step_limit);
}

TEST_CASE("refine: what cannot be refined is refused", "[study]") {
  StudyOptions options;
  const RefinePlan good{"curved-free", {}, "beam.elements", {4, 8}};
  RefinePlan plan = good;
  plan.scene = "asymmetric-free-top";
  plan.key = "t_end";
  CHECK(refusal(plan, options) ==
        "--refine: found scene 'asymmetric-free-top' of model rigid_body, expected a model with a mesh");
  // Numbers that change the motion and not its mesh, and the order of the elements.
  for (const char* key : {"beam.EI", "beam.length", "beam.order", "t_end", "beam.elemnts"}) {
    plan = good;
    plan.key = key;
    CHECK(refusal(plan, options) == std::string("--refine: found the key '") + key +
                                        "', expected one that makes the mesh finer: beam.elements");
  }
  plan = good;
  plan.values = {4, 300'000};
  CHECK(
      refusal(plan, options)
          .starts_with("--refine: found beam.elements = 300000, expected one of which 4 times as much can be "
                       "made to compare with (--set beam.elements=1200000: beam.elements: found 1200000, "));
  plan = good;
  plan.values = {4.5, 8};
  CHECK(refusal(plan, options).find("beam.elements: found 4.5, expected") != std::string::npos);
  options.integrators = {"cvode-bdf", "ida-bdf"};
  CHECK(refusal(good, options) == "--integrators: found 2 names, expected one with --refine");
  options.integrators = {"beam-midpoint"};
  CHECK(refusal(good, options) ==
        "--steps: found 0 values, expected one with --refine because beam-midpoint takes equal steps");
  options.integrators = {};
  options.tols = {1e-6, 1e-8};
  CHECK(refusal(good, options) ==
        "--tols: found 2 values, expected one with --refine because cvode-bdf chooses its own steps");
}
