#pragma once
#include <string>
#include <vector>

#include "src/output/table.hpp"
#include "src/study/compare.hpp"

namespace gnomon {

/// How the runs of a study ended, part by part.
class RunCounts {
 public:
  /// Studies of one part follow one another.
  void add(const std::string& part, const SceneStudy& study);
  /// One column a status that occurred; runs that crashed or were ended are told with their reasons.
  output::Table table() const;

 private:
  struct Part {
    std::string name;
    std::vector<std::pair<Status, long>> counts;
  };
  std::vector<Part> parts_;
  std::vector<std::string> failures_;
};

/// The scheme that reaches each level of the error in the least CPU time, scene by scene.
class Fastest {
 public:
  void add(const Comparison& study);
  bool empty() const { return rows_.empty(); }
  output::Table table() const;

 private:
  std::vector<double> levels_;
  std::vector<std::vector<output::Cell>> rows_;
};

}  // namespace gnomon
