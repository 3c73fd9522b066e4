#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gnomon::planar_beam {

/// Stiffness EA, GA_s [N], EI [N m^2], mass rho A [kg/m] and rotary inertia rho I [kg m] of the section.
struct CrossSection {
  double EA, GA, EI, rhoA, rhoI;
};

enum class Profile { constant, step, ramp, half_sine };
enum class Place { start, end, distributed };

/// A dead load: force [N, or N/m where distributed] in the fixed frame, moment about +y, times a function of
/// time.
struct Load {
  Place at = Place::end;
  std::array<double, 2> force{0.0, 0.0};
  double moment = 0.0;
  Profile profile = Profile::constant;
  double duration = 0.0;  ///< s; of a step, ramp or half sine

  /// constant: 1; step: 1, then 0; ramp: from 0 to 1, then 1; half sine: sin(pi t/duration), then 0.
  double factor(double t) const {
    switch (profile) {
      case Profile::constant:
        return 1.0;
      case Profile::step:
        return t < duration ? 1.0 : 0.0;
      case Profile::ramp:
        return t < duration ? t / duration : 1.0;
      case Profile::half_sine:
        return t < duration ? std::sin(std::numbers::pi * t / duration) : 0.0;
    }
    return 0.0;
  }
  /// Its value after all changes.
  double final_factor() const { return profile == Profile::constant || profile == Profile::ramp ? 1.0 : 0.0; }
  /// int of the factor from 0 to t.
  double impulse(double t) const {
    const double s = profile == Profile::constant ? t : std::min(t, duration);
    switch (profile) {
      case Profile::constant:
      case Profile::step:
        return s;
      case Profile::ramp:
        return 0.5 * s * s / duration + (t - s);
      case Profile::half_sine:
        return duration / std::numbers::pi * (1.0 - std::cos(std::numbers::pi * s / duration));
    }
    return 0.0;
  }
};

/// A prescribed rotation s(t) about +y, a ramp: to t/over, then `to`; at rest before t = 0. Its rate jumps at
/// 0 and at `over`.
struct Motion {
  double to = 0.0;    ///< rad
  double over = 1.0;  ///< s

  double value(double t) const { return t <= 0.0 ? 0.0 : t < over ? to * (t / over) : to; }
  /// s'(t-) and s'(t+), rad/s.
  double rate_before(double t) const { return t > 0.0 && t <= over ? to / over : 0.0; }
  double rate_after(double t) const { return t >= 0.0 && t < over ? to / over : 0.0; }
  /// A break that is nearer to t than `tolerance`, else t: for times that are multiples of a step.
  double snapped(double t, double tolerance) const {
    if (std::abs(t) <= tolerance) return 0.0;
    return std::abs(t - over) <= tolerance ? over : t;
  }
};

/// What an end is held by: pinned holds the place, clamped the rotation too, a motion
/// holds the place and prescribes the rotation.
struct Support {
  bool place = false, rotation = false;
  std::optional<Motion> motion{};
};

/// Where the initial tangent comes from: from the nodes between which the element interpolates, or exactly
/// from the angle at each integration point.
enum class Geometry { interpolated, exact };

/// A beam as scenes describe it; SI units, the plane is x right and z up, rotations about +y.
struct Data {
  double length = 1.0;
  int elements = 1;
  CrossSection section{1, 1, 1, 1, 1};
  std::array<double, 2> start{0.0, 0.0};  ///< m
  double angle = 0.0;                     ///< phi0 at the start, from x towards z, rad
  double curvature = 0.0;                 ///< d(phi0)/dx, 1/m
  double gravity = 0.0;                   ///< along -z, m/s^2
  Geometry geometry = Geometry::interpolated;
  std::array<double, 2> velocity{0.0, 0.0};  ///< of the centre of mass, m/s
  double angular_velocity = 0.0;             ///< about +y, rad/s
  std::vector<double> u, v;                  ///< initial nodal values as in State; empty: rigid, unstrained
  std::array<Support, 2> supports{};         ///< of the start and the end
  std::vector<Load> loads;
  double horizon = 1.0;  ///< s, the time the scene runs to; sets the scale of what a constant load moves
};

/// Nodal displacements and rotations u = (ux, uz, phi) one node after the other, their rates v, and the
/// strains (epsilon, gamma, kappa) one integration point after the other. The strains follow from u, except
/// in a scheme that keeps them as a history of its own (see the README); the energy is that of the strains.
struct State {
  Eigen::VectorXd u, v, strain;
};

}  // namespace gnomon::planar_beam
