#pragma once
#include <nlohmann/json.hpp>

#include "src/output/figure.hpp"
#include "src/output/table.hpp"
#include "src/study/stability.hpp"

namespace gnomon {

/// One row a scene and scheme: the largest step and how the next larger one fails.
output::Table stability_table(const Stability& study);
/// One row a scene and scheme, one column a step of the ladder: "ok", or what fails and when.
output::Table stability_map(const Stability& study);
/// Without a variation the largest drift against the step. With one a map, a panel a scheme: the steps that
/// were tried against the value, marked by whether and how they fail.
output::Figure stability_figure(const Catalogue& catalogue, const Stability& study);
/// "stability": one entry a scene and scheme.
nlohmann::ordered_json stability_json(const Stability& study);

}  // namespace gnomon
