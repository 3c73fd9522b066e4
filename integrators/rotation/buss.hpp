#pragma once
#include "integrators/rotation/turn_step.hpp"

namespace gnomon::rotation {

/// The turn exp(h W), W = w + (h/2) w', and augmented by (h^2/12) w' x w, with w' = I^-1 (tau + m x w); w and
/// w' are those of time t. The augmentation is the commutator term of the exponent; the term (h^2/6) w'' that
/// order 3 needs as well is missing. The paper treats free bodies; here H gets the trapezoidal impulse.
template <bool augmented>
struct BussTurn {
  static constexpr int rates = 1;
  static Quaternion turn(const Vector3& inertia, const Vector3& m, const Vector3& tau, double h) {
    const Vector3 w = m.cwiseQuotient(inertia), rate = (tau + m.cross(w)).cwiseQuotient(inertia);
    Vector3 mean = w + 0.5 * h * rate;
    if constexpr (augmented) mean += (h * h / 12.0) * rate.cross(w);
    return exponential(h * mean);
  }
};

struct Buss : TurnStep<BussTurn<false>> {
  static constexpr SchemeInfo info{
      .name = "buss",
      .family = "rotation",
      .summary = "second-order Taylor method: one turn by the mean angular velocity",
      .citation = "S.R. Buss, J. Comput. Phys. 164 (2000) 377-406, the second-order method",
      .form = "rotation",
      .stages = 1,
      .orders = {{{"none", 2}, {"gravity", 2}, {"space_moment", 2}, {"body_moment", 2}}},
      .conserves_momentum = true,
  };
};

struct BussAugmented : TurnStep<BussTurn<true>> {
  static constexpr SchemeInfo info{
      .name = "buss-augmented",
      .family = "rotation",
      .summary = "the same with the commutator term in the exponent",
      .citation = "S.R. Buss, J. Comput. Phys. 164 (2000) 377-406, the augmented second-order method",
      .form = "rotation",
      .stages = 1,
      .orders = {{{"none", 2}, {"gravity", 2}, {"space_moment", 2}, {"body_moment", 2}}},
      .conserves_momentum = true,
  };
};

}  // namespace gnomon::rotation
