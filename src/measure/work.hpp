#pragma once

#include <cstddef>
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

/// Which setting stands for a level of the error: that at `place`, mixed with the next looser one.
struct LevelSetting {
  std::size_t place = 0;
  double looser_part = 0.0;  ///< of the logarithm of the next looser setting's cost; below 1
  bool upper_bound = false;  ///< nothing looser that ended well is there to interpolate with
  bool few = false;          ///< it rests on fewer than three settings: the curve ends there
};

struct LevelCost {
  double cost = 0.0;
  bool upper_bound = false;  ///< as in LevelSetting: it costs no more than this
  bool few = false;          ///< as there
};

/// The setting at which `error` is reached on a curve ordered from the loosest setting to the tightest: the
/// cheapest of all that count. A setting counts if it and the two next tighter ones, as far as there are any,
/// reach the level: a lucky zero of the error does not. Where the next looser setting misses the level, the
/// cost is interpolated between both in log error and log cost, so it never grows with `error`. Nothing if no
/// setting counts; nothing is ever extrapolated. A failed run misses every level. Leave out runs stopped by a
/// limit of time or steps: they say nothing.
std::optional<LevelSetting> level_setting(std::span<const WorkPoint> curve, double error);

/// Any cost of the settings of a curve, at the chosen one: other costs than the one by which it was chosen
/// are interpolated in the same way.
LevelCost cost_there(const LevelSetting& setting, std::span<const double> costs);

/// The cost by which the setting is chosen, there.
std::optional<LevelCost> level_cost(std::span<const WorkPoint> curve, double error);

/// The same without saying whether it is an upper bound.
std::optional<double> cost_at(std::span<const WorkPoint> curve, double error);

/// For each point whether no other point is at least as good in error and cost and better in one of them.
/// Points that are not finite are never on the front.
std::vector<bool> pareto_front(std::span<const WorkPoint> points);

}  // namespace gnomon
