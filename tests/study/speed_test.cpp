#include "src/study/speed.hpp"

#include "tests/catch.hpp"

using namespace gnomon;

TEST_CASE("speed: parts of different kinds stand in tables of their own, variants by sizes", "[study]") {
  const PartTask tasks[] = {{"m", "Time of a", "solver", "one", "elements", 20, 0, nullptr},
                            {"m", "Time of a", "solver", "one", "elements", 200, 0, nullptr},
                            {"m", "Time of a", "solver", "two", "elements", 20, 1, nullptr},
                            {"m", "Time of b", "method", "three", "nodes", 5, 2, nullptr}};
  SpeedStudy study;
  for (const PartTask& task : tasks)
    study.parts.push_back({&task, summarise({1e-6, 1e-6, 1e-6, 1e-6, 1e-6})});
  const std::vector<output::Table> tables = parts_tables(study);
  REQUIRE(tables.size() == 2);
  CHECK(tables[0].caption == "Time of a, by solver");
  REQUIRE(tables[0].columns.size() == 3);
  CHECK(tables[0].columns[2].heading == "200 elements [us]");
  REQUIRE(tables[0].rows.size() == 2);
  CHECK(tables[0].rows[0].size() == 3);
  CHECK(tables[0].rows[1].size() == 2);
  CHECK(tables[0].rows[1][1].text == "1.00");
  CHECK(tables[1].caption == "Time of b, by method");
  CHECK(tables[1].rows.size() == 1);
}
