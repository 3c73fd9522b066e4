// A solver that cannot be made ends in an exception, prints nothing and leaves nothing behind, which only the
// address sanitizer sees.

#include <stdexcept>

#include "tests/catch.hpp"
#include "tests/sundials/systems.hpp"
#include "tests/support/silence.hpp"

using namespace gnomon;
using namespace gnomon::test;

TEST_CASE("sundials: a table that does not exist is an error", "[sundials]") {
  const StderrCapture capture;
  TestOde system;
  system.initial = {1.0};
  system.f = [](double, const double* y, double* rate) { rate[0] = -y[0]; };
  const RunSpec spec = tolerance(1.0, 1e-6);
  for (int table : {-1, 99, 1000})
    CHECK_THROWS_AS(gnomon::sundials::make_arkode(system, spec, table), std::runtime_error);
  for (int table : {int(ARKODE_DORMAND_PRINCE_7_4_5), int(ARKODE_KVAERNO_7_4_5)})
    CHECK_NOTHROW(gnomon::sundials::make_arkode(system, spec, table));
  CHECK(capture.text() == "");
}
