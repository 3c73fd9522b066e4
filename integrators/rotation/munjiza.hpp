#pragma once
#include "integrators/rotation/rotation.hpp"
#include "src/scheme.hpp"

namespace gnomon::rotation {

/// What tells the four schemes of this family apart.
struct Variant {
  double half_stage_impulse;  ///< the part of the impulse M h that stages 2 and 3 get; moments frozen at t
  bool stage_moments;         ///< moments at the stages' own attitudes, momentum by the classical RK4 weights
  bool commutators;           ///< the commutator terms of the Runge-Kutta-Munthe-Kaas method of order 4
};

/// The state of the scheme: the triad (i, j, k) as the columns of A, and the spatial angular momentum H = A I
/// A^T w. Without a moment y = A^T H is turned from step to step, so that a step need not wait for the triad
/// of the one before; with one it is not used.
struct TriadState {
  Matrix3 attitude;
  Vector3 momentum;
  Vector3 body_momentum;
};

/// Steps 1-7 of A. Munjiza, The Combined Finite-Discrete Element Method (Wiley 2004), section 5.6, eqs.
/// (5.79)-(5.93), and its repairs. The book's stage s has the triad A_s = rot(p_s, A), A always being the
/// triad of time t, and the angular velocity w_s = A_s I^-1 A_s^T H_s, H_s being H plus the impulse of the
/// stage. Here the spatial vectors of a step are written in the body triad of time t, where the factors A
/// drop out: with y = A^T H and p_s, w_s and the impulse turned likewise, A_s = A R(p_s) and w_s = R(p_s)
/// I^-1 R(p_s)^T y_s.
template <Variant variant>
struct TriadStep {
  template <RotationForm M>
  using State = TriadState;

  template <RotationForm M>
  static TriadState start(const M&, const typename M::State& state) {
    return {state.attitude, state.attitude * state.angular_momentum, state.angular_momentum};
  }

  /// The momentum in the body frame is taken through the attitude, so that its error shows that of the
  /// attitude.
  template <RotationForm M>
  static typename M::State view(const M&, const TriadState& state) {
    return {state.attitude, state.attitude.transpose() * state.momentum};
  }

  template <RotationForm M>
  static Cost cost(const M&, const TriadState&, long steps) {
    Cost cost;
    cost.steps = steps;
    cost.rhs = 4 * steps;
    if constexpr (M::has_moment) cost.moments = (variant.stage_moments ? 4 : 1) * steps;
    return cost;
  }

  /// Everything is inlined into a step: a call in the middle would cost more than what it does.
  template <RotationForm M>
  [[gnu::flatten]] static Status step(const M& model, TriadState& state, double t, double h) {
    const Matrix3& A = state.attitude;
    const Triple inverse(model.inertia().cwiseInverse());
    const auto velocity = [&](const Rotation& stage, const Triple& momentum) {
      return stage(product(inverse, stage.inverse(momentum)));
    };
    // M(t, A_s), in the body triad of time t
    const auto moment = [&](double time, const Rotation& stage) {
      return Triple(A.transpose() * model.moment(time, A * stage.matrix()));
    };

    const Triple y(M::has_moment ? Vector3(A.transpose() * state.momentum) : state.body_momentum);
    Triple y2 = y, y3 = y, y4 = y, k1(0.0, 0.0, 0.0), k2 = k1, k3 = k1;
    if constexpr (M::has_moment) {
      k1 = Triple(A.transpose() * model.moment(t, A));
      y2 = y2 + ((variant.stage_moments ? 0.5 : variant.half_stage_impulse) * h) * k1;
      y3 = y2;
      y4 = y4 + h * k1;
    }
    const Triple w1 = product(inverse, y);   // (5.79)
    const Rotation stage1((0.5 * h) * w1);   // (5.80), (5.81)
    const Triple w2 = velocity(stage1, y2);  // (5.82)
    if constexpr (M::has_moment && variant.stage_moments) {
      k2 = moment(t + 0.5 * h, stage1);
      y3 = y + (0.5 * h) * k2;
    }
    Triple p2 = (0.5 * h) * w2;                                                    // (5.83)
    if constexpr (variant.commutators) p2 = p2 - (0.125 * h * h) * cross(w1, w2);  // Munthe-Kaas, left action
    const Rotation stage2(p2);                                                     // (5.84)
    const Triple w3 = velocity(stage2, y3);                                        // (5.85)
    if constexpr (M::has_moment && variant.stage_moments) {
      k3 = moment(t + 0.5 * h, stage2);
      y4 = y + h * k3;
    }
    const Rotation stage3(h * w3);           // (5.86), (5.87)
    const Triple w4 = velocity(stage3, y4);  // (5.88)
    if constexpr (M::has_moment) {
      // (5.92): H(t+h) = H + M h, or with the weights of the classical method
      if constexpr (variant.stage_moments)
        state.momentum += (h / 6.0) * (A * (k1 + 2.0 * (k2 + k3) + moment(t + h, stage3)).vector());
      else
        state.momentum += h * (A * k1.vector());
    }
    Triple p = (h / 6.0) * (w1 + 2.0 * (w2 + w3) + w4);                         // (5.89), (5.90)
    if constexpr (variant.commutators) p = p - (h * h / 12.0) * cross(w1, w4);  // Munthe-Kaas, left action
    const Rotation whole(p);
    if constexpr (!M::has_moment) state.body_momentum = whole.inverse(y).vector();
    state.attitude = whole.after(A);  // (5.91)
    return Status::ok;
  }
};

inline constexpr std::string_view munjiza_citation =
    "A. Munjiza, The Combined Finite-Discrete Element Method, Wiley 2004, section 5.6, eqs. (5.61)-(5.93); "
    "A. Munjiza, J.P. Latham, N.W.M. John, Int. J. Numer. Meth. Engng 56 (2003) 35-55";

struct Munjiza : TriadStep<Variant{1.0, false, false}> {
  static constexpr SchemeInfo info{
      .name = "munjiza",
      .family = "rotation",
      .summary = "the documented RK4 rotation scheme as printed: moment frozen, full impulse in every stage",
      .citation = munjiza_citation,
      .form = "rotation",
      .stages = 4,
      .orders = {{{"none", 2}, {"gravity", 1}, {"space_moment", 1}, {"body_moment", 1}}},
      .conserves_momentum = true,
  };
};

struct MunjizaHalfImpulse : TriadStep<Variant{0.5, false, false}> {
  static constexpr SchemeInfo info{
      .name = "munjiza-half-impulse",
      .family = "rotation",
      .summary = "the same with stage impulses 0, M h/2, M h/2, M h",
      .citation = munjiza_citation,
      .form = "rotation",
      .stages = 4,
      .orders = {{{"none", 2}, {"gravity", 1}, {"space_moment", 2}, {"body_moment", 1}}},
      .conserves_momentum = true,
  };
};

struct MunjizaStageMoments : TriadStep<Variant{0.5, true, false}> {
  static constexpr SchemeInfo info{
      .name = "munjiza-stage-moments",
      .family = "rotation",
      .summary = "the same with moments at the stages and RK4 weights for the angular momentum",
      .citation = munjiza_citation,
      .form = "rotation",
      .stages = 4,
      .orders = {{{"none", 2}, {"gravity", 2}, {"space_moment", 2}, {"body_moment", 2}}},
      .conserves_momentum = true,
  };
};

struct Rkmk4 : TriadStep<Variant{0.5, true, true}> {
  static constexpr SchemeInfo info{
      .name = "rkmk4",
      .family = "rotation",
      .summary = "Runge-Kutta-Munthe-Kaas method of order 4: stage moments and the two commutator terms",
      .citation =
          "H. Munthe-Kaas, Appl. Numer. Math. 29 (1999) 115-127, with two commutators; on the steps of "
          "Munjiza (2004), section 5.6",
      .form = "rotation",
      .stages = 4,
      .orders = {{{"none", 4}, {"gravity", 4}, {"space_moment", 4}, {"body_moment", 4}}},
      .conserves_momentum = true,
  };
};

}  // namespace gnomon::rotation
