#pragma once
#include "integrators/rotation/pose.hpp"

namespace gnomon::rotation {

/// What explicit methods on the group share: stages with the attitude of time t turned by exponentials and H
/// plus an impulse. H changes by impulses alone.
template <int stages, int moments>
struct ExplicitLie {
  template <RotationForm M>
  using State = Pose;

  template <RotationForm M>
  static Pose start(const M&, const typename M::State& state) {
    return pose_of<M>(state);
  }
  template <RotationForm M>
  static typename M::State view(const M&, const Pose& pose) {
    return state_of<M>(pose);
  }
  template <RotationForm M>
  static Cost cost(const M&, const Pose&, long steps) {
    Cost cost;
    cost.steps = steps;
    cost.rhs = stages * steps;
    if constexpr (M::has_moment) cost.moments = moments * steps;
    return cost;
  }

 protected:
  struct Rates {
    Vector3 velocity;  ///< w, components in the triad of the stage
    Vector3 moment;    ///< M, space components
  };
  /// At time t, where the triad of `pose` is turned by `by` and its momentum is H.
  template <RotationForm M>
  static Rates rates(const M& model, const Pose& pose, double t, const Quaternion& by, const Vector3& H) {
    const Matrix3 attitude = pose.attitude * by.toRotationMatrix();
    Rates at{(attitude.transpose() * H).cwiseQuotient(Vector3(model.inertia())), Vector3::Zero()};
    if constexpr (M::has_moment) at.moment = model.moment(t, attitude);
    return at;
  }
};

}  // namespace gnomon::rotation
