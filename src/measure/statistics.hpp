#pragma once

#include <vector>

namespace gnomon {

/// Quantile q in [0, 1] of the values by linear interpolation between order statistics (Hyndman & Fan 1996,
/// type 7). NaN if there are none.
double quantile(std::vector<double> values, double q);

/// The middle value, or the mean of the two middle ones. NaN if there are none.
double median(std::vector<double> values);

}  // namespace gnomon
