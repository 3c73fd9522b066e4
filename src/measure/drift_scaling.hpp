#pragma once

#include <optional>
#include <span>

#include "src/measure/drift.hpp"

namespace gnomon {

/// The drift that one run of equal steps shows.
struct DriftAtStep {
  double step = 0.0;  ///< > 0
  Drift drift;
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

}  // namespace gnomon
