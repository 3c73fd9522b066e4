#pragma once
#include <array>

#include "integrators/rotation/pose.hpp"

namespace gnomon::rotation {

/// A map of the free body: `turn(m, tau, by)` as in ExactDrift, and whether it is the exact one, of which
/// pieces make a whole.
template <class F>
concept FreeFlow = requires(F& flow, const Vector3& m, double tau, Quaternion& by) {
  { F(m) } -> std::same_as<F>;  // of the principal moments
  { flow.turn(m, tau, by) } -> std::same_as<Status>;
  { flow.iterations() } -> std::convertible_to<long>;
  { F::exact } -> std::convertible_to<bool>;
};

/// Kicks of the moment at the ends and between maps of the free body, all by fractions of the step: kick,
/// drift, kick, .., kick. The moment at the end of a step is the one at the start of the next.
struct Strang {
  static constexpr std::array<double, 2> kicks{0.5, 0.5};
  static constexpr std::array<double, 1> drifts{1.0};
};

template <FreeFlow Flow>
struct KickedState {
  Pose pose;
  Vector3 moment;  // in space, at the present time
  Flow flow;
};

/// H += k h M(t, A) and maps of the free body in turn. Without a moment nothing is split: a step is one map.
/// H changes by kicks alone, so it is kept as long as there are none.
template <FreeFlow Flow, class Splitting>
struct Kicked {
  static constexpr int drifts = static_cast<int>(Splitting::drifts.size());
  template <RotationForm M>
  using State = KickedState<Flow>;

  /// At t = 0.
  template <RotationForm M>
  static KickedState<Flow> start(const M& model, const typename M::State& state) {
    const Pose pose = pose_of<M>(state);
    return {pose, model.moment(0.0, pose.attitude), Flow(model.inertia())};
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
    if constexpr (M::has_moment) cost.moments = drifts * steps + 1;
    return cost;
  }

  template <RotationForm M>
  static Status step(const M& model, KickedState<Flow>& state, double t, double h) {
    static_assert(Flow::exact || drifts == 1);
    if constexpr (!M::has_moment) {
      return drift(state, h);
    } else {
      double passed = 0.0;
      for (std::size_t k = 0; k < Splitting::drifts.size(); ++k) {
        state.pose.momentum += Splitting::kicks[k] * h * state.moment;
        const Status status = drift(state, Splitting::drifts[k] * h);
        if (status != Status::ok) return status;
        passed += Splitting::drifts[k];
        state.moment = model.moment(t + passed * h, state.pose.attitude);
      }
      state.pose.momentum += Splitting::kicks.back() * h * state.moment;
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
