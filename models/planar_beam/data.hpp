#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "models/planar_beam/motion.hpp"

namespace gnomon::planar_beam {

/// Stiffness EA, GA_s [N], EI [N m^2], mass rho A [kg/m] and rotary inertia rho I [kg m] of the section.
struct CrossSection {
  double EA, GA, EI, rhoA, rhoI;
};

enum class Profile { constant, step, ramp, half_sine, table };
enum class Place { start, end, distributed, inside };

/// A load: force [N, or N/m where distributed] and moment about +y, times a function of time. The force of a
/// dead load keeps its direction in the fixed frame, that of a follower turns with the section of its end.
struct Load {
  Place at = Place::end;
  std::array<double, 2> force{0.0, 0.0};
  double moment = 0.0;
  Profile profile = Profile::constant;
  double duration = 0.0;  ///< s; of a step, ramp or half sine
  bool follower = false;
  Polyline table{};  ///< of a profile of that name
  double x = 0.0;    ///< arc length of a place inside, where two elements meet, m

  /// constant: 1; step: 1, then 0; ramp: from 0 to 1, then 1; half sine: sin(pi t/duration), then 0; table:
  /// its points.
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
      case Profile::table:
        return table.at(t);
    }
    return 0.0;
  }
  /// Its value after all changes.
  double final_factor() const {
    if (profile == Profile::table) return table.value.back();
    return profile == Profile::constant || profile == Profile::ramp ? 1.0 : 0.0;
  }
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
      case Profile::table:
        return table.integral(t);
    }
    return 0.0;
  }
};

/// What an end is held by: pinned holds the place, clamped the rotation too; a slide holds one of the two
/// components of the place. Motions hold what they prescribe. A spring acts against the rotation.
struct Support {
  bool place = false, rotation = false;
  std::optional<Motion> motion{};                       ///< of the rotation
  std::array<std::optional<Motion>, 2> displacement{};  ///< of the place, x and z
  std::optional<int> slide{};                           ///< the component of the place that is free: 0 or 1
  double spring = 0.0;                                  ///< N m/rad

  /// Whether component k of (x, z, rotation) is held or prescribed.
  bool holds(int k) const {
    if (motion_of(k)) return true;
    return k == 2 ? rotation : place && slide != k;
  }
  const Motion* motion_of(int k) const {
    const std::optional<Motion>& one = k == 2 ? motion : displacement[k];
    return one ? &*one : nullptr;
  }
  bool is_driven() const { return motion || displacement[0] || displacement[1]; }
};

/// A rigid joint at which the tangent at rest turns by an angle, from x towards z.
struct Bend {
  double at;     ///< arc length, m; where two elements meet
  double angle;  ///< rad
};

/// A joint at which both sides have one place and a rotation each. A spring acts against what the rotation on
/// the right exceeds that on the left.
struct Hinge {
  double at;            ///< arc length, m; where two elements meet
  double spring = 0.0;  ///< N m/rad
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
  double damping = 0.0;                   ///< 1/s, proportional to mass: the force -damping M v
  std::vector<Bend> bends;                ///< ascending
  std::vector<Hinge> hinges{};            ///< ascending
  Geometry geometry = Geometry::interpolated;
  std::array<double, 2> velocity{0.0, 0.0};  ///< of the centre of mass, m/s
  double angular_velocity = 0.0;             ///< about +y, rad/s
  std::vector<double> u, v;                  ///< initial nodal values as in State; empty: rigid, unstrained
  std::array<Support, 2> supports{};         ///< of the start and the end
  std::vector<Load> loads;
  /// Instructions of the kernels for linear elements: "scalar", the name of an InstructionSet, or empty: what
  /// fits.
  std::string instructions;
  double horizon = 1.0;  ///< s, the time the scene runs to; sets the scale of what a constant load moves
};

/// Nodal displacements and rotations u = (ux, uz, phi) one node after the other, a hinge's node once for each
/// of its sides, their rates v, and the
/// strains (epsilon, gamma, kappa) one integration point after the other. The strains follow from u, except
/// in a scheme that keeps them as a history of its own (see the README); the energy is that of the strains.
struct State {
  Eigen::VectorXd u, v, strain;
};

}  // namespace gnomon::planar_beam
