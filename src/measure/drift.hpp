#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

namespace gnomon {

/// What a long run shows about an invariant.
enum class DriftVerdict {
  bounded,    ///< oscillates, or comes to rest, within a bound that does not grow
  secular,    ///< moves away for as long as the run lasts
  roundoff,   ///< at the level of rounding, or growing there like a random walk (Brouwer 1937)
  undecided,  ///< too few samples, or growth that this time span cannot tell apart
  failed      ///< no samples, or not all of them finite
};

std::string_view to_string(DriftVerdict verdict);

struct Drift {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double max_abs = none;      ///< largest |d|
  double oscillation = none;  ///< half the 1-99 % range of d after its line is taken out
  double slope = none;        ///< of the line through the block means, per unit of time
  double slope_error = none;  ///< its standard error, autocorrelation of the blocks taken into account
  double growth = none;       ///< exponent alpha in max |d| ~ t^alpha over doubling windows
  DriftVerdict verdict = DriftVerdict::failed;
};

/// Drift of an invariant from its signed errors d at the given times, in any order. The errors are relative
/// to the invariant's scale, so that 1e-13 is the size of rounding; `start` is the time at which the error is
/// zero by definition. Sample at jittered times: equal steps can hide an oscillation of the same period.
/// With b +- s the slope of the line through (up to) 64 block means, A the oscillation, T the time span:
///   roundoff  if max |d| <= 1e-13;
///   secular   if |b| > 3 s and |b| T > A, unless the error dies away; also if alpha > 0.8 and the second
///             half of the run confirms it (1.5 below 1e-9, where a random walk may reach 1);
///   bounded   otherwise if alpha < 0.1;
///   roundoff  otherwise if max |d| < 1e-9;  undecided otherwise.
/// "Bounded" says nothing of the size: show max |d| beside it. Below 32 samples only max |d| decides. Throws
/// std::invalid_argument if the lengths differ.
Drift measure_drift(std::span<const double> times, std::span<const double> errors, double start);

/// n increasing times in (t0, t1], one at random in each of n equal parts, the last at t1. The same seed
/// gives the same times on every machine. Throws std::invalid_argument unless t0 < t1 are finite.
std::vector<double> jittered_times(double t0, double t1, int n, std::uint64_t seed);

}  // namespace gnomon
