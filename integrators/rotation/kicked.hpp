#pragma once
#include <array>

#include "integrators/rotation/pose.hpp"
#include "integrators/rotation/splittings.hpp"

namespace gnomon::rotation {

/// A map of the free body: `turn(m, tau, by)` as in ExactDrift, and whether it is the exact one.
template <class F>
concept FreeFlow = requires(F& flow, const Vector3& m, double tau, Quaternion& by) {
  { F(m) } -> std::same_as<F>;  // of the principal moments
  { flow.turn(m, tau, by) } -> std::same_as<Status>;
  { flow.iterations() } -> std::convertible_to<long>;
  { F::exact } -> std::convertible_to<bool>;
};

template <FreeFlow Flow>
struct KickedState {
  Pose pose;
  Vector3 moment;  // in space; of a splitting that ends with a kick, at the present time
  Flow flow;
};

/// Kicks H += k h M(t, A) and maps of the free body in turn, by the fractions of `splitting`. The moment of
/// the last kick of a step is that of the first kick of the next. Without a moment nothing is split: a step
/// is one map. H changes by kicks alone, so it is kept as long as there are none.
template <FreeFlow Flow, const auto& splitting>
struct Kicked {
  static constexpr int drifts = static_cast<int>(splitting.drifts.size());
  static constexpr bool drift_first = splitting.drift_first;
  template <RotationForm M>
  using State = KickedState<Flow>;

  /// At t = 0.
  template <RotationForm M>
  static KickedState<Flow> start(const M& model, const typename M::State& state) {
    const Pose pose = pose_of<M>(state);
    return {pose, drift_first ? Vector3::Zero() : Vector3(model.moment(0.0, pose.attitude)),
            Flow(model.inertia())};
  }
  template <RotationForm M>
  static typename M::State view(const M&, const KickedState<Flow>& state) {
    return state_of<M>(state.pose);
  }
  template <RotationForm M>
  static Cost cost(const M&, const KickedState<Flow>& state, long steps) {
    Cost cost;
    cost.steps = steps;
    cost.newton_iterations = state.flow.iterations();
    // An implicit map takes its equation, and in it the velocity, once an iteration.
    cost.rhs = Flow::exact ? (M::has_moment ? drifts : 1) * steps : cost.newton_iterations;
    if constexpr (M::has_moment) cost.moments = drift_first ? (drifts - 1) * steps : drifts * steps + 1;
    return cost;
  }

  template <RotationForm M>
  [[gnu::noinline]] static Status step(const M& model, KickedState<Flow>& state, double t, double h) {
    if constexpr (!M::has_moment) {
      return drift(state, h);
    } else {
      const double* kick = splitting.kicks.data();
      double passed = 0.0;
      if constexpr (!drift_first) state.pose.momentum += *kick++ * h * state.moment;
      for (int k = 0; k < drifts; ++k) {
        const double fraction = splitting.drifts[static_cast<std::size_t>(k)];
        const Status status = drift(state, fraction * h);
        if (status != Status::ok) return status;
        if (drift_first && k + 1 == drifts) break;
        passed += fraction;
        state.moment = model.moment(t + passed * h, state.pose.attitude);
        state.pose.momentum += *kick++ * h * state.moment;
      }
      return Status::ok;
    }
  }

 private:
  static Status drift(KickedState<Flow>& state, double tau) {
    Quaternion by;
    const Status status = state.flow.turn(state.pose.body_momentum(), tau, by);
    if (status == Status::ok) state.pose.turn(by);
    return status;
  }
};

}  // namespace gnomon::rotation
