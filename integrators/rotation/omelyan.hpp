#pragma once
#include "integrators/rotation/gyroscopic.hpp"
#include "integrators/rotation/velocity_leapfrog.hpp"

namespace gnomon::rotation {

/// I (w' - w) = h (tau + (I w x w + I w' x w')/2), solved for w' by Newton's method to rounding (the paper
/// iterates a few times), and the turn ((1 - a), (h/2) w)/(1 + a), a = h^2 |w|^2/16: the Cayley map of (h/2)
/// w, squared.
struct OmelyanLeap {
  static constexpr int rates = 0;  // as many as iterations

  static Status kick(const Vector3& inertia, const Vector3& tau, double h, Vector3& w, long& iterations) {
    const Vector3 m = inertia.cwiseProduct(w);
    const Vector3 known = m + h * tau + 0.5 * h * m.cross(w);
    return solve_gyroscopic(inertia, known, h, w, iterations);
  }
  static Quaternion turn(const Vector3& w, double h) {
    const double a = h * h * w.squaredNorm() / 16.0;
    Quaternion q;
    q.w() = (1.0 - a) / (1.0 + a);
    q.vec() = (0.5 * h / (1.0 + a)) * w;
    return q;
  }
};

/// The paper's w(t) is the mean of w(t - h/2) and w(t + h/2); that of the output here differs from it by
/// O(h^3) and needs no moment of the next step.
struct Omelyan : VelocityLeapfrog<OmelyanLeap> {
  static constexpr SchemeInfo info{
      .name = "omelyan",
      .family = "rotation",
      .summary = "implicit leapfrog of the principal angular velocities, Cayley turns; output synchronous",
      .citation = "I.P. Omelyan, Phys. Rev. E 58 (1998) 1169-1172; Comput. Phys. Commun. 109 (1998) 171-183",
      .form = "rotation",
      .orders = {{{"none", 2}, {"gravity", 2}, {"space_moment", 2}, {"body_moment", 2}}},
      .reversible = true,
  };
};

}  // namespace gnomon::rotation
