#pragma once
#include "integrators/rotation/explicit_lie.hpp"

namespace gnomon::rotation {

/// Steps 1-7 of Munjiza's scheme (munjiza.hpp) with a unit quaternion in the place of the triad: the stage
/// attitudes are q o d_s with d_s = exp(p_s), and w_s = d_s I^-1 d_s^-1 (y + h tau) in the triad of time t, y
/// = A^T H. The moment is frozen, its full impulse in stages 2 to 4. The map is that of `munjiza`.
struct JohnsonWilliamsCook : ExplicitLie<4, 1> {
  static constexpr SchemeInfo info{
      .name = "johnson-williams-cook",
      .family = "rotation",
      .summary = "the documented RK4 rotation scheme with a quaternion in the place of the triad",
      .citation = "S.M. Johnson, J.R. Williams, B.K. Cook, Int. J. Numer. Meth. Engng 74 (2008) 1303-1313",
      .form = "rotation",
      .stages = 4,
      .orders = {{{"none", 2}, {"gravity", 1}, {"space_moment", 1}, {"body_moment", 1}}},
      .conserves_momentum = true,
  };

  template <RotationForm M>
  static Status step(const M& model, Pose& pose, double t, double h) {
    const Vector3 inertia = model.inertia();
    const Vector3 before = pose.body_momentum();
    Vector3 after = before;
    if constexpr (M::has_moment) {
      pose.momentum += h * model.moment(t, pose.attitude);
      after = pose.body_momentum();
    }
    pose.turn(turn(inertia, before, after, h));
    return Status::ok;
  }

 private:
  static Quaternion turn(const Vector3& inertia, const Vector3& before, const Vector3& after, double h) {
    const auto velocity = [&](const Vector3& p) -> Vector3 {
      const Quaternion d = exponential(p);
      return d * Vector3((d.conjugate() * after).cwiseQuotient(inertia));
    };
    const Vector3 w1 = before.cwiseQuotient(inertia);
    const Vector3 w2 = velocity(0.5 * h * w1), w3 = velocity(0.5 * h * w2), w4 = velocity(h * w3);
    return exponential((h / 6.0) * (w1 + 2.0 * (w2 + w3) + w4));
  }
};

}  // namespace gnomon::rotation
