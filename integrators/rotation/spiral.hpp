#pragma once
#include "integrators/rotation/quaternion_velocity.hpp"
#include "integrators/rotation/velocity_leapfrog.hpp"

namespace gnomon::rotation {

/// Euler's equations by the strong-stability-preserving Runge-Kutta method of order 3, tau held in the body,
/// and the exponential of the velocity.
struct SpiralLeap {
  static constexpr int rates = 3;

  static Status kick(const Vector3& inertia, const Vector3& tau, double h, Vector3& w, long&) {
    const Vector3 k1 = h * euler_rate(inertia, tau, w), k2 = h * euler_rate(inertia, tau, w + k1),
                  k3 = h * euler_rate(inertia, tau, w + 0.25 * (k1 + k2));
    w += (k1 + k2 + 4.0 * k3) / 6.0;
    return Status::ok;
  }
  static Quaternion turn(const Vector3& w, double h) { return exponential(h * w); }
};

inline constexpr std::string_view spiral_citation =
    "C.A. del Valle, V. Angelidakis, S. Roy, J.D. Munoz, T. Poschel, Comput. Phys. Commun. 297 (2024) 109077";

/// The momentum is of order 3 where the moment is fixed in the body or absent, the orientation of order 2.
struct SpiralLeapfrog : VelocityLeapfrog<SpiralLeap> {
  static constexpr SchemeInfo info{
      .name = "spiral-leapfrog",
      .family = "rotation",
      .summary = "SPIRAL: three-stage update of the body velocity, one exponential; output synchronous",
      .citation = spiral_citation,
      .form = "rotation",
      .stages = 3,
      .orders = {{{"none", 2}, {"gravity", 2}, {"space_moment", 2}, {"body_moment", 2}}},
      .momentum_orders = {{{"none", 3}, {"body_moment", 3}}},
  };
};

/// All at one time: the turn exp(h w) exp((h^2/2) w'), then the same update of w over the step, the moment
/// held in the body at that of time t.
struct SpiralSynchronous : CarriesVelocity<3, 1> {
  static constexpr SchemeInfo info{
      .name = "spiral-synchronous",
      .family = "rotation",
      .summary = "SPIRAL for codes that keep all at one time: two exponentials a step",
      .citation = spiral_citation,
      .form = "rotation",
      .stages = 3,
      .orders = {{{"none", 2}, {"gravity", 1}, {"space_moment", 1}, {"body_moment", 2}}},
      .momentum_orders = {{{"none", 3}, {"body_moment", 3}}},
  };

  template <RotationForm M>
  static Status step(const M& model, QuaternionAndVelocity& state, double t, double h) {
    const Vector3 inertia = model.inertia();
    Vector3 tau = Vector3::Zero();
    if constexpr (M::has_moment) {
      const Matrix3 attitude = state.orientation.toRotationMatrix();
      tau = attitude.transpose() * model.moment(t, attitude);
    }
    const Vector3 rate = euler_rate(inertia, tau, state.velocity);
    state.orientation = state.orientation * exponential(h * state.velocity) * exponential(0.5 * h * h * rate);
    normalize(state.orientation);
    long unused = 0;
    return SpiralLeap::kick(inertia, tau, h, state.velocity, unused);
  }
};

}  // namespace gnomon::rotation
