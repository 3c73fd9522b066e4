#pragma once
// The steps of Munjiza (2004), section 5.6, and of the Runge-Kutta-Munthe-Kaas method written down as they
// are printed: in space, with rot(p, a) of (5.68). An independent check of the production code, and the place
// where tests plant defects.

#include <cmath>

#include "integrators/rotation/munjiza.hpp"

namespace gnomon::test {

/// rot(p, .) of (5.68) applied to the columns of a triad.
inline Matrix3 rot(const Vector3& p, const Matrix3& triad) {
  const double angle = p.norm();
  if (angle == 0.0) return triad;
  Matrix3 turned;
  for (int k = 0; k < 3; ++k) {
    const Vector3 a = triad.col(k), along = (p.dot(a) / (angle * angle)) * p;
    turned.col(k) = along + (a - along) * std::cos(angle) + p.cross(a) / angle * std::sin(angle);
  }
  return turned;
}

/// The coefficients of the scheme; the defaults are those of the method of order 4.
struct BookCoefficients {
  double stage_impulse = 0.5;        ///< the part of the impulse that stages 2 and 3 get
  bool stage_moments = true;         ///< moments at the stages, else frozen at t
  double first_commutator = 1.0;     ///< times (h^2/8) w1 x w2
  double last_commutator = 1.0;      ///< times (h^2/12) w1 x w4
  double weight2 = 2.0;              ///< of w2
  double weight3 = 2.0;              ///< of w3
  double moment_weight2 = 2.0;       ///< of the moment of stage 2
  double moment_weight3 = 2.0;       ///< of the moment of stage 3
  bool from_previous_stage = false;  ///< stage 3 rotates the triad of stage 2 by half a step
};

/// These steps with some coefficients; a scheme derives from it and adds its `info`.
template <BookCoefficients c>
struct BookStep {
  template <rotation::RotationForm M>
  using State = rotation::TriadState;

  template <rotation::RotationForm M>
  static rotation::TriadState start(const M&, const typename M::State& state) {
    return {state.attitude, state.attitude * state.angular_momentum};
  }
  template <rotation::RotationForm M>
  static typename M::State view(const M&, const rotation::TriadState& state) {
    return {state.attitude, state.attitude.transpose() * state.momentum};
  }
  template <rotation::RotationForm M>
  static Cost cost(const M&, const rotation::TriadState&, long steps) {
    return {.steps = steps};
  }

  template <rotation::RotationForm M>
  static Status step(const M& model, rotation::TriadState& state, double t, double h) {
    const Matrix3 A = state.attitude;
    const Vector3 H = state.momentum;
    const auto velocity = [&](const Matrix3& triad, const Vector3& momentum) -> Vector3 {
      return triad * (triad.transpose() * momentum).cwiseQuotient(Vector3(model.inertia()));
    };
    const Vector3 m1 = model.moment(t, A);
    const Vector3 w1 = velocity(A, H);
    const Matrix3 A1 = rot(0.5 * h * w1, A);
    const Vector3 m2 = c.stage_moments ? Vector3(model.moment(t + 0.5 * h, A1)) : m1;
    const Vector3 w2 = velocity(A1, H + c.stage_impulse * h * m1);
    const Matrix3 A2 =
        rot(0.5 * h * w2 - c.first_commutator * h * h / 8.0 * w1.cross(w2), c.from_previous_stage ? A1 : A);
    const Vector3 m3 = c.stage_moments ? Vector3(model.moment(t + 0.5 * h, A2)) : m1;
    const Vector3 w3 = velocity(A2, H + c.stage_impulse * h * m2);
    const Matrix3 A3 = rot(h * w3, A);
    const Vector3 m4 = c.stage_moments ? Vector3(model.moment(t + h, A3)) : m1;
    const Vector3 w4 = velocity(A3, H + h * m3);
    const Vector3 p = h / 6.0 * (w1 + c.weight2 * w2 + c.weight3 * w3 + w4) -
                      c.last_commutator * h * h / 12.0 * w1.cross(w4);
    state.momentum = H + h / 6.0 * (m1 + c.moment_weight2 * m2 + c.moment_weight3 * m3 + m4);
    state.attitude = rot(p, A);
    return Status::ok;
  }
};

}  // namespace gnomon::test
