#pragma once

#include <optional>
#include <span>

#include "src/measure/drift.hpp"

namespace gnomon {

/// The drift that one run of equal steps shows.
struct DriftAtStep {
  double step = 0.0;  ///< > 0
  Drift drift;
  double evaluations = 0.0;  ///< of the rates, steps or iterations, whichever are most
  bool iterates = false;     ///< solves nonlinear equations, whose residue does not fall with the step either
};

/// How the drift falls with the step: ~ h^exponent.
struct DriftScaling {
  double exponent = Drift::none;  ///< Theil-Sen slope of log drift against log step
  bool of_slope = false;          ///< of |slope|, of secular drifts; else of max |d|, of bounded ones
  int points = 0;                 ///< runs that count
};

/// Takes the secular runs if there are more of them than of bounded ones, else the bounded ones; runs of any
/// other verdict do not count, nor slopes within three of their standard errors, nor drifts up to 1e-11,
/// which may be roundoff. None if fewer than three different steps are left.
std::optional<DriftScaling> drift_scaling(std::span<const DriftAtStep> runs);

/// Whether a drift above what a random walk of rounding explains may still be biased rounding, so that only a
/// run with another step can tell: secular, bounded or undecided and at most u = 2^-52 an evaluation.
bool may_be_biased_rounding(const DriftAtStep& run);

/// Finds biased rounding among the runs of one scheme: two that may be such, their steps apart by a factor of
/// 3/4 or more, become roundoff, or a Newton residue where the scheme iterates, if the drift at the smaller
/// step is at least 0.7 of the other. A truncation error would have fallen.
void tell_rounding(std::span<DriftAtStep> runs);

}  // namespace gnomon
