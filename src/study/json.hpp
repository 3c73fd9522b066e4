#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "src/study/compare.hpp"
#include "src/study/converge.hpp"
#include "src/study/drift_study.hpp"
#include "src/study/study.hpp"

namespace gnomon {

/// What the user told the schemes.
nlohmann::ordered_json options_json(const SchemeOptions& options);
/// The same of a run with one scheme: null for what the scheme does not use.
nlohmann::ordered_json options_json(const SchemeOptions& options, const SchemeInfo& scheme);
/// RUN of a document.
nlohmann::ordered_json run_json(const Scene& scene, const Row& row);

/// The document of a command: environment, scenes with their references, runs, orders. Numbers keep 17
/// significant digits; what does not exist or is not finite is null.
class Document {
 public:
  Document(const Catalogue& catalogue, const std::string& command);
  void add(const SceneStudy& study);
  /// The same with "pareto" in every run and "costs", one an integrator and level of the error.
  void add_comparison(const Comparison& study);
  void add_orders(const std::string& scene, const std::vector<OrderRow>& orders);
  /// Adds "drifts", one a run and invariant.
  void add_drifts(const DriftStudy& study);
  nlohmann::ordered_json& json() { return json_; }
  std::string text() const;

 private:
  nlohmann::ordered_json json_;
};

}  // namespace gnomon
