#pragma once
#include "integrators/rotation/pose.hpp"

namespace gnomon::rotation {

/// The predictor-corrector direct multiplication method: with w' = I^-1 (tau - w x I w) at time t, the
/// velocities w + (h/4) w' and w + (h/2) w' of the first quarter and the middle. The first turns the body to
/// a predicted middle, where the second, taken from the body there to space, gives the turn of the whole step
/// and w' the new velocity. Two moments a step: at time t and at the predicted middle.
struct ZhaoVanWachem {
  static constexpr SchemeInfo info{
      .name = "zhao-van-wachem",
      .family = "rotation",
      .summary = "predictor-corrector direct multiplication of quaternions",
      .citation = "F. Zhao, B.G.M. van Wachem, Acta Mech. 224 (2013) 3091-3109",
      .form = "rotation",
      .stages = 2,
      .orders = {{{"none", 2}, {"gravity", 2}, {"space_moment", 2}, {"body_moment", 2}}},
  };
  struct QuaternionAndVelocity {
    Quaternion orientation;  ///< body -> space, unit
    Vector3 velocity;        ///< w, body components, rad/s
  };
  template <RotationForm M>
  using State = QuaternionAndVelocity;

  template <RotationForm M>
  static QuaternionAndVelocity start(const M& model, const typename M::State& state) {
    return {Quaternion(Matrix3(state.attitude)).normalized(),
            state.angular_momentum.cwiseQuotient(Vector3(model.inertia()))};
  }
  template <RotationForm M>
  static typename M::State view(const M& model, const QuaternionAndVelocity& state) {
    return {state.orientation.toRotationMatrix(), state.velocity.cwiseProduct(Vector3(model.inertia()))};
  }
  template <RotationForm M>
  static Cost cost(const M&, const QuaternionAndVelocity&, long steps) {
    Cost cost;
    cost.steps = steps;
    cost.rhs = 2 * steps;
    if constexpr (M::has_moment) cost.moments = 2 * steps;
    return cost;
  }

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
    const Vector3 inertia = model.inertia();
    Vector3 torque = inertia.cwiseProduct(w).cross(w);
    if constexpr (M::has_moment) {
      const Matrix3 attitude = q.toRotationMatrix();
      torque += attitude.transpose() * model.moment(t, attitude);
    }
    return torque.cwiseQuotient(inertia);
  }
};

}  // namespace gnomon::rotation
