#pragma once
#include <string>
#include <vector>

#include "src/measure/timing.hpp"
#include "src/output/table.hpp"
#include "src/study/study.hpp"
#include "src/study/study_file.hpp"

namespace gnomon {

/// Time of one step of one scheme.
struct StepTime {
  std::string scene;
  std::string load;
  const SchemeInfo* scheme;
  double step;               ///< s
  long steps;                ///< a run
  double parts;              ///< equal parts of the system
  std::string instructions;  ///< the vector instructions; empty where there is no choice
  TimingStats run;           ///< of the whole run, s
  double ns() const { return 1e9 * run.median / static_cast<double>(steps); }
};

/// An integrator of gnomon against the same integration written without it.
struct WrapperTime {
  const Yardstick* yardstick;
  long evaluations;  ///< of gnomon's run
  long plain_evaluations;
  double difference;  ///< largest difference of the two final states, 0 where they are bitwise equal
  TimingStats wrapped, plain;
  double ratio() const { return wrapped.median / plain.median; }
};

/// A part of a step, timed by itself.
struct PartTime {
  const PartTask* task;
  TimingStats run;  ///< s
};

struct SpeedStudy {
  std::vector<StepTime> steps;
  std::vector<WrapperTime> wrappers;
  std::vector<PartTime> parts;
};

/// Steps of the named integrators, or of all.
SpeedStudy measure_speed(Runner& runner, const std::vector<SpeedPlan>& plans,
                         const std::vector<std::string>& integrators, bool quick);

output::Table step_times_table(const SpeedStudy& study);
output::Table wrapper_table(const SpeedStudy& study);
/// Variants by sizes, a table for each part that is timed.
std::vector<output::Table> parts_tables(const SpeedStudy& study);
nlohmann::ordered_json speed_json(const SpeedStudy& study);

}  // namespace gnomon
