#pragma once
#include "integrators/rotation/turn_step.hpp"

namespace gnomon::rotation {

/// q' = q o (0, w)/2 by one Euler step and by two of half the size, H(t + h/2) held and q normalised after
/// each, then Richardson's extrapolation 2 q_two - q_one, normalised.
struct RichardsonTurn {
  static constexpr int rates = 2;
  static Quaternion turn(const Vector3& inertia, const Vector3& m, const Vector3& tau, double h) {
    const Vector3 m_half = m + 0.5 * h * tau;
    const Vector3 w = m_half.cwiseQuotient(inertia);
    const Quaternion one = cayley(0.5 * h * w), half = cayley(0.25 * h * w);
    const Vector3 w_half = (half.conjugate() * m_half).cwiseQuotient(inertia);
    const Quaternion two = half * cayley(0.25 * h * w_half);
    return unit_along(2.0 * two.coeffs() - one.coeffs());
  }
};

struct Richardson : TurnStep<RichardsonTurn> {
  static constexpr SchemeInfo info{
      .name = "richardson",
      .family = "rotation",
      .summary = "half kicks and an extrapolated Euler step of the quaternion, as in LAMMPS",
      .citation =
          "A.P. Thompson et al., Comput. Phys. Commun. 271 (2022) 108171: LAMMPS, fix nve/asphere and "
          "MathExtra::richardson",
      .form = "rotation",
      .stages = 2,
      .orders = {{{"none", 2}, {"gravity", 2}, {"space_moment", 2}, {"body_moment", 2}}},
      .conserves_momentum = true,
  };
};

}  // namespace gnomon::rotation
