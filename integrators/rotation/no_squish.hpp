#pragma once
#include <array>

#include "integrators/rotation/turn_step.hpp"

namespace gnomon::rotation {

/// T = sum m_k^2/(2 I_k) split into its three terms: under each alone the body turns about its axis k at the
/// constant rate m_k/I_k. Taken in the order 3, 2, 1, 2, 3 for h/2, h/2, h, h/2, h/2.
struct SingleAxisTurns {
  static constexpr int rates = 5;
  static Quaternion turn(const Vector3& inertia, const Vector3& m, const Vector3& tau, double h) {
    Vector3 momentum = m + 0.5 * h * tau;
    Quaternion q = Quaternion::Identity();
    for (const int axis : {2, 1}) about(axis, 0.5 * h / inertia[axis], momentum, q);
    about(0, h / inertia[0], momentum, q);
    for (const int axis : {1, 2}) about(axis, 0.5 * h / inertia[axis], momentum, q);
    return q;
  }

 private:
  /// Turns by the angle m_k times `factor`.
  static void about(int k, double factor, Vector3& m, Quaternion& q) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const double half = 0.5 * factor * m[k], square = half * half;
    const Sinc values = sinc(square);
    const double s = half * values.sine, c = 1.0 - square * values.versine;
    const double sine = 2.0 * s * c, versine = 2.0 * s * s, mi = m[i], mj = m[j];
    m[i] += sine * mj - versine * mi;
    m[j] -= sine * mi + versine * mj;
    const double w = q.w();
    const Vector3 v = q.vec();
    q.w() = c * w - s * v[k];
    q.vec()[k] = c * v[k] + s * w;
    q.vec()[i] = c * v[i] + s * v[j];
    q.vec()[j] = c * v[j] - s * v[i];
  }
};

/// The quaternion form of the paper carries the four momenta conjugate to q; with them replaced by m it is
/// this one.
struct NoSquish : TurnStep<SingleAxisTurns> {
  static constexpr SchemeInfo info{
      .name = "no-squish",
      .family = "rotation",
      .summary = "symplectic splitting into turns about the principal axes, between half kicks",
      .citation =
          "T.F. Miller et al., J. Chem. Phys. 116 (2002) 8649-8659; A. Dullweber, B. Leimkuhler, "
          "R. McLachlan, J. Chem. Phys. 107 (1997) 5840-5851",
      .form = "rotation",
      .stages = 5,
      .orders = {{{"none", 2}, {"gravity", 2}, {"space_moment", 2}, {"body_moment", 2}}},
      .reversible = true,
      .conserves_momentum = true,
  };
};

}  // namespace gnomon::rotation
