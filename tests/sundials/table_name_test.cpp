// A solver that cannot be made ends in an exception and leaves nothing behind, which only the address
// sanitizer sees.

#include <stdexcept>

#include "tests/catch.hpp"
#include "tests/sundials/systems.hpp"
#include "tests/support/silence.hpp"

using namespace gnomon;
using namespace gnomon::test;

TEST_CASE("sundials: a table that does not exist is an error", "[sundials]") {
  const StderrCapture capture;  // of what ARKODE itself prints before anything can stop it
  TestOde system;
  system.initial = {1.0};
  system.f = [](double, const double* y, double* rate) { rate[0] = -y[0]; };
  const RunSpec spec = tolerance(1.0, 1e-6);
  CHECK_THROWS_AS(gnomon::sundials::make_arkode(system, spec, false, "ARKODE_NO_SUCH_TABLE"),
                  std::runtime_error);
  CHECK_THROWS_AS(gnomon::sundials::make_arkode(system, spec, true, "ARKODE_NO_SUCH_TABLE"),
                  std::runtime_error);
  // An implicit table is none of the explicit stepper's, and the other way round.
  CHECK_THROWS_AS(gnomon::sundials::make_arkode(system, spec, false, "ARKODE_KVAERNO_7_4_5"),
                  std::runtime_error);
  CHECK_THROWS_AS(gnomon::sundials::make_arkode(system, spec, true, "ARKODE_DORMAND_PRINCE_7_4_5"),
                  std::runtime_error);
  CHECK_NOTHROW(gnomon::sundials::make_arkode(system, spec, false, "ARKODE_DORMAND_PRINCE_7_4_5"));
  CHECK_NOTHROW(gnomon::sundials::make_arkode(system, spec, true, "ARKODE_KVAERNO_7_4_5"));
}
