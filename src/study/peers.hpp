#pragma once
#include <optional>
#include <string>
#include <vector>

#include "src/measure/timing.hpp"
#include "src/output/table.hpp"
#include "src/study/study.hpp"
#include "src/study/study_file.hpp"

namespace gnomon {

/// The loosest setting that reaches a level of the error, and what it costs.
struct LevelTime {
  Setting setting;
  double error;
  long evaluations;
  TimingStats run;       ///< s
  bool loosest = false;  ///< no looser setting was tried: it takes no more than this
};

/// One integrator, of ours or of another library.
struct PeerRow {
  std::string name;
  bool peer;
  bool closed_form;
  std::vector<std::optional<LevelTime>> levels;
};

struct PeerStudy {
  PeerPlan plan;
  std::string metric;  ///< with its unit
  std::vector<PeerRow> rows;
  /// Least time of the peers and of our stepping schemes at a level, s; none where none reaches it.
  std::optional<double> best(std::size_t level, bool peer) const;
};

/// The place of the loosest setting that counts at a level of the error: one that reaches it together with
/// the two next tighter ones, so that a lucky zero of the error does not. Errors are ordered from the loosest
/// setting to the tightest; one that is not finite stands for a run that failed.
std::optional<std::size_t> loosest_that_counts(const std::vector<double>& errors, double level);

/// Runs ladders of steps and tolerances, then times the settings that count, all of them interleaved.
PeerStudy measure_peers(Runner& runner, const PeerPlan& plan, bool quick);

/// One row an integrator: time at each level and its ratio to that of the best peer.
output::Table peers_table(const PeerStudy& study);
/// One row an integrator and level.
output::Table peer_runs_table(const PeerStudy& study);
nlohmann::ordered_json peers_json(const PeerStudy& study);

}  // namespace gnomon
