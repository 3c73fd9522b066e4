#pragma once
// Coefficients of the Gauss-Legendre collocation methods, computed in the working precision.

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace gnomon::generic {

/// Gauss collocation method with `stages` stages and order 2 `stages` (Hairer, Norsett & Wanner I, II.7).
/// Matrices are stored by rows.
template <class Real>
struct GaussTableau {
  int stages = 0;
  std::vector<Real> c;            ///< nodes in (0, 1), ascending
  std::vector<Real> b;            ///< weights
  std::vector<Real> a;            ///< a_ij, integral of the j-th Lagrange polynomial from 0 to c_i
  std::vector<Real> extrapolate;  ///< value of the j-th Lagrange polynomial at 1 + c_i, the next step's node
};

namespace detail {

/// Legendre polynomials P_0(x) .. P_count(x), by their three-term recurrence.
template <class Real>
void legendre(Real x, int count, Real* p) {
  p[0] = 1;
  if (count > 0) p[1] = x;
  for (int k = 1; k < count; ++k) p[k + 1] = (Real(2 * k + 1) * x * p[k] - Real(k) * p[k - 1]) / Real(k + 1);
}

}  // namespace detail

/// Coefficients for `stages` in 1..32; an empty tableau (stages = 0) otherwise. The nodes are the roots of
/// the Legendre polynomial, by Newton's method. The Lagrange polynomials are written in Legendre polynomials,
/// l_j(x) = b_j sum_{k<s} (2k+1) P_k(x_j) P_k(x) with x in [-1, 1], whose integrals are known: this is well
/// conditioned.
template <class Real>
GaussTableau<Real> gauss_tableau(int stages) {
  using std::abs;
  GaussTableau<Real> g;
  if (stages < 1 || stages > 32) return g;
  g.stages = stages;
  const auto s = static_cast<std::size_t>(stages);
  g.c.resize(s);
  g.b.resize(s);
  g.a.resize(s * s);
  g.extrapolate.resize(s * s);
  std::vector<Real> x(s), p(s + 1), q(s + 1), values(s * (s + 1));

  // Roots and weights for x >= 0, mirrored so that the method is symmetric to the last bit.
  for (std::size_t i = 0; i < (s + 1) / 2; ++i) {
    Real root(std::cos(3.14159265358979324 * (static_cast<double>(i) + 0.75) / (stages + 0.5)));
    if (2 * i + 1 == s) root = 0;
    Real slope = 1;
    for (int iteration = 0; iteration < 20; ++iteration) {
      detail::legendre(root, stages, p.data());
      slope = Real(stages) * (root * p[s] - p[s - 1]) / (root * root - Real(1));
      const Real change = p[s] / slope;
      if (2 * i + 1 != s) root -= change;
      if (abs(change) <= std::numeric_limits<Real>::epsilon()) break;
    }
    detail::legendre(root, stages, p.data());
    slope = Real(stages) * (root * p[s] - p[s - 1]) / (root * root - Real(1));
    x[s - 1 - i] = root;
    x[i] = -root;
    g.b[i] = g.b[s - 1 - i] = Real(1) / ((Real(1) - root * root) * slope * slope);
    g.c[i] = (Real(1) - root) / Real(2);
    g.c[s - 1 - i] = (Real(1) + root) / Real(2);
  }

  for (std::size_t j = 0; j < s; ++j) detail::legendre(x[j], stages, values.data() + j * (s + 1));
  for (std::size_t i = 0; i < s; ++i) {
    detail::legendre(x[i], stages, p.data());
    detail::legendre(x[i] + Real(2), stages, q.data());
    for (std::size_t j = 0; j < s; ++j) {
      const Real* pj = values.data() + j * (s + 1);
      Real integral = g.c[i];  // of P_0 over [0, c_i]
      Real beyond = 1;
      for (std::size_t k = 1; k < s; ++k) {
        integral += pj[k] * (p[k + 1] - p[k - 1]) / Real(2);
        beyond += Real(2 * static_cast<int>(k) + 1) * pj[k] * q[k];
      }
      g.a[i * s + j] = g.b[j] * integral;
      g.extrapolate[i * s + j] = g.b[j] * beyond;
    }
  }
  return g;
}

}  // namespace gnomon::generic
