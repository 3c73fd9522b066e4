#include "src/measure/statistics.hpp"

#include <cmath>

#include "tests/catch.hpp"

using gnomon::median;
using gnomon::quantile;

TEST_CASE("measure: median and quantiles of small sets") {
  CHECK(median({3.0, 1.0, 2.0}) == 2.0);
  CHECK(median({4.0, 1.0, 2.0, 3.0}) == 2.5);
  CHECK(median({7.0}) == 7.0);
  CHECK(std::isnan(median({})));
  CHECK(quantile({5.0, 1.0, 2.0, 4.0, 3.0}, 0.25) == 2.0);
  CHECK(quantile({5.0, 1.0, 2.0, 4.0, 3.0}, 0.0) == 1.0);
  CHECK(quantile({5.0, 1.0, 2.0, 4.0, 3.0}, 1.0) == 5.0);
  CHECK(std::abs(quantile({0.0, 10.0}, 0.99) - 9.9) <= 1e-14);
}
