#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

/// What a long run shows about an invariant.
enum class DriftVerdict {
  bounded,     ///< oscillates, or comes to rest, within a bound that does not grow
  secular,     ///< moves away for as long as the run lasts
  roundoff,    ///< at the level of rounding, or growing there like a random walk (Brouwer 1937)
  dissipated,  ///< lost, hardly any of it regained, and the loss has levelled off
  newton,      ///< of what the scheme conserves: no larger than what its Newton iteration leaves
  undecided,   ///< too few samples, or growth that this time span cannot tell apart
  failed       ///< no samples, or not all of them finite
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
///   dissipated  if d falls below -1e-9, never regains a tenth of what it lost and loses less than a quarter
///             of it in the second half of the run; secular if it loses more;
///   secular   if |b| > 3 s and |b| T > A, unless the error dies away; also if it grows faster than a line,
///             which shows in the blocks: alpha > 1.2, the block means move one way (sign test of their
///             increments, four standard errors) and the second half confirms it;
///   bounded   otherwise if alpha < 0.1;
///   roundoff  otherwise if max |d| < 1e-9;
///   bounded   otherwise if the blocks return to their line (correlation from one to the next below
///             1 - 2 / sqrt(n)) and the largest |d| of the second half is at most 1.5 times the first's;
///   undecided otherwise.
/// "Bounded" says nothing of the size: show max |d| beside it. Below 32 samples only max |d| decides. Throws
/// std::invalid_argument if the lengths differ.
Drift measure_drift(std::span<const double> times, std::span<const double> errors, double start);

/// Calls a drift that is secular or undecided a Newton residue where it is at most the relative tolerance of
/// the nonlinear equations: of an invariant that the scheme conserves when these are solved exactly.
void allow_newton_residue(Drift& drift, double newton_tol);

/// Why a drift is undecided, in one line; empty if it is not.
std::string why_undecided(const Drift& drift);

/// n increasing times in (t0, t1], one at random in each of n equal parts, the last at t1. The same seed
/// gives the same times on every machine. Throws std::invalid_argument unless t0 < t1 are finite.
std::vector<double> jittered_times(double t0, double t1, int n, std::uint64_t seed);

}  // namespace gnomon
