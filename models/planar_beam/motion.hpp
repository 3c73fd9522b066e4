#pragma once
#include <vector>

namespace gnomon::planar_beam {

/// A function of time: points joined by straight lines, constant before the first and after the last. Times
/// ascend.
struct Polyline {
  std::vector<double> t, value;

  double at(double time) const;
  double slope_before(double time) const;
  double slope_after(double time) const;
  /// int from t[0] to `time`, which is not before t[0].
  double integral(double time) const;
};

enum class MotionKind { ramp, half_sine, spin_up, table };

/// A prescribed rotation about +y [rad] or displacement [m] s(t), 0 and at rest before t = 0.
/// ramp: to t/over, then `to`. half_sine: to sin(pi t/over), then 0. table: its points, the first at (0, 0).
/// spin_up: s'' = (to/over) (1 - cos(2 pi t/over)), so that s' is `to` from `over` on,
///   s = (to/over) [t^2/2 + (over/2pi)^2 (cos(2 pi t/over) - 1)], then to (t - over/2)
///   (J.C. Simo, L. Vu-Quoc, J. Appl. Mech. 53 (1986) 855-863, section 3.2).
struct Motion {
  double to = 0.0;    ///< of spin_up a rate, rad/s or m/s
  double over = 1.0;  ///< s; of a table the time of its last point
  MotionKind kind = MotionKind::ramp;
  Polyline table{};

  double value(double t) const;
  /// s'(t-) and s'(t+).
  double rate_before(double t) const { return rate(t, true); }
  double rate_after(double t) const { return rate(t, false); }
  /// s''(t+); what a jump of s' would add is left out.
  double acceleration_after(double t) const;
  /// Where s' or s'' may jump, 0 included, ascending.
  std::vector<double> breaks() const;
  /// A break that is nearer to t than `tolerance`, else t: for times that are multiples of a step.
  double snapped(double t, double tolerance) const;
  bool ends_at_rest() const { return kind != MotionKind::spin_up; }
  /// Its value in the end; of a motion that ends at rest.
  double final_value() const;
  double largest_rate() const;

 private:
  double rate(double t, bool before) const;
};

}  // namespace gnomon::planar_beam
