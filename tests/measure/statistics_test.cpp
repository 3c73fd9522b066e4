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

TEST_CASE("measure: the Theil-Sen slope ignores an outlier") {
  const std::vector<double> x{0.0, 1.0, 2.0, 3.0, 4.0, 4.0}, y{1.0, 3.0, 5.0, 100.0, 9.0, 9.0};
  CHECK(std::abs(gnomon::theil_sen_slope(x, y) - 2.0) <= 1e-15);
  const std::vector<double> same{1.0, 1.0}, values{1.0, 2.0};
  CHECK(std::isnan(gnomon::theil_sen_slope(same, values)));
}
