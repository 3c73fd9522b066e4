#pragma once

#include <optional>
#include <span>
#include <vector>

namespace gnomon {

/// One setting (step or tolerance) of one integrator: what it reached and what it cost. An error that is not
/// finite stands for a run that failed.
struct WorkPoint {
  double error = 0.0;
  double cost = 0.0;  ///< seconds, evaluations, ..
};

/// Cost of reaching `error`, interpolated in log error and log cost on a curve ordered from the loosest
/// setting to the tightest. A setting counts only if it and every tighter one reach the level: a lucky zero
/// of the error does not. Where nothing looser is there to interpolate with, the cost of the loosest setting
/// that counts, which is an upper bound. Nothing if no setting counts. Leave out runs stopped by a limit of
/// time or steps: they say nothing.
std::optional<double> cost_at(std::span<const WorkPoint> curve, double error);

/// For each point whether no other point is at least as good in error and cost and better in one of them.
/// Points that are not finite are never on the front.
std::vector<bool> pareto_front(std::span<const WorkPoint> points);

}  // namespace gnomon
