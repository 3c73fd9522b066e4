#pragma once

namespace gnomon::beam {

/// The moment that a hinge's torsion spring exerts in a step, positive on its right side, N m, and its
/// derivatives by the mean angular velocities on both sides.
struct HingeMoment {
  double moment, by_left, by_right;
};

/// Of a spring that is turned by `angle` [rad] when the step of size h begins, at the mean angular velocities
/// `left` and `right`. Where rotations advance by those, it is that of the mean angle. By the Cayley map,
/// where with z = h omega/2 the angle grows by 2 (atan z_right - atan z_left), that times (atan z_right -
/// atan z_left)/(z_right - z_left). Either way its work is the change of the spring's energy.
HingeMoment hinge_moment(bool cayley, double stiffness, double angle, double left, double right, double h);

}  // namespace gnomon::beam
