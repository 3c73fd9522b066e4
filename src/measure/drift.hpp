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
  bounded,   ///< oscillates, or comes to rest, within a bound that does not grow and is no tenth of its scale
  secular,   ///< moves away for as long as the run lasts
  roundoff,  ///< at the level of rounding, which grows like a random walk (Brouwer 1937)
  dissipated,  ///< lost, hardly any of it regained, and the loss has levelled off
  newton,      ///< of what the scheme conserves: no larger than what its Newton iteration leaves
  saturated,   ///< moved away until it could go no further
  far_off,     ///< off by more than a tenth of its scale, whatever it does there
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

/// What rounding alone makes of an invariant in so many evaluations of the rates or steps, relative to its
/// scale: 4 u sqrt(n), u = 2^-52, a random walk with four standard deviations of its end, one rounding of u
/// in each; at least 1e-13, for the initial rounding and the evaluation of the invariant itself. Measured on
/// rigid bodies: up to 1.1 u sqrt(n). Biased rounding, up to u n, cannot be told from a truncation error in
/// one run; see tell_rounding in drift_scaling.hpp.
double rounding_level(double evaluations);

/// Drift of an invariant from its signed errors d at the given times, in any order. The errors are relative
/// to the invariant's scale, so that 1e-13 is the size of rounding; `start` is the time at which the error is
/// zero by definition. Sample at jittered times: equal steps can hide an oscillation of the same period.
/// With b +- s the slope of the line through (up to) 64 block means, A the oscillation, T the time span:
///   roundoff  if and only if max |d| <= r, the `rounding` of the run;
///   dissipated  if d falls below -1e-9, never regains a tenth of what it lost and loses less than a quarter
///             of it in the second half of the run; secular if it loses more;
///   secular   if |b| > 3 s and |b| T > A, unless the error dies away; also if it grows faster than a line,
///             which shows in the blocks: alpha > 1.2, the block means move one way (sign test of their
///             increments, four standard errors) and the second half confirms it;
///   saturated otherwise if max |d| > 1e-2, d grew by a factor of four or more in the three doublings of time
///             before it reached half of that, at the ninth sample or later, and has not come back to a
///             quarter of it in the second half of the run;
///   far off   otherwise if max |d| > 0.1;
///   bounded   otherwise if alpha < 0.1;
///   bounded   otherwise if the blocks return to their line (correlation from one to the next below
///             1 - 2 / sqrt(n)) and the largest |d| of the second half is at most 1.5 times the first's;
///   undecided otherwise.
/// "Bounded" says little of the size: show max |d| beside it. Below 32 samples only max |d| decides. Throws
/// std::invalid_argument if the lengths differ.
Drift measure_drift(std::span<const double> times, std::span<const double> errors, double start,
                    double rounding = rounding_level(0.0));

/// What the verdicts mean that do not speak for themselves, for a note.
inline constexpr const char* verdict_marks =
    "roundoff: not above what a random walk of the roundings of all evaluations reaches, 4 u sqrt(n), or "
    "1e-13; "
    "bounded: does not grow, and stays below a tenth of the scale; saturated: moved away by more than 1 % of "
    "the scale until it could go no further; far off: by more than a tenth of the scale";

/// Calls a drift that is secular or undecided a Newton residue where it is at most the relative tolerance of
/// the nonlinear equations: of an invariant that the scheme conserves when these are solved exactly.
void allow_newton_residue(Drift& drift, double newton_tol);

/// Why a drift is undecided, in one line; empty if it is not.
std::string why_undecided(const Drift& drift);

/// n increasing times in (t0, t1], one at random in each of n equal parts, the last at t1. The same seed
/// gives the same times on every machine. Throws std::invalid_argument unless t0 < t1 are finite.
std::vector<double> jittered_times(double t0, double t1, int n, std::uint64_t seed);

}  // namespace gnomon
