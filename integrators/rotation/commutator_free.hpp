#pragma once
#include "integrators/rotation/explicit_lie.hpp"

namespace gnomon::rotation {

/// The commutator-free method of order 4 on the weights of the classical Runge-Kutta method: five
/// exponentials, one of them used twice. H by the classical method.
struct CommutatorFree4 : ExplicitLie<4, 4> {
  static constexpr SchemeInfo info{
      .name = "cf4",
      .family = "rotation",
      .summary = "commutator-free Lie group method of order 4",
      .citation = "E. Celledoni, A. Marthinsen, B. Owren, Future Gener. Comput. Syst. 19 (2003) 341-352",
      .form = "rotation",
      .stages = 4,
      .orders = {{{"none", 4}, {"gravity", 4}, {"space_moment", 4}, {"body_moment", 4}}},
      .conserves_momentum = true,
  };

  template <RotationForm M>
  [[gnu::noinline]] static Status step(const M& model, Pose& pose, double t, double h) {
    const Vector3& H = pose.momentum;
    const auto k1 = rates(model, pose, t, Quaternion::Identity(), H);
    const Quaternion q2 = exponential(0.5 * h * k1.velocity);
    const auto k2 = rates(model, pose, t + 0.5 * h, q2, H + 0.5 * h * k1.moment);
    const Quaternion q3 = exponential(0.5 * h * k2.velocity);
    const auto k3 = rates(model, pose, t + 0.5 * h, q3, H + 0.5 * h * k2.moment);
    const Quaternion q4 = q2 * exponential(h * (k3.velocity - 0.5 * k1.velocity));
    const auto k4 = rates(model, pose, t + h, q4, H + h * k3.moment);
    const Vector3 middle = 2.0 * (k2.velocity + k3.velocity);
    const Quaternion by = exponential(h / 12.0 * (3.0 * k1.velocity + middle - k4.velocity)) *
                          exponential(h / 12.0 * (middle + 3.0 * k4.velocity - k1.velocity));
    pose.momentum += h / 6.0 * (k1.moment + 2.0 * (k2.moment + k3.moment) + k4.moment);
    pose.turn(by);
    return Status::ok;
  }
};

}  // namespace gnomon::rotation
