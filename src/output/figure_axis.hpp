#pragma once
// The range and the ticks of an axis.

#include <optional>
#include <string>
#include <vector>

#include "src/output/figure.hpp"

namespace gnomon::output {

struct Tick {
  double value = 0.0;
  std::string label;  ///< in gnuplot's enhanced text, e.g. "10^{−3}"; empty for a minor tick
};

struct Axis {
  bool log = true;
  Range range;
  std::vector<Tick> ticks;  ///< within the range, ascending

  /// 0 at the low end, 1 at the high end.
  double position(double value) const;
  /// A length of one decade, as a fraction of the axis; 0 on a linear axis.
  double decade() const;
};

/// Whether a value has a place on an axis: finite, positive on a log axis, not near the ends of double.
bool can_be_drawn(double value, bool log);

/// The range of all values that can be drawn; none if there are none.
std::optional<Range> range_of(const std::vector<double>& values, bool log);

std::optional<Range> united(const std::optional<Range>& a, const std::optional<Range>& b);

/// An axis that shows `data` with a small margin, or exactly `fixed` if that is a valid range. `labels` is
/// the number of tick labels it has room for, at least 6; two or more are made. A log axis labels powers of
/// ten, with minor ticks at their multiples if every power is labelled, else at the other powers; one that
/// spans less than two decades labels 1, 2 and 5 times them.
Axis make_axis(bool log, const std::optional<Range>& data, const std::optional<Range>& fixed, int labels);

/// Width in characters of the widest tick label as it is drawn (without the markup).
int widest_label(const Axis& axis);

}  // namespace gnomon::output
