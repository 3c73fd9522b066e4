#include "src/study/static_refine.hpp"

#include <algorithm>
#include <atomic>
#include <sstream>

#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;

namespace {

StaticRefinement static_study(const StaticRefinePlan& plan) {
  const Catalogue catalogue = full_catalogue();
  ReferenceStore references("");
  const std::atomic<bool> stop{false};
  Runner runner(catalogue, references, stop);
  std::ostringstream log;
  output::Progress progress(0, output::ProgressMode::silent, log);
  return refine_static(runner, plan, progress);
}

/// A part of the published study.
StaticRefinePlan published(const std::string& label) {
  for (const StaticRefinePlan& plan : read_study(GNOMON_SOURCE_DIR "/models/planar_beam/study.toml").refine)
    if (plan.label == label) return plan;
  throw std::logic_error("no such part");
}

}  // namespace

TEST_CASE("static refinement: the tip of the elastica is of order 2 p", "[study]") {
  StaticRefinePlan plan = published("elastica");
  const StaticRefinement study = static_study(plan);
  REQUIRE(study.orders.size() == 4);
  for (std::size_t row = 0; row < 4; ++row) {
    INFO("p = " << row + 1 << ": " << study.orders[row].verdict);
    REQUIRE(study.orders[row].observed);
    // That of order 8 is at roundoff before the slopes have come to rest.
    const double expected = 2.0 * static_cast<double>(row + 1);
    CHECK(*study.orders[row].observed >= 0.99 * expected);
    CHECK(*study.orders[row].observed <= (row < 3 ? 1.01 : 1.08) * expected);
    if (row < 3) CHECK(study.orders[row].finding == OrderFinding::as_declared);
  }
  for (const double bound : study.bounds) CHECK(bound <= 1e-14);
  const output::Table table = static_refine_table(study);
  REQUIRE(table.rows.size() == 5);
  CHECK(table.columns.back().heading == "order");
  CHECK(table.rows[1].front().text == "1");
  // Another order is not taken for the declared one.
  plan.orders = {1, 3, 5, 7};
  for (const ObservedOrder& order : static_study(plan).orders) CHECK(order.finding == OrderFinding::differs);
}

TEST_CASE("static refinement: the error of the tip does not grow with EA L^2/EI", "[study]") {
  StaticRefinePlan plan = published("locking");
  const StaticRefinement study = static_study(plan);
  CHECK(study.plan.columns.numbers().value().front() == 1e2);
  CHECK(study.plan.columns.numbers().value().back() == 1e8);
  const double expected[] = {4.5e-4, 2.6e-5, 4.1e-7, 3.1e-8};
  for (std::size_t row = 0; row < 4; ++row)
    for (const StaticError& each : study.errors[row]) {
      REQUIRE(each.error);
      INFO("p = " << row + 1 << ": " << *each.error);
      CHECK(std::abs(*each.error / *study.errors[row].front().error - 1.0) <= 1e-3);
      CHECK(std::abs(*each.error / expected[row] - 1.0) <= 0.1);
      CHECK_FALSE(each.below_bound);
    }
  CHECK(study.orders.empty());
  // A coarser mesh has another error.
  plan.row_set.front() = "beam.elements=8";
  CHECK(*static_study(plan).errors[0][0].error >= 3.0 * *study.errors[0][0].error);
}

TEST_CASE("static refinement: what has no equilibrium is an entry without error", "[study]") {
  StaticRefinePlan plan = published("locking");
  plan.columns = {"load", {}};
  plan.scene = "shallow-arch";
  plan.columns.key = "beam.elements";
  plan.columns.values = {"8"};
  plan.row_set.clear();
  plan.reference = {"beam.elements=12"};
  plan.coarser = {"beam.elements=10"};
  plan.rows = {"beam.order", {"2"}};
  const StaticRefinement study = static_study(plan);  // load control ends at the limit point
  REQUIRE(study.errors.size() == 1);
  CHECK_FALSE(study.errors[0][0].error);
  CHECK(study.errors[0][0].status == Status::newton_failed);
  CHECK(static_refine_table(study).rows.back().back().raw.empty());
}
