#include "src/cli/study_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "src/cli/files.hpp"
#include "src/output/files.hpp"

namespace gnomon::cli {
namespace {

std::string fact(const nlohmann::ordered_json& value) {
  if (value.is_string()) return value;
  if (!value.is_object()) return value.dump();
  std::string text;
  for (const auto& [name, each] : value.items())
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", name, fact(each));
  return text;
}

}  // namespace

void StudyFolder::publish(output::ReportSection section, const Document& document) {
  if (counting) {
    sections_.push_back(std::move(section));
    return;
  }
  write_study(folder_, section.id, section.tables, document, section.figure,
              section.command.empty() ? "" : fmt::format("`{}`\n\n", section.command));
  const std::string drawn = fmt::format("{}/{}.svg", folder_, section.id);
  if (section.figure && std::filesystem::exists(drawn)) section.svg = output::read_file(drawn);
  sections_.push_back(std::move(section));
}

void StudyFolder::lead_with_last(std::size_t first) {
  std::rotate(sections_.begin() + static_cast<std::ptrdiff_t>(first), sections_.end() - 1, sections_.end());
}

void StudyFolder::summarise_last(output::Table table) {
  sections_.pop_back();
  summary_.push_back(std::move(table));
}

void StudyFolder::clear() {
  sections_.clear();
  summary_.clear();
  counts = {};
  fastest = {};
}

std::string StudyFolder::text(const std::string& name) const {
  return output::read_file(fmt::format("{}/{}.md", folder_, name));
}

void StudyFolder::write_page() const {
  output::ReportPage page;
  page.title = session_.quick ? "gnomon: quick study" : "gnomon: study";
  for (const auto& [name, value] : session_.environment.items()) page.facts.emplace_back(name, fact(value));
  page.summary = summary_;
  if (!fastest.empty()) page.summary.push_back(fastest.table());
  page.summary.push_back(counts.table());
  page.sections = sections_;
  output::write_file_atomically(folder_ + "/report.html", output::report_html(page, output::chart_library()));
}

void StudyFolder::write_index(const std::vector<Entry>& parts) const {
  std::string text = "# Results\n\nWritten by `./gnomon bench";
  text += fmt::format("{}{}`.\n\n", session_.quick ? " --quick" : "", session_.timed ? "" : " --no-timing");
  for (const auto& [key, value] : session_.environment.items())
    text += fmt::format("- {}: {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
  for (const Entry& part : parts) {
    text += fmt::format("\n## {}\n\n", part.heading);
    const std::string content = this->text(part.name);
    // The table of runs is in the part's own page.
    text += content.substr(0, content.find("**Runs**"));
    text +=
        fmt::format("\nAll of it: [{0}.md]({0}.md), [{0}.csv]({0}.csv), [{0}.json]({0}.json)\n", part.name);
  }
  output::write_file_atomically(folder_ + "/README.md", text);
  for (const Entry& part : parts)
    if (part.name.ends_with("-scorecard") || part.name.ends_with("-orders") ||
        part.name.ends_with("-speed") || part.name.starts_with("peers-")) {
      const std::string content = this->text(part.name);
      say(request_, content.substr(0, content.find("**Runs**")));
    }
  say(request_, fmt::format("wrote {0} parts to {1}; start with {1}/report.html or {1}/README.md",
                            parts.size(), folder_));
}

}  // namespace gnomon::cli
