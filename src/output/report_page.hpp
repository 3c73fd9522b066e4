#pragma once
// One self-contained HTML page of tables and figures.

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "src/output/figure.hpp"
#include "src/output/table.hpp"

namespace gnomon::output {

/// A part of the page with a heading and an entry in the list of contents.
struct ReportSection {
  std::string id;  ///< plain: letters, digits, '-', '_', '.'
  std::string heading;
  std::string command;  ///< that makes this part; may be empty
  std::vector<Table> tables;
  std::optional<Figure> figure;
  std::string svg;  ///< the figure drawn, for print and where scripts do not run; may be empty
};

struct ReportPage {
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  ///< name and value
  std::vector<Table> summary;                              ///< what stands first
  std::vector<ReportSection> sections;
};

/// The script of Chart.js 3 where Debian's libjs-chart.js has it; empty if it is not installed.
std::string chart_library(const std::filesystem::path& folder = "/usr/share/javascript/chart.js");

/// The page, to be opened from anywhere: scripts, styles and figures are in it and nothing is loaded. With a
/// `chart_script` (see chart_library) figures are interactive on a screen; without, they are the drawn ones
/// and the page says so. Throws std::runtime_error if the page's own script and style cannot be read.
std::string report_html(const ReportPage& page, const std::string& chart_script);

}  // namespace gnomon::output
