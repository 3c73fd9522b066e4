#pragma once
#include "integrators/rotation/pose.hpp"

namespace gnomon::rotation {

struct QuaternionAndVelocity {
  Quaternion orientation;  ///< body -> space, unit
  Vector3 velocity;        ///< w, body components, rad/s
};

/// What schemes share that carry the orientation and the body velocity of one time and evaluate w' `rates`
/// times and the moment `moments` times a step.
template <int rates, int moments>
struct CarriesVelocity {
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
    cost.rhs = rates * steps;
    if constexpr (M::has_moment) cost.moments = moments * steps;
    return cost;
  }
};

/// Euler's equations, w' = I^-1 (tau - w x I w), all in the body [rad/s^2].
inline Vector3 euler_rate(const Vector3& inertia, const Vector3& tau, const Vector3& w) {
  return (tau + inertia.cwiseProduct(w).cross(w)).cwiseQuotient(inertia);
}

}  // namespace gnomon::rotation
