#include "src/output/table.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>

#include "tests/catch.hpp"

using namespace gnomon::output;

namespace {

const double infinity = std::numeric_limits<double>::infinity();
const double not_a_number = std::numeric_limits<double>::quiet_NaN();

Table small_table() {
  Table table;
  table.caption = "Errors at t = 10 s";
  table.columns = {{"integrator", "integrator", Align::left},
                   {"error_rad", "error [rad]", Align::right},
                   {"status", "status", Align::centre}};
  table.rows = {{"munjiza", number_cell(1.23456e-5), "ok"},
                {"rkmk4", at_most_cell(3e-15), "ok"},
                {"a|b", number_cell(not_a_number), "—, \"failed\""}};
  table.notes = {"≤ stands for errors not above the reference's bound."};
  return table;
}

}  // namespace

TEST_CASE("output: numbers keep their significant digits") {
  CHECK(number(1.23456e-5) == "1.23e-05");
  CHECK(number(1.2e-5) == "1.20e-05");
  CHECK(number(0.001234) == "0.00123");
  CHECK(number(100.0) == "100");
  CHECK(number(99.96) == "100");
  CHECK(number(999.6) == "1.00e+03");
  CHECK(number(0.00012344) == "0.000123");
  CHECK(number(-123456.0) == "-1.23e+05");
  CHECK(number(1e-5, 1) == "1e-05");
  CHECK(number(2.5, 2) == "2.5");
  CHECK(number(0.0) == "0");
  CHECK(number(-0.0) == "0");
  CHECK(number(not_a_number) == "—");
  CHECK(number(infinity) == "—");
}

TEST_CASE("output: engineering format has exponents that are multiples of three") {
  CHECK(engineering(1.234e-5) == "12.3e-6");
  CHECK(engineering(0.5) == "500e-3");
  CHECK(engineering(42.0) == "42.0");
  CHECK(engineering(1.0) == "1.00");
  CHECK(engineering(999.4) == "999");
  CHECK(engineering(999.6) == "1.00e3");  // rounding carries into the next group
  CHECK(engineering(-0.0009996) == "-1.00e-3");
  CHECK(engineering(-0.00099949) == "-999e-6");
  CHECK(engineering(123456.0, 2) == "120e3");
  CHECK(engineering(12.0, 1) == "10");
  CHECK(engineering(0.0) == "0");
  CHECK(engineering(-infinity) == "—");
}

TEST_CASE("output: engineering format of random values reads back to the rounded value") {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> exponent(-30.0, 30.0);
  for (int i = 0; i < 2000; ++i) {
    const double value = std::pow(10.0, exponent(generator));
    const double read = std::strtod(engineering(value, 4).c_str(), nullptr);
    CAPTURE(value, engineering(value, 4));
    REQUIRE(std::abs(read / value - 1.0) <= 5.001e-4);
  }
}

TEST_CASE("output: a printed bound is never below the bound") {
  CHECK(at_most(3e-15) == "≤ 3e-15");
  CHECK(at_most(3.2e-15) == "≤ 4e-15");
  CHECK(at_most(3.8e-15) == "≤ 4e-15");
  CHECK(at_most(9.4e-15) == "≤ 1e-14");
  CHECK(at_most(3.21e-15, 2) == "≤ 3.3e-15");
  CHECK(at_most(0.0) == "≤ 0");
  CHECK(at_most(not_a_number) == "—");
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> exponent(-20.0, 3.0);
  for (int i = 0; i < 2000; ++i) {
    const double bound = std::pow(10.0, exponent(generator));
    const double read = std::strtod(at_most(bound, 2).c_str() + std::string("≤ ").size(), nullptr);
    CAPTURE(bound, at_most(bound, 2));
    REQUIRE(read >= bound);
    REQUIRE(read <= 1.1001 * bound);
  }
}

TEST_CASE("output: exact text recovers the double") {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> exponent(-300.0, 300.0);
  for (int i = 0; i < 2000; ++i) {
    const double value = std::pow(10.0, exponent(generator));
    REQUIRE(std::strtod(exact(value).c_str(), nullptr) == value);
  }
  CHECK(exact(0.1) == "0.10000000000000001");
  CHECK(exact(not_a_number).empty());
  CHECK(exact(infinity).empty());
}

TEST_CASE("output: cells carry what is shown and what is exact") {
  CHECK(Cell().text == "—");
  CHECK(Cell().raw.empty());
  CHECK(number_cell(0.1).text == "0.100");
  CHECK(number_cell(0.1).raw == "0.10000000000000001");
  CHECK(number_cell(not_a_number).text == "—");
  CHECK(number_cell(not_a_number).raw.empty());
  CHECK(engineering_cell(1.5e-5).text == "15.0e-6");
  CHECK(count_cell(-9007199254740993LL).raw == "-9007199254740993");
  CHECK(at_most_cell(3.2e-15).raw == exact(3.2e-15));
}

TEST_CASE("output: Markdown is aligned in its source and escapes pipes") {
  CHECK(to_markdown(small_table()) ==
        "**Errors at t = 10 s**\n"
        "\n"
        "| integrator | error [rad] |   status    |\n"
        "| :--------- | ----------: | :---------: |\n"
        "| munjiza    |    1.23e-05 |     ok      |\n"
        "| rkmk4      |     ≤ 3e-15 |     ok      |\n"
        "| a\\|b       |           — | —, \"failed\" |\n"
        "\n"
        "- ≤ stands for errors not above the reference's bound.\n");
  Table lines = small_table();
  lines.rows = {{"two\nlines", "x", "y"}};
  CHECK(to_markdown(lines).find("| two lines  |") != std::string::npos);
}

TEST_CASE("output: terminal text is aligned without markup") {
  CHECK(to_text(small_table()) ==
        "Errors at t = 10 s\n"
        "\n"
        "integrator  error [rad]    status\n"
        "----------  -----------  -----------\n"
        "munjiza        1.23e-05      ok\n"
        "rkmk4           ≤ 3e-15      ok\n"
        "a|b                   —  —, \"failed\"\n"
        "\n"
        "- ≤ stands for errors not above the reference's bound.\n");
}

TEST_CASE("output: CSV quotes as RFC 4180 and leaves missing values empty") {
  Table table = small_table();
  table.rows.push_back({"line\nend", number_cell(-0.5), Cell()});
  CHECK(to_csv(table) ==
        "integrator,error_rad,status\n"
        "munjiza,1.2345599999999999e-05,ok\n"
        "rkmk4,2.9999999999999998e-15,ok\n"
        "a|b,,\"—, \"\"failed\"\"\"\n"
        "\"line\nend\",-0.5,\n");
}

TEST_CASE("output: a table without rows has its headings") {
  Table table = small_table();
  table.caption.clear();
  table.rows.clear();
  table.notes.clear();
  CHECK(to_csv(table) == "integrator,error_rad,status\n");
  CHECK(to_markdown(table) ==
        "| integrator | error [rad] | status |\n| :--------- | ----------: | :----: |\n");
}

TEST_CASE("output: a row of the wrong length is refused") {
  Table table = small_table();
  CHECK_NOTHROW(to_csv(table));
  table.rows.push_back({"too", "short"});
  CHECK_THROWS_AS(to_csv(table), std::invalid_argument);
  CHECK_THROWS_AS(to_markdown(table), std::invalid_argument);
  CHECK_THROWS_AS(to_text(table), std::invalid_argument);
}
