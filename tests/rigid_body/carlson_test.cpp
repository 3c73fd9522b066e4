#include "models/rigid_body/carlson.hpp"

#include <boost/math/special_functions/ellint_rj.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "tests/catch.hpp"

using gnomon::rigid_body::carlson_rc;
using gnomon::rigid_body::carlson_rj;

TEST_CASE("elliptic: Carlson's integral of the third kind in double precision", "[rigid_body]") {
  // DLMF and B.C. Carlson, Numer. Algorithms 10 (1995) 13-26, section 3.
  CHECK(std::abs(carlson_rj(0.0, 1.0, 2.0, 3.0) / 0.77688623778582332014190282640545 - 1.0) <= 1e-15);
  CHECK(std::abs(carlson_rj(2.0, 3.0, 4.0, 5.0) / 0.14297579667156753833233879421985 - 1.0) <= 1e-15);
  // The arguments that the heavy top asks for, also beside the limits.
  std::mt19937_64 random(5);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  double worst = 0.0;
  for (int k = 0; k < 20'000; ++k) {
    const double sn2 = uniform(), m = k % 3 == 0 ? 1.0 - std::pow(10.0, -14.0 * uniform()) : uniform();
    const double x = k % 11 == 0 ? 0.0 : 1.0 - sn2, y = 1.0 - m * (1.0 - x);
    if (x == 0.0 && y == 0.0) continue;
    const double p = k % 2 ? std::pow(10.0, -20.0 * uniform()) : uniform() + 1e-3;
    const long double exact = boost::math::ellint_rj<long double>(x, y, 1.0L, p);
    const double error = std::abs(static_cast<double>(carlson_rj(x, y, 1.0, p) / exact - 1.0L));
    INFO(x << " " << y << " " << p);
    CHECK(error <= 4e-15);
    worst = std::max(worst, error);
  }
  CHECK(worst >= 1e-16);
}

TEST_CASE("elliptic: Carlson's integral of the third kind ends for any arguments", "[rigid_body]") {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::nan("");
  CHECK(carlson_rj(0.0, 0.0, 1.0, 0.0) == infinity);
  CHECK(carlson_rj(0.0, 0.0, 1.0, 1.0) == infinity);
  CHECK(carlson_rj(0.5, 0.7, 1.0, 0.0) == infinity);
  CHECK(std::isnan(carlson_rj(0.5, 0.7, 1.0, nan)));
  CHECK(std::isnan(carlson_rj(0.5, infinity, 1.0, 1.0)));
  const double edges[] = {0.0, 4e-324, 1e-308, 1e-160, 1.0, 1e160, 1e307};
  for (double x : edges)
    for (double y : edges)
      for (double z : edges)
        for (double p : edges) {
          INFO(x << " " << y << " " << z << " " << p);
          CHECK(!(carlson_rj(x, y, z, p) < 0.0));
        }
  // Homogeneous of degree -3/2, exactly so for powers of 4.
  for (int k : {-300, -20, 20, 200})
    CHECK(std::ldexp(carlson_rj(std::ldexp(2.0, 2 * k), std::ldexp(3.0, 2 * k), std::ldexp(4.0, 2 * k),
                                std::ldexp(5.0, 2 * k)),
                     3 * k) == carlson_rj(2.0, 3.0, 4.0, 5.0));
}

TEST_CASE("elliptic: Carlson's degenerate integral is smooth at its series' edge", "[rigid_body]") {
  for (double e : {-0.01, 0.01, 0.0, 1e-300, -0.5, 3.0, 1e6, -0.0099})
    for (double at : {e * (1.0 - 1e-9), e, e * (1.0 + 1e-9)}) {
      const long double root = std::sqrt(std::abs(static_cast<long double>(at)));
      const long double exact = at == 0.0 ? 1.0L : (at > 0.0 ? std::atan(root) : std::atanh(root)) / root;
      CHECK(std::abs(static_cast<double>(carlson_rc(at, 1.0 + at) / exact - 1.0L)) <= 1e-15);
    }
}
