#pragma once
#include "integrators/rotation/gyroscopic.hpp"
#include "integrators/rotation/quaternion_velocity.hpp"

namespace gnomon::rotation {

/// Newmark's method with beta = 0, gamma = 1/2 for the body velocity W:
///   W_{n+1/2} = W_n + (h/2) I^-1 (I W_n x W_n + tau(Q_n)),  Q_{n+1} = Q_n cay(h W_{n+1/2}),
///   W_{n+1} = W_{n+1/2} + (h/2) I^-1 (I W_{n+1} x W_{n+1} + tau(Q_{n+1})), implicit in W_{n+1}.
/// Symmetric in time, but not symplectic.
struct LieNewmark {
  static constexpr SchemeInfo info{
      .name = "lie-newmark",
      .family = "rotation",
      .summary = "semi-explicit Lie-Newmark method on the Cayley map; symmetric but not symplectic",
      .citation =
          "J.C. Simo, L. Vu-Quoc, Comput. Methods Appl. Mech. Engrg. 66 (1988) 125-161; "
          "N. Bou-Rabee, G. Ortolan, A. Saccon, arXiv 1005.3078",
      .form = "rotation",
      .orders = {{{"none", 2}, {"gravity", 2}, {"space_moment", 2}, {"body_moment", 2}}},
      .reversible = true,
  };
  struct Motion : QuaternionAndVelocity {
    Vector3 moment;  ///< tau(Q_n), body components, N m
    long iterations = 0;
  };
  template <RotationForm M>
  using State = Motion;

  template <RotationForm M>
  static Motion start(const M& model, const typename M::State& state) {
    Motion motion{{Quaternion(Matrix3(state.attitude)).normalized(),
                   state.angular_momentum.cwiseQuotient(Vector3(model.inertia()))},
                  Vector3::Zero()};
    motion.moment = body_moment(model, 0.0, motion.orientation);
    return motion;
  }
  template <RotationForm M>
  static typename M::State view(const M& model, const Motion& state) {
    return {state.orientation.toRotationMatrix(), state.velocity.cwiseProduct(Vector3(model.inertia()))};
  }
  template <RotationForm M>
  static Cost cost(const M&, const Motion& state, long steps) {
    Cost cost;
    cost.steps = steps;
    cost.rhs = steps + state.iterations;
    cost.newton_iterations = state.iterations;
    if constexpr (M::has_moment) cost.moments = steps + 1;
    return cost;
  }

  template <RotationForm M>
  static Status step(const M& model, Motion& state, double t, double h) {
    const Vector3 inertia = model.inertia();
    const Vector3 middle = state.velocity + 0.5 * h * euler_rate(inertia, state.moment, state.velocity);
    state.orientation = state.orientation * cayley(0.5 * h * middle);
    normalize(state.orientation);
    state.moment = body_moment(model, t + h, state.orientation);
    const Vector3 known = inertia.cwiseProduct(middle) + 0.5 * h * state.moment;
    return solve_gyroscopic(inertia, known, h, state.velocity, state.iterations);
  }

 private:
  template <RotationForm M>
  static Vector3 body_moment(const M& model, double t, const Quaternion& q) {
    if constexpr (!M::has_moment) return Vector3::Zero();
    const Matrix3 attitude = q.toRotationMatrix();
    return attitude.transpose() * model.moment(t, attitude);
  }
};

}  // namespace gnomon::rotation
