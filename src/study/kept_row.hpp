#pragma once
#include <nlohmann/json.hpp>

#include "src/measure/timing.hpp"
#include "src/study/study.hpp"

namespace gnomon {

/// A run as a store keeps it: {"run": RUN}, and with `drifts` what a long run shows of each invariant.
nlohmann::ordered_json row_json(const Scene& scene, const Row& row, bool drifts);
/// All of the row that tables, figures and documents show; its states are in `document` only. Throws
/// nlohmann::json::exception if the JSON is not that of a row.
Row restore_row(const Scene& scene, const SchemeInfo& scheme, const Setting& setting,
                const nlohmann::ordered_json& json);
/// The row of a run that ended its process.
Row failed_row(const Scene& scene, const SchemeInfo& scheme, const Setting& setting, Status status,
               const std::string& message);

nlohmann::ordered_json timing_json(const TimingStats& stats);
TimingStats restore_timing(const nlohmann::ordered_json& json);

/// All of a reference but its states.
nlohmann::ordered_json reference_json(const ReferenceStates& reference);
ReferenceStates restore_reference(const nlohmann::ordered_json& json);

}  // namespace gnomon
