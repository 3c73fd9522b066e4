#pragma once
#include "integrators/rotation/explicit_lie.hpp"

namespace gnomon::rotation {

/// The Crouch-Grossman method of order 3: every stage and the step itself are products of exponentials of the
/// velocities of the stages, the first stage's first. H by the same coefficients.
struct CrouchGrossman3 : ExplicitLie<3, 3> {
  static constexpr SchemeInfo info{
      .name = "crouch-grossman3",
      .family = "rotation",
      .summary = "Crouch-Grossman method of order 3: products of exponentials",
      .citation =
          "P.E. Crouch, R. Grossman, J. Nonlinear Sci. 3 (1993) 1-33; coefficients in E. Hairer, C. Lubich, "
          "G. Wanner, Geometric Numerical Integration, 2nd ed., Springer 2006, section IV.8.1",
      .form = "rotation",
      .stages = 3,
      .orders = {{{"none", 3}, {"gravity", 3}, {"space_moment", 3}, {"body_moment", 3}}},
      .conserves_momentum = true,
  };

  template <RotationForm M>
  [[gnu::noinline]] static Status step(const M& model, Pose& pose, double t, double h) {
    constexpr double a21 = 3.0 / 4, a31 = 119.0 / 216, a32 = 17.0 / 108;
    constexpr double b1 = 13.0 / 51, b2 = -2.0 / 3, b3 = 24.0 / 17;
    const Vector3& H = pose.momentum;
    const auto k1 = rates(model, pose, t, Quaternion::Identity(), H);
    const Quaternion q2 = exponential(a21 * h * k1.velocity);
    const auto k2 = rates(model, pose, t + a21 * h, q2, H + a21 * h * k1.moment);
    const Quaternion q3 = exponential(a31 * h * k1.velocity) * exponential(a32 * h * k2.velocity);
    const auto k3 = rates(model, pose, t + (a31 + a32) * h, q3, H + h * (a31 * k1.moment + a32 * k2.moment));
    const Quaternion by = exponential(b1 * h * k1.velocity) * exponential(b2 * h * k2.velocity) *
                          exponential(b3 * h * k3.velocity);
    pose.momentum += h * (b1 * k1.moment + b2 * k2.moment + b3 * k3.moment);
    pose.turn(by);
    return Status::ok;
  }
};

}  // namespace gnomon::rotation
