#pragma once
#include "integrators/rotation/pose.hpp"

namespace gnomon::rotation {

/// The unit quaternion along (x, y, z, w).
inline Quaternion unit_along(const Eigen::Vector4d& coefficients) {
  Quaternion q;
  q.coeffs() = coefficients / std::sqrt(coefficients.squaredNorm());
  return q;
}

/// How the attitude goes on by one step: the unit quaternion, in the triad of time t, from the body momentum
/// m and the body moment tau of time t. A scheme that works with the momentum in the middle of the step takes
/// m + (h/2) tau for it, which is A(t)^T H(t + h/2).
template <class T>
concept OneTurn = requires(const Vector3& inertia, const Vector3& m, const Vector3& tau, double h) {
  { T::turn(inertia, m, tau, h) } -> std::same_as<Quaternion>;
  { T::rates } -> std::convertible_to<int>;  // evaluations of the angular velocity in it
};

/// Attitude and angular momentum of one time and the moment at it.
struct KickedPose {
  Pose pose;
  Vector3 moment;  ///< M(t, A), space components, N m
};

/// H(t + h/2) = H(t) + (h/2) M(t), one turn, H(t + h) = H(t + h/2) + (h/2) M(t + h). The leapfrog that
/// carries H(t - h/2), adds h M(t) and was started with half a kick passes through the very same attitudes
/// and half-step momenta; the state kept here is its synchronous one, for the price of storing M. One moment
/// a step, and one at the start. A free body keeps H to the last bit.
template <OneTurn Turn>
struct TurnStep {
  template <RotationForm M>
  using State = KickedPose;

  /// At t = 0.
  template <RotationForm M>
  static KickedPose start(const M& model, const typename M::State& state) {
    const Pose pose = pose_of<M>(state);
    return {pose, model.moment(0.0, pose.attitude)};
  }
  template <RotationForm M>
  static typename M::State view(const M&, const KickedPose& state) {
    return state_of<M>(state.pose);
  }
  template <RotationForm M>
  static Cost cost(const M&, const KickedPose&, long steps) {
    Cost cost;
    cost.steps = steps;
    cost.rhs = Turn::rates * steps;
    if constexpr (M::has_moment) cost.moments = steps + 1;
    return cost;
  }

  template <RotationForm M>
  static Status step(const M& model, KickedPose& state, double t, double h) {
    Pose& pose = state.pose;
    const Vector3 m = pose.body_momentum();
    Vector3 tau = Vector3::Zero();
    if constexpr (M::has_moment) {
      tau = pose.attitude.transpose() * state.moment;
      pose.momentum += 0.5 * h * state.moment;
    }
    pose.turn(Turn::turn(model.inertia(), m, tau, h));
    if constexpr (M::has_moment) {
      state.moment = model.moment(t + h, pose.attitude);
      pose.momentum += 0.5 * h * state.moment;
    }
    return Status::ok;
  }
};

}  // namespace gnomon::rotation
