#pragma once

#include <span>
#include <vector>

namespace gnomon {

/// Quantile q in [0, 1] of the values by linear interpolation between order statistics (Hyndman & Fan 1996,
/// type 7). NaN if there are none.
double quantile(std::vector<double> values, double q);

/// The middle value, or the mean of the two middle ones. NaN if there are none.
double median(std::vector<double> values);

/// Theil-Sen slope: the median of the slopes between all pairs of points (Theil 1950, Sen 1968); pairs with
/// equal x are left out. NaN if there are none. Throws std::invalid_argument if the lengths differ.
double theil_sen_slope(std::span<const double> x, std::span<const double> y);

}  // namespace gnomon
