#include "src/cli/files.hpp"

#include <fmt/format.h>

#include <iostream>

#include "src/output/files.hpp"
#include "src/output/latex.hpp"

namespace gnomon::cli {
namespace {

/// A name as it may stand in names of files and in links: "a[b.c=1]" becomes "a-b.c=1".
std::string file_name(const std::string& name) {
  std::string result;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_' || c == '.' || c == '=' || c == '+';
    if (plain)
      result += c;
    else if (c != ']' && c != '"')
      result += '-';
  }
  return result;
}

}  // namespace

std::vector<std::string> write_study(const std::string& folder, const std::string& name,
                                     const std::vector<output::Table>& tables, const Document& document,
                                     const std::optional<output::Figure>& figure,
                                     const std::string& heading) {
  const std::string stem = file_name(name);
  std::vector<std::string> written;
  const auto write = [&](const std::string& suffix, const std::string& text) {
    const std::string path = fmt::format("{}/{}{}", folder, stem, suffix);
    output::write_file_atomically(path, text);
    written.push_back(path);
  };
  std::string markdown = heading;
  if (figure) {
    const output::FigureResult result = output::write_figure(*figure, fmt::format("{}/{}", folder, stem));
    if (result) {
      written.push_back(fmt::format("{}/{}.svg", folder, stem));
      written.push_back(fmt::format("{}/{}.png", folder, stem));
      if (result.has_pdf) written.push_back(fmt::format("{}/{}.pdf", folder, stem));
      markdown += fmt::format("![{}]({}.svg)\n\n", figure->title, stem);
    } else {
      std::cerr << fmt::format("gnomon: no figure {}: {}\n", stem, result.message);
    }
  }
  for (const output::Table& table : tables) markdown += output::to_markdown(table) + "\n";
  write(".md", markdown);
  if (!tables.empty()) write(".csv", output::to_csv(tables.front()));
  if (!tables.empty()) write(".tex", output::latex_document(tables));
  write(".json", document.text());
  return written;
}

}  // namespace gnomon::cli
