#include "models/rigid_body/elliptic.hpp"

#include <cmath>
#include <limits>

#include "tests/catch.hpp"

using namespace gnomon::rigid_body;

namespace {

// Complementary moduli from the circular to the hyperbolic limit.
constexpr long double complementary_moduli[] = {1.0L,  0.999999L, 0.9L,  0.7072L, 0.7071L,
                                                0.35L, 1e-2L,     1e-6L, 1e-12L,  1e-100L};

template <class Real>
JacobiFunctions<Real> functions(Real k1) {
  return {std::sqrt((1 - k1) * (1 + k1)), k1};
}

template <class Real>
void check_half_quarter_period() {
  const Real eps = std::numeric_limits<Real>::epsilon();
  for (const long double modulus : complementary_moduli) {
    const Real k1 = static_cast<Real>(modulus);
    const auto jacobi = functions(k1);
    const Real quarter = jacobi.quarter_period();
    const auto v = jacobi.at(quarter / 2);
    INFO("k1 = " << k1);
    // DLMF table 22.5.2.
    CHECK(std::abs(v.sn * std::sqrt(1 + k1) - 1) <= 8 * eps);
    CHECK(std::abs(v.cn / std::sqrt(k1 / (1 + k1)) - 1) <= 8 * eps * (1 + quarter));
    CHECK(std::abs(v.dn / std::sqrt(k1) - 1) <= 8 * eps * (1 + quarter));
    const auto end = jacobi.at(quarter);
    CHECK(std::abs(end.sn - 1) <= 2 * eps);
    CHECK(std::abs(end.cn) <= 2 * eps * k1);
    CHECK(std::abs(end.dn / k1 - 1) <= 2 * eps);
  }
}

template <class Real>
void check_inverse() {
  const Real eps = std::numeric_limits<Real>::epsilon();
  for (const long double modulus : complementary_moduli) {
    const Real k1 = static_cast<Real>(modulus);
    const Real k = std::sqrt((1 - k1) * (1 + k1));
    const JacobiFunctions<Real> jacobi(k, k1);
    for (int i = -16; i <= 16; ++i) {
      const Real u = jacobi.quarter_period() * static_cast<Real>(i) / 16;
      const auto v = jacobi.at(u);
      INFO("k1 = " << k1 << ", u = " << u);
      CHECK(std::abs(v.sn * v.sn + v.cn * v.cn - 1) <= 8 * eps);
      CHECK(std::abs(v.dn * v.dn + k * k * v.sn * v.sn - 1) <= 8 * eps);
      CHECK(std::abs(jacobi_argument(v) - u) <= 8 * eps * (1 + std::abs(u)));
    }
  }
}

}  // namespace

TEST_CASE("exact free top: Jacobi functions at K/2 and K", "[rigid_body]") {
  check_half_quarter_period<double>();
  check_half_quarter_period<long double>();
}

TEST_CASE("exact free top: Jacobi functions satisfy their identities and invert F", "[rigid_body]") {
  check_inverse<double>();
  check_inverse<long double>();
}

TEST_CASE("exact free top: quarter periods", "[rigid_body]") {
  // Gamma(1/4)^2 / (4 sqrt(pi)) at k^2 = 1/2, and ln(4 / k1) near k = 1.
  const long double root = std::sqrt(0.5L);
  CHECK(std::abs(JacobiFunctions<long double>(root, root).quarter_period() - 1.85407467730137191843L) <
        4e-19L);
  CHECK(std::abs(JacobiFunctions<double>(0, 1).quarter_period() - std::acos(0.0)) < 1e-15);
  CHECK(std::abs(JacobiFunctions<double>(1, 1e-100).quarter_period() - std::log(4e100)) < 2e-13);
  CHECK(std::isinf(JacobiFunctions<double>(1, 0).quarter_period()));
}

TEST_CASE("exact free top: hyperbolic limit of the Jacobi functions", "[rigid_body]") {
  const JacobiFunctions<double> jacobi(1, 0);
  for (const double u : {-30.0, -1.0, 0.0, 0.3, 5.0, 1e4}) {
    const auto v = jacobi.at(u);
    CHECK(std::abs(v.sn - std::tanh(u)) <= 1e-15);
    CHECK(std::abs(v.cn - 1 / std::cosh(u)) <= 1e-15 / std::cosh(u));
    CHECK(v.dn == v.cn);
  }
}

TEST_CASE("exact free top: third integral against quadrature", "[rigid_body]") {
  // Composite Simpson rule for the integral of sn^2 / (1 + r^2 sn^2).
  for (const double k1 : {0.95, 0.3, 1e-3}) {
    const auto jacobi = functions(k1);
    for (const double r2 : {1e-3, 0.7, 20.0}) {
      const double u = 0.8 * jacobi.quarter_period();
      const auto integrand = [&](double x) {
        const double s = jacobi.at(x).sn;
        return s * s / (1 + r2 * s * s);
      };
      const int n = 2000;
      double sum = integrand(0) + integrand(u);
      for (int i = 1; i < n; ++i) sum += (i % 2 == 0 ? 2 : 4) * integrand(u * i / n);
      const auto v = jacobi.at(u);
      const double exact = static_cast<double>(elliptic_j(v, std::sqrt(1 + r2)));
      CHECK(std::abs(sum * u / (3 * n) - exact) < 1e-11 * exact);
      CHECK(std::abs(sum * u / (3 * n) - elliptic_j(v, std::sqrt(1 + 1.0001 * r2))) > 1e-8 * exact);
    }
  }
}
