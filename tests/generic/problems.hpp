#pragma once
// Initial value problems with known solutions, for the tests of the generic integrators.

#include <cmath>
#include <vector>

namespace gnomon::generic::test {

/// More evaluations than any test needs.
constexpr long many = 10'000'000;

/// Planar Kepler problem with unit gravitational parameter, from the pericentre (1, 0) with speed v:
/// eccentricity v^2 - 1, 0.301 for the default. State (x, y, vx, vy). Every binary format holds the data
/// exactly.
template <class Real>
struct Kepler {
  Real v = Real(1.140625);

  void operator()(Real, const Real* y, Real* dydt) const {
    const Real r2 = y[0] * y[0] + y[1] * y[1];
    const Real r3 = r2 * std::sqrt(r2);
    dydt[0] = y[2];
    dydt[1] = y[3];
    dydt[2] = -y[0] / r3;
    dydt[3] = -y[1] / r3;
  }
  std::vector<Real> initial() const { return {1, 0, 0, v}; }

  /// Position at time t, in long double, by Newton's method on Kepler's equation.
  std::vector<long double> position(long double t) const {
    const long double speed = v;
    const long double ecc = speed * speed - 1, axis = 1 / (1 - ecc);
    const long double mean = t * (1 - ecc) * std::sqrt(1 - ecc);
    long double anomaly = mean;
    for (int i = 0; i < 60; ++i)
      anomaly -= (anomaly - ecc * std::sin(anomaly) - mean) / (1 - ecc * std::cos(anomaly));
    return {axis * (std::cos(anomaly) - ecc), axis * std::sqrt(1 - ecc * ecc) * std::sin(anomaly)};
  }
};

/// Distance of the first components of `y` from `exact`.
template <class Real>
long double distance(const std::vector<Real>& y, const std::vector<long double>& exact) {
  long double sum = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const long double d = static_cast<long double>(y[i]) - exact[i];
    sum += d * d;
  }
  return std::sqrt(sum);
}

/// x'' = -x, from (1, 0): (cos t, -sin t).
template <class Real>
struct Oscillator {
  void operator()(Real, const Real* y, Real* dydt) const {
    dydt[0] = y[1];
    dydt[1] = -y[0];
  }
  std::vector<Real> initial() const { return {1, 0}; }
  std::vector<long double> exact(long double t) const { return {std::cos(t), -std::sin(t)}; }
};

/// y' = M y with eigenvalues -fast and growth, coupled by a rotation by 45 degrees; from (1, 0):
/// y = (e^(growth t) + e^(-fast t), e^(growth t) - e^(-fast t)) / 2.
template <class Real>
struct StiffPair {
  Real fast = 100, growth = 1;
  void operator()(Real, const Real* y, Real* dydt) const {
    const Real slow = (y[0] + y[1]) / 2 * growth;
    const Real quick = (y[0] - y[1]) / 2 * -fast;
    dydt[0] = slow + quick;
    dydt[1] = slow - quick;
  }
  std::vector<Real> initial() const { return {1, 0}; }
  std::vector<long double> exact(long double t) const {
    const long double slow = std::exp(growth * t) / 2, quick = std::exp(-fast * t) / 2;
    return {slow + quick, slow - quick};
  }
};

/// Lorenz's equations with sigma = 10, rho = 28 and beta = 2.625, which every binary format holds exactly.
template <class Real>
struct Lorenz {
  void operator()(Real, const Real* y, Real* dydt) const {
    dydt[0] = 10 * (y[1] - y[0]);
    dydt[1] = y[0] * (28 - y[2]) - y[1];
    dydt[2] = y[0] * y[1] - Real(2.625) * y[2];
  }
  std::vector<Real> initial() const { return {1, 1, 1}; }
};

}  // namespace gnomon::generic::test
