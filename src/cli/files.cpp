#include "src/cli/files.hpp"

#include <fmt/format.h>

#include <iostream>

#include "src/output/files.hpp"

namespace gnomon::cli {

std::vector<std::string> write_study(const std::string& folder, const std::string& stem,
                                     const std::vector<output::Table>& tables, const Document& document,
                                     const std::optional<output::Figure>& figure,
                                     const std::string& heading) {
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
      markdown += fmt::format("![{}]({}.svg)\n\n", figure->title, stem);
    } else {
      std::cerr << fmt::format("gnomon: no figure {}: {}\n", stem, result.message);
    }
  }
  for (const output::Table& table : tables) markdown += output::to_markdown(table) + "\n";
  write(".md", markdown);
  if (!tables.empty()) write(".csv", output::to_csv(tables.front()));
  write(".json", document.text());
  return written;
}

}  // namespace gnomon::cli
