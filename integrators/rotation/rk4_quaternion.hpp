#pragma once
#include "integrators/rotation/pose.hpp"

namespace gnomon::rotation {

/// The classical Runge-Kutta method on q' = q o (0, w)/2, m' = m x w + A^T M with w = I^-1 m, all in the body
/// triad; q is normalised after every step, and for the attitudes at which the moment is taken.
struct Rk4Quaternion {
  static constexpr SchemeInfo info{
      .name = "rk4-quaternion",
      .family = "rotation",
      .summary = "classical Runge-Kutta method on quaternion and body momentum, normalised after each step",
      .citation = "W. Kutta, Z. Math. Phys. 46 (1901) 435-453",
      .form = "rotation",
      .stages = 4,
      .orders = {{{"none", 4}, {"gravity", 4}, {"space_moment", 4}, {"body_moment", 4}}},
  };
  struct QuaternionState {
    Quaternion orientation;
    Vector3 momentum;  ///< body components
  };
  template <RotationForm M>
  using State = QuaternionState;

  template <RotationForm M>
  static QuaternionState start(const M&, const typename M::State& state) {
    return {Quaternion(Matrix3(state.attitude)).normalized(), state.angular_momentum};
  }
  template <RotationForm M>
  static typename M::State view(const M&, const QuaternionState& state) {
    return {state.orientation.toRotationMatrix(), state.momentum};
  }
  template <RotationForm M>
  static Cost cost(const M&, const QuaternionState&, long steps) {
    Cost cost;
    cost.steps = steps;
    cost.rhs = 4 * steps;
    if constexpr (M::has_moment) cost.moments = 4 * steps;
    return cost;
  }

  template <RotationForm M>
  [[gnu::noinline]] static Status step(const M& model, QuaternionState& state, double t, double h) {
    const Rates k1 = rates(model, t, state);
    const Rates k2 = rates(model, t + 0.5 * h, moved(state, 0.5 * h, k1));
    const Rates k3 = rates(model, t + 0.5 * h, moved(state, 0.5 * h, k2));
    const Rates k4 = rates(model, t + h, moved(state, h, k3));
    state = moved(state, h / 6.0,
                  {k1.orientation + 2.0 * (k2.orientation + k3.orientation) + k4.orientation,
                   k1.momentum + 2.0 * (k2.momentum + k3.momentum) + k4.momentum});
    normalize(state.orientation);
    return Status::ok;
  }

 private:
  struct Rates {
    Eigen::Vector4d orientation;  // x, y, z, w
    Vector3 momentum;
  };
  static QuaternionState moved(const QuaternionState& state, double h, const Rates& rates) {
    QuaternionState next = state;
    next.orientation.coeffs() += h * rates.orientation;
    next.momentum += h * rates.momentum;
    return next;
  }
  template <RotationForm M>
  static Rates rates(const M& model, double t, const QuaternionState& state) {
    const Vector3 w = state.momentum.cwiseQuotient(Vector3(model.inertia()));
    const Quaternion pure(0.0, w[0], w[1], w[2]);
    Rates rates{0.5 * (state.orientation * pure).coeffs(), state.momentum.cross(w)};
    if constexpr (M::has_moment) {
      const Matrix3 attitude = state.orientation.normalized().toRotationMatrix();
      rates.momentum += attitude.transpose() * Vector3(model.moment(t, attitude));
    }
    return rates;
  }
};

}  // namespace gnomon::rotation
