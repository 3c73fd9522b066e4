#pragma once
// The files of a study beside its store: each part's tables and figures, an index and one page of all.

#include <string>
#include <vector>

#include "src/cli/command.hpp"
#include "src/cli/session.hpp"
#include "src/output/report_page.hpp"
#include "src/study/summary.hpp"

namespace gnomon::cli {

/// What a study has written so far, and what its page begins with.
class StudyFolder {
 public:
  struct Entry {
    std::string name;     ///< stem of the part's files
    std::string heading;  ///< in the index
  };

  StudyFolder(const Request& request, const Session& session, std::string folder)
      : request_(request), session_(session), folder_(std::move(folder)) {}

  /// Writes the files of a part and keeps it for the page.
  void publish(output::ReportSection section, const Document& document);
  /// The section that was written last moves before those since `first`, which it sums up.
  void lead_with_last(std::size_t first);
  /// Takes the last section off the page, which begins with `table` in its place.
  void summarise_last(output::Table table);
  std::size_t sections() const { return sections_.size(); }
  /// The text of a part, in Markdown.
  std::string text(const std::string& name) const;
  /// README.md; what sums up a part is printed, too.
  void write_index(const std::vector<Entry>& parts) const;
  /// report.html.
  void write_page() const;

  RunCounts counts;
  Fastest fastest;
  bool counting = false;  ///< only what has to be made is counted: nothing is written
  /// Forgets what was kept while counting.
  void clear();

 private:
  const Request& request_;
  const Session& session_;
  std::string folder_;
  std::vector<output::ReportSection> sections_;
  std::vector<output::Table> summary_;
};

}  // namespace gnomon::cli
