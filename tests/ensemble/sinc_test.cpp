// The sine and cosine that the kernels use, and what depends on them.

#include <cmath>

#include "integrators/ensemble/rotation.hpp"
#include "tests/catch.hpp"

using namespace gnomon;

namespace {

struct ExactSinc {
  long double sine, versine;
};

// By their power series in extended precision: to 1e-19 up to 4 rad.
ExactSinc series_sinc(double square) {
  long double sine = 1, versine = 0.5L, term = 1;
  for (int k = 1; k < 30; ++k) {
    term *= -static_cast<long double>(square) / ((2 * k) * (2 * k + 1));
    sine += term;
    versine += term / (2 * k + 2);
  }
  return {sine, versine};
}

double relative_error(double value, long double exact) {
  return static_cast<double>(std::abs(value - exact) / std::abs(exact));
}

}  // namespace

TEST_CASE("ensemble: sine and cosine are exact to rounding up to the limit and beyond", "[ensemble]") {
  double sine = 0.0, versine = 0.0, sine_beyond = 0.0, versine_beyond = 0.0;
  const int count = 200'000;
  for (int k = 0; k <= count; ++k) {
    const double square = sinc_limit * k / count;
    const auto found = ensemble::sinc(square);
    const ExactSinc exact = series_sinc(square);
    sine = std::max(sine, relative_error(found.sine, exact.sine));
    versine = std::max(versine, relative_error(found.versine, exact.versine));
  }
  for (int k = 1; k <= 2000; ++k) {
    const double square = sinc_limit + 7.0 * k / 2000;
    const auto found = ensemble::sinc(square);
    const ExactSinc exact = series_sinc(square);
    sine_beyond = std::max(sine_beyond, static_cast<double>(std::abs(found.sine - exact.sine)));
    versine_beyond = std::max(versine_beyond, static_cast<double>(std::abs(found.versine - exact.versine)));
  }
  INFO(sine << ' ' << versine << ' ' << sine_beyond << ' ' << versine_beyond);
  const double ulp = 0x1p-52;
  CHECK(sine <= 1.2 * ulp);
  CHECK(versine <= 1.2 * ulp);
  CHECK(sine_beyond <= 1.5 * ulp);
  CHECK(versine_beyond <= 1.5 * ulp);
  CHECK(ensemble::sinc(0.0).sine == 1.0);
  CHECK(ensemble::sinc(0.0).versine == 0.5);
}

TEST_CASE("ensemble: lanes work as single numbers do", "[ensemble]") {
  using ensemble::Lanes;
  constexpr std::size_t n = Lanes::size;
  alignas(64) double squares[n], sine[n], versine[n];
  for (std::size_t k = 0; k < n; ++k) squares[k] = 1.5 * static_cast<double>(k) / static_cast<double>(n);
  const auto found = ensemble::sinc(Lanes::load(squares));
  found.sine.store(sine);
  found.versine.store(versine);
  for (std::size_t k = 0; k < n; ++k) {
    CHECK(sine[k] == ensemble::sinc(squares[k]).sine);
    CHECK(versine[k] == ensemble::sinc(squares[k]).versine);
    alignas(64) double wrong[n] = {};
    CHECK(!any(beyond(Lanes::load(wrong), 1.0)));
    wrong[k] = std::nan("");
    CHECK(any(beyond(Lanes::load(wrong), 1.0)));
    wrong[k] = 1.0000001;
    CHECK(any(beyond(Lanes::load(wrong), 1.0)));
  }
}
