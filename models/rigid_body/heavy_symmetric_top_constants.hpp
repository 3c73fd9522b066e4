#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "models/rigid_body/exact_free_top.hpp"

namespace gnomon::rigid_body {

/// About twice the digits of extended precision.
using WideReal = detail::TwoReals<long double>;

/// A top with the moments (I1, I1, I3), its centre on the third axis of the body, torque > 0 [N m] of the
/// weight on the axis when that is horizontal, and its state at t = 0. The orientation (w, x, y, z), body ->
/// space, need not be of unit length.
struct HeavyTopData {
  long double transverse, axial;
  WideReal torque;
  std::array<WideReal, 4> orientation;
  std::array<long double, 3> angular_momentum;

  /// Of a body with the symmetry axis `axis`, 0 to 2, and its centre at `height` [m] on it, in the axes
  /// top_axes(). The data are taken as they are, without any rounding.
  static HeavyTopData of(const Eigen::Vector3d& inertia, double weight, double height, int axis,
                         const Eigen::Quaterniond& orientation, const Eigen::Vector3d& angular_momentum);
};

/// Right-handed axes with the third along the axis `axis` of a body, or against it unless upright, as a turn
/// from these axes to those of the body; permutations, but for signs.
Eigen::Quaterniond top_axes(int axis, bool upright);

/// What the closed form of the heavy symmetric top has as constants. z is the cosine of the angle between the
/// axis and the vertical, z1 <= z2 <= 1 <= z3 the roots of the cubic of its motion.
struct HeavyTopConstants {
  bool steady = true;            ///< z stays as it is, at z1 = z2; all from `range` on is then not set
  long double sum, difference;   ///< Lz + L3, Lz - L3
  long double above, below;      ///< 1 + z and 1 - z at t = 0
  long double up, down;          ///< 1 + z1, 1 - z2, exactly 0 where the axis passes through the vertical
  long double transverse_most;   ///< of the momentum across the axis
  long double range = 0;         ///< z2 - z1
  long double rate;              ///< lambda, of the argument of sn [1/s]
  long double k, k1;             ///< the moduli
  std::array<long double, 3> v;  ///< sn, cn and dn at t = 0; sn has the sign of z'
  /// Relative error of k1^2; absolute where k1 = 0; 0 if the data are such that none of the differences that
  /// vanish on the separatrix was rounded.
  long double separation_error;
};

/// The constants to extended precision for the data as given, also beside the separatrix.
///
/// There z2 = z3 = 1, and k1^2 = (z3 - z2)/(z3 - z1) is the difference of nearly equal numbers. The cubic in
/// e = z - 1 is f3 e^3 + (2 f3 - P1 - L3^2) e^2 - 2 (P1 - D L3) e - D^2, f3 = 2 I1 torque, D = Lz - L3, and
/// P1 the square of the momentum across the axis that the energy leaves for the upper vertical, negative if
/// it is out of reach. D and P1, which vanish on the separatrix, are formed from the data with twice the
/// digits, and e2 and e3 come from their product -D^2/(f3 |e1|) and their sum, so that e3 - e2 is a root of a
/// sum of positive terms.
HeavyTopConstants heavy_top_constants(const HeavyTopData& data);

}  // namespace gnomon::rigid_body
