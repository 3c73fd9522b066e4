#pragma once
#include "integrators/rotation/quaternion_velocity.hpp"

namespace gnomon::rotation {

/// The predictor-corrector direct multiplication method: with w' = I^-1 (tau - w x I w) at time t, the
/// velocities w + (h/4) w' and w + (h/2) w' of the first quarter and the middle. The first turns the body to
/// a predicted middle, where the second, taken from the body there to space, gives the turn of the whole step
/// and w' the new velocity. Two moments a step: at time t and at the predicted middle.
struct ZhaoVanWachem : CarriesVelocity<2, 2> {
  static constexpr SchemeInfo info{
      .name = "zhao-van-wachem",
      .family = "rotation",
      .summary = "predictor-corrector direct multiplication of quaternions",
      .citation = "F. Zhao, B.G.M. van Wachem, Acta Mech. 224 (2013) 3091-3109",
      .form = "rotation",
      .stages = 2,
      .orders = {{{"none", 2}, {"gravity", 2}, {"space_moment", 2}, {"body_moment", 2}}},
  };

  template <RotationForm M>
  static Status step(const M& model, QuaternionAndVelocity& state, double t, double h) {
    const Vector3 w = state.velocity, rate = rate_of(model, t, state.orientation, w);
    const Quaternion quarter = exponential(0.5 * h * (w + 0.25 * h * rate));
    const Vector3 middle = w + 0.5 * h * rate;
    state.velocity += h * rate_of(model, t + 0.5 * h, state.orientation * quarter, middle);
    state.orientation = state.orientation * exponential(h * (quarter * middle));
    normalize(state.orientation);
    return Status::ok;
  }

 private:
  template <RotationForm M>
  static Vector3 rate_of(const M& model, double t, const Quaternion& q, const Vector3& w) {
    Vector3 tau = Vector3::Zero();
    if constexpr (M::has_moment) {
      const Matrix3 attitude = q.toRotationMatrix();
      tau = attitude.transpose() * model.moment(t, attitude);
    }
    return euler_rate(model.inertia(), tau, w);
  }
};

}  // namespace gnomon::rotation
