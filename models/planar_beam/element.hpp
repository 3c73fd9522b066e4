#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <numbers>

namespace gnomon::planar_beam {

/// Gauss-Legendre points in (0, 1), ascending, and weights of sum 1.
template <int count>
struct GaussRule {
  std::array<double, count> at, weight;

  GaussRule() {
    for (int i = 0; i < count; ++i) {
      double x = std::cos(std::numbers::pi * (count - i - 0.25) / (count + 0.5)), slope = 1.0;
      for (int iteration = 0; iteration < 6; ++iteration) {
        double before = 1.0, value = x;
        for (int k = 2; k <= count; ++k) {
          const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
          before = value;
          value = next;
        }
        slope = count * (before - x * value) / (1.0 - x * x);
        x -= value / slope;
      }
      at[i] = 0.5 * (1.0 + x);
      weight[i] = 1.0 / ((1.0 - x * x) * slope * slope);
    }
  }
};

/// What the beam answers at an integration point: the resultants in the fixed frame (t1, t2) [N], the bending
/// moment [N m], and the couple N2 g1 - N1 g2 [N] that the force resultants exert through the strained
/// centreline.
struct PointForce {
  double t1, t2, moment, couple;
};

/// The derivatives of a PointForce: of (t1, t2) by the two slopes (a11 .. a22) and by the rotation (t1r,
/// t2r), of the couple by the slopes (c1, c2) and the rotation (cr), of the moment by the slope of the
/// rotation (mk) and by the rotation (mr). All others vanish.
struct PointTangent {
  double a11, a12, a21, a22, t1r, t2r, c1, c2, cr, mk, mr;
};

/// A Lagrange element of order p with equispaced nodes: p Gauss points for the stiffness, which avoids
/// locking, and p + 1 for mass, loads and norms. Three unknowns a node.
template <int p>
struct Element {
  static constexpr int nodes = p + 1, points = p, mass_points = p + 1, unknowns = 3 * nodes;
  using Matrix = Eigen::Matrix<double, unknowns, unknowns>;

  explicit Element(double element_length) : length(element_length) {
    const GaussRule<points> rule;
    const GaussRule<mass_points> mass_rule;
    for (int g = 0; g < points; ++g) {
      at[g] = rule.at[g];
      weight[g] = rule.weight[g] * length;
      for (int a = 0; a < nodes; ++a) {
        shape[g][a] = lagrange(a, rule.at[g]);
        slope[g][a] = lagrange_slope(a, rule.at[g]) / length;
      }
    }
    mass = {};
    load = {};
    for (int g = 0; g < mass_points; ++g)
      for (int a = 0; a < nodes; ++a) {
        const double value = mass_rule.weight[g] * length * lagrange(a, mass_rule.at[g]);
        load[a] += value;
        for (int b = 0; b < nodes; ++b) mass[a][b] += value * lagrange(b, mass_rule.at[g]);
      }
  }

  /// Adds the internal force of point g to the force of the element: int [T P', T P', M P' + couple P].
  void add_force(int g, const PointForce& f, double* force) const {
    const double w = weight[g];
    for (int a = 0; a < nodes; ++a) {
      const double ws = w * slope[g][a];
      force[3 * a] += ws * f.t1;
      force[3 * a + 1] += ws * f.t2;
      force[3 * a + 2] += ws * f.moment + w * shape[g][a] * f.couple;
    }
  }
  /// Adds its derivative by the element's nodal values.
  void add_tangent(int g, const PointTangent& d, Matrix& matrix) const {
    const double w = weight[g];
    for (int b = 0; b < nodes; ++b) {
      const double s = w * slope[g][b], n = w * shape[g][b];
      for (int a = 0; a < nodes; ++a) {
        const double ss = slope[g][a] * s, sn = slope[g][a] * n, ns = shape[g][a] * s;
        matrix(3 * a, 3 * b) += d.a11 * ss;
        matrix(3 * a, 3 * b + 1) += d.a12 * ss;
        matrix(3 * a, 3 * b + 2) += d.t1r * sn;
        matrix(3 * a + 1, 3 * b) += d.a21 * ss;
        matrix(3 * a + 1, 3 * b + 1) += d.a22 * ss;
        matrix(3 * a + 1, 3 * b + 2) += d.t2r * sn;
        matrix(3 * a + 2, 3 * b) += d.c1 * ns;
        matrix(3 * a + 2, 3 * b + 1) += d.c2 * ns;
        matrix(3 * a + 2, 3 * b + 2) += d.mk * ss + d.mr * sn + d.cr * shape[g][a] * n;
      }
    }
  }

  double length;                                        ///< m
  std::array<double, points> at, weight;                ///< stiffness points: place in (0, 1), weight [m]
  std::array<std::array<double, nodes>, points> shape;  ///< P_a at the stiffness points
  std::array<std::array<double, nodes>, points> slope;  ///< dP_a/dx at the stiffness points, 1/m
  std::array<std::array<double, nodes>, nodes> mass;    ///< int P_a P_b dx, m
  std::array<double, nodes> load;                       ///< int P_a dx, m

 private:
  static double lagrange(int a, double x) {
    double value = 1.0;
    for (int b = 0; b < nodes; ++b)
      if (b != a) value *= (p * x - b) / (a - b);
    return value;
  }
  static double lagrange_slope(int a, double x) {
    double sum = 0.0;
    for (int c = 0; c < nodes; ++c) {
      if (c == a) continue;
      double value = static_cast<double>(p) / (a - c);
      for (int b = 0; b < nodes; ++b)
        if (b != a && b != c) value *= (p * x - b) / (a - b);
      sum += value;
    }
    return sum;
  }
};

}  // namespace gnomon::planar_beam
