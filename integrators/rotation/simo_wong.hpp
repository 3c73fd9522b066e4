#pragma once
#include "integrators/rotation/newton.hpp"
#include "integrators/rotation/pose.hpp"

namespace gnomon::rotation {

/// ALGO-C1 of Simo and Wong: the turn by th = (h/2)(w + w'), body components, and H' = H + h M at the middle
/// of that turn, so that I w' = exp(-th) A^T H'. Because exp(th) leaves th as it is, a free body keeps its
/// energy: (m' - m).(w + w') = 0. Solved for th by Newton's method to rounding, quadratically convergent on a
/// free body; the derivative of the moment is left out.
struct SimoWongC1 {
  static constexpr SchemeInfo info{
      .name = "simo-wong-c1",
      .family = "rotation",
      .summary = "ALGO-C1: conserves energy and angular momentum, moment at the midpoint",
      .citation = "J.C. Simo, K.K. Wong, Int. J. Numer. Meth. Engng 31 (1991) 19-52, ALGO-C1",
      .form = "rotation",
      .orders = {{{"none", 2}, {"gravity", 2}, {"space_moment", 2}, {"body_moment", 2}}},
      .reversible = true,
      .conserves_energy = true,
      .conserves_momentum = true,
  };
  struct PoseAndCount {
    Pose pose;
    long iterations = 0;
  };
  template <RotationForm M>
  using State = PoseAndCount;

  template <RotationForm M>
  static PoseAndCount start(const M&, const typename M::State& state) {
    return {pose_of<M>(state)};
  }
  template <RotationForm M>
  static typename M::State view(const M&, const PoseAndCount& state) {
    return state_of<M>(state.pose);
  }
  template <RotationForm M>
  static Cost cost(const M&, const PoseAndCount& state, long steps) {
    Cost cost;
    cost.steps = steps;
    cost.rhs = cost.newton_iterations = state.iterations;
    if constexpr (M::has_moment) cost.moments = state.iterations;
    return cost;
  }

  /// Derivative by th of I th - (h/2) (m + v), where v = exp(-th) A^T H' and H' is held; body components.
  static Matrix3 tangent(const Vector3& inertia, const Vector3& angle, const Vector3& v, double h) {
    // d v = v x (D d angle), D of -angle
    Matrix3 derivative = -0.5 * h * (cross_matrix(v) * left_derivative(-angle));
    derivative.diagonal() += inertia;
    return derivative;
  }

  template <RotationForm M>
  [[gnu::noinline]] static Status step(const M& model, PoseAndCount& state, double t, double h) {
    Pose& pose = state.pose;
    const Vector3 inertia = model.inertia(), m = pose.body_momentum();
    Vector3 angle = h * m.cwiseQuotient(inertia), after = pose.momentum;
    Corrections corrections;
    for (;;) {
      ++state.iterations;
      if constexpr (M::has_moment)
        after = pose.momentum +
                h * Vector3(model.moment(t + 0.5 * h, pose.attitude * Rotation(0.5 * angle).matrix()));
      const Vector3 v = Rotation(angle).inverse(pose.attitude.transpose() * after);
      const Vector3 residual = inertia.cwiseProduct(angle) - 0.5 * h * (m + v);
      const Vector3 change = solve(tangent(inertia, angle, v, h), residual);
      angle -= change;
      const auto verdict = corrections.add(change.cwiseAbs().maxCoeff(), angle.cwiseAbs().maxCoeff());
      if (verdict == Corrections::Verdict::failed || !angle.allFinite()) return Status::newton_failed;
      if (verdict == Corrections::Verdict::done) break;
    }
    pose.momentum = after;
    pose.turn(exponential(angle));
    return Status::ok;
  }
};

}  // namespace gnomon::rotation
