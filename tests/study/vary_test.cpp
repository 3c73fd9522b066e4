#include <algorithm>
#include <atomic>
#include <sstream>

#include "src/study/vary_output.hpp"
#include "src/study/vary_study.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

using namespace gnomon;
using namespace gnomon::test;

TEST_CASE("vary: a scheme that goes to a motion of its own has the cost of the error it ends at", "[study]") {
  const Catalogue catalogue = full_catalogue();
  ReferenceStore references("");
  const std::atomic<bool> stop{false};
  Runner runner(catalogue, references, stop);
  std::ostringstream log;
  output::Progress progress(0, output::ProgressMode::silent, log);
  VaryPlan plan;
  plan.scene = "stiff-cantilever";
  plan.variation = {"beam.EA,beam.GA", {"1e2", "2e2"}};
  plan.steps = {0.01, 0.005, 0.002, 0.001};
  plan.integrators = {"beam-verlet", "beam-verlet-consistent"};
  StudyOptions options;
  options.timing = false;
  options.watch = 1;
  const VariedStudy study = vary(runner, plan, options, progress);
  const output::Table table = varied_costs_table(study.comparisons, study.variation);
  std::vector<std::vector<output::Cell>> lumped, consistent;
  for (const auto& row : table.rows) (row[0].text == "beam-verlet" ? lumped : consistent).push_back(row);
  REQUIRE(lumped.size() == 1);
  REQUIRE(consistent.size() == 3);
  const double level = std::stod(lumped[0][1].raw);
  double largest = 0.0;
  for (const Comparison& variant : study.comparisons)
    for (const Row& row : variant.rows)
      if (row.scheme->name == "beam-verlet" && row.setting.step == 0.001)
        largest = std::max(largest, row.error.at(0));
  CHECK(level >= largest);
  CHECK(level <= 1.1 * largest);
  CHECK(std::abs(level - 0.016) <= 1e-9);
  for (const std::size_t column : {3U, 5U}) CHECK_FALSE(lumped[0][column].raw.empty());
  const auto about = [](const std::string& note) { return note.starts_with("beam-verlet ("); };
  CHECK(std::ranges::count_if(table.notes, about) == 1);
  CHECK(std::ranges::find_if(table.notes, about)->find("however small the steps") != std::string::npos);
}
