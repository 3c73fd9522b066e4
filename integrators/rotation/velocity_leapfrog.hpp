#pragma once
#include "integrators/rotation/pose.hpp"

namespace gnomon::rotation {

/// What the leapfrogs of this kind are made of: the body velocity over a time under a body moment that is
/// held, and the turn by a body velocity that is held.
template <class F>
concept Leap = requires(const Vector3& inertia, const Vector3& tau, double h, Vector3& w, long& iterations) {
  { F::kick(inertia, tau, h, w, iterations) } -> std::same_as<Status>;
  { F::turn(w, h) } -> std::same_as<Quaternion>;
  { F::rates } -> std::convertible_to<int>;  // evaluations of w' in a kick; 0 where it iterates
};

/// Attitude and moment at the present time t, and the body velocity at t - lag.
struct LeapfrogState {
  Quaternion orientation;  ///< body -> space, unit
  Matrix3 attitude;        ///< its matrix A
  Vector3 velocity;        ///< w, body components, rad/s
  double lag;              ///< s; 0 at the start, half a step later on
  Vector3 moment;          ///< M(t, A), space components, N m
  long iterations = 0;
};

/// w(t - h/2) -> w(t + h/2) under the moment of time t, then the turn by h w(t + h/2). Started by half a
/// kick, w(0) -> w(h/2); output gets w(t) by half a kick from w(t - h/2). One moment a step, and one at the
/// start.
template <Leap L>
struct VelocityLeapfrog {
  template <RotationForm M>
  using State = LeapfrogState;

  /// At t = 0.
  template <RotationForm M>
  static LeapfrogState start(const M& model, const typename M::State& state) {
    const Quaternion q = Quaternion(Matrix3(state.attitude)).normalized();
    const Matrix3 attitude = q.toRotationMatrix();
    const Vector3 velocity = state.angular_momentum.cwiseQuotient(Vector3(model.inertia()));
    return {q, attitude, velocity, 0.0, model.moment(0.0, attitude)};
  }
  template <RotationForm M>
  static typename M::State view(const M& model, const LeapfrogState& state) {
    LeapfrogState now = state;
    // Where this failed, so would the next step.
    if (state.lag != 0.0) kick(model, now, state.lag);
    return {state.attitude, now.velocity.cwiseProduct(Vector3(model.inertia()))};
  }
  template <RotationForm M>
  static Cost cost(const M&, const LeapfrogState& state, long steps) {
    Cost cost;
    cost.steps = steps;
    cost.newton_iterations = state.iterations;
    cost.rhs = L::rates > 0 ? L::rates * steps : state.iterations;
    if constexpr (M::has_moment) cost.moments = steps + 1;
    return cost;
  }

  template <RotationForm M>
  static Status step(const M& model, LeapfrogState& state, double t, double h) {
    const Status status = kick(model, state, state.lag + 0.5 * h);
    if (status != Status::ok) return status;
    state.lag = 0.5 * h;
    state.orientation = state.orientation * L::turn(state.velocity, h);
    normalize(state.orientation);
    state.attitude = state.orientation.toRotationMatrix();
    if constexpr (M::has_moment) state.moment = model.moment(t + h, state.attitude);
    return Status::ok;
  }

 private:
  template <RotationForm M>
  static Status kick(const M& model, LeapfrogState& state, double h) {
    Vector3 tau = Vector3::Zero();
    if constexpr (M::has_moment) tau = state.attitude.transpose() * state.moment;
    return L::kick(model.inertia(), tau, h, state.velocity, state.iterations);
  }
};

}  // namespace gnomon::rotation
