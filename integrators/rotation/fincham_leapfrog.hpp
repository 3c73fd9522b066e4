#pragma once
#include "integrators/rotation/turn_step.hpp"

namespace gnomon::rotation {

/// Two steps of q' = q o (0, w)/2: to the middle with w = I^-1 A^T H(t), from there over the whole step with
/// w = I^-1 A^T H(t + h/2), A being that of the middle; q is normalised after each.
struct FinchamTurn {
  static constexpr int rates = 2;
  static Quaternion turn(const Vector3& inertia, const Vector3& m, const Vector3& tau, double h) {
    const Quaternion middle = cayley(0.25 * h * m.cwiseQuotient(inertia));
    const Vector3 m_half = middle.conjugate() * Vector3(m + 0.5 * h * tau);
    Quaternion rate;  // (0, w)/2
    rate.w() = 0.0;
    rate.vec() = 0.5 * m_half.cwiseQuotient(inertia);
    return unit_along(Quaternion::Identity().coeffs() + h * (middle * rate).coeffs());
  }
};

struct FinchamLeapfrog : TurnStep<FinchamTurn> {
  static constexpr SchemeInfo info{
      .name = "fincham-leapfrog",
      .family = "rotation",
      .summary = "explicit quaternion leapfrog of discrete-element codes; output synchronous",
      .citation = "D. Fincham, Mol. Simul. 8 (1992) 165-178, the explicit method",
      .form = "rotation",
      .stages = 2,
      .orders = {{{"none", 2}, {"gravity", 2}, {"space_moment", 2}, {"body_moment", 2}}},
      .conserves_momentum = true,
  };
};

}  // namespace gnomon::rotation
