#include "src/output/figure.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <string_view>
#include <system_error>

#include "src/output/figure_layout.hpp"
#include "src/output/figure_script.hpp"
#include "src/output/files.hpp"
#include "src/output/text.hpp"

extern char** environ;

namespace gnomon::output {
namespace {

namespace fs = std::filesystem;

/// A new folder beside the figures, so that they can be renamed into place; removed with its content at the
/// end.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const fs::path& parent) {
    std::string name = (parent / ".gnomon-figure-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw std::system_error(errno, std::generic_category(), "cannot write in '" + parent.string() + "'");
    }
    path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// The environment with a fixed locale, so that numbers and text do not depend on the user's.
std::vector<std::string> fixed_environment() {
  // Cairo dates its PDF by the second variable, so that they do not differ by it.
  std::vector<std::string> variables = {"LC_ALL=C.UTF-8", "SOURCE_DATE_EPOCH=0"};
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view variable = *entry;
    const bool replaced = variable.starts_with("LC_") || variable.starts_with("LANG") ||
                          variable.starts_with("GNUTERM=") || variable.starts_with("GNUPLOT_") ||
                          variable.starts_with("SOURCE_DATE_EPOCH=");
    if (!replaced) variables.emplace_back(variable);
  }
  return variables;
}

/// Runs gnuplot on figure.gp in `folder`, with that as its working folder. Returns what went wrong, or
/// nothing.
std::string run(const std::string& gnuplot, const fs::path& folder) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "messages", O_WRONLY | O_CREAT | O_APPEND, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  std::vector<std::string> variables = fixed_environment();
  std::vector<char*> environment;
  for (std::string& variable : variables) environment.push_back(variable.data());
  environment.push_back(nullptr);
  // -d: the user's own start-up files must not change the figure.
  std::string program = gnuplot;
  std::string option = "-d";
  std::string file = "figure.gp";
  char* arguments[] = {program.data(), option.data(), file.data(), nullptr};
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments, environment.data());
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    return fmt::format("cannot start '{}': {}", gnuplot, std::generic_category().message(error));
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return fmt::format("cannot wait for '{}'", gnuplot);
  }
  if (WIFSIGNALED(status)) return fmt::format("'{}' was ended by signal {}", gnuplot, WTERMSIG(status));
  if (WEXITSTATUS(status) == 0) return "";
  const std::string messages = read_file(folder / "messages");
  return fmt::format("'{}' ended with code {}: {}", gnuplot, WEXITSTATUS(status),
                     plain_text(messages.substr(0, 500)));
}

std::string xml_text(const std::string& text) {
  std::string result;
  for (const char c : plain_text(text)) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else {
      result += c;
    }
  }
  return result;
}

void replace_all(std::string& text, std::string_view from, const std::string& to) {
  for (std::size_t i = text.find(from); i != std::string::npos; i = text.find(from, i + to.size())) {
    text.replace(i, from.size(), to);
  }
}

/// Gives the definitions of markers, "<path id='gpPt7' stroke-width='0.178' ..", a stronger line, in units of
/// the marker's size.
void strengthen_markers(std::string& svg) {
  const std::string_view definition = "id='gpPt";
  const std::string_view attribute = "stroke-width='";
  for (std::size_t i = svg.find(definition); i != std::string::npos; i = svg.find(definition, i + 1)) {
    const std::size_t line_end = svg.find('\n', i);
    const std::size_t found = svg.find(attribute, i);
    if (found >= line_end) continue;
    const std::size_t begin = found + attribute.size();
    svg.replace(begin, svg.find('\'', begin) - begin, "0.45");
  }
}

/// Names the document, lets viewers without the font choose a similar one, and draws hollow markers with
/// lines as strong as in the PNG.
void complete_svg(std::string& svg, const Figure& figure) {
  const std::string& name = figure.caption.empty() ? figure.title : figure.caption;
  const std::string_view placeholder = "<title>Gnuplot</title>";
  const std::size_t title = svg.find(placeholder);
  if (title != std::string::npos)
    svg.replace(title, placeholder.size(), "<title>" + xml_text(name) + "</title>");
  strengthen_markers(svg);
  replace_all(svg, "font-family=\"DejaVu Sans\"", "font-family=\"DejaVu Sans, Verdana, sans-serif\"");
}

bool is_whole_svg(const std::string& svg) {
  return svg.starts_with("<?xml") &&
         svg.find("</svg>", svg.size() - std::min<std::size_t>(svg.size(), 20)) != svg.npos;
}

bool is_whole_png(const std::string& png) {
  return png.starts_with("\x89PNG\r\n\x1a\n") && png.size() > 12 && png.substr(png.size() - 8, 4) == "IEND";
}

bool is_whole_pdf(const std::string& pdf) {
  return pdf.starts_with("%PDF-") &&
         pdf.find("%%EOF", pdf.size() - std::min<std::size_t>(pdf.size(), 10)) != pdf.npos;
}

/// Versions of Cairo that do not know SOURCE_DATE_EPOCH write the time of day into the PDF, in clear.
void remove_date(std::string& pdf) {
  const std::string_view begin = "/CreationDate (D:";
  const std::size_t at = pdf.find(begin);
  if (at == std::string::npos) return;
  for (std::size_t i = at + begin.size(), n = 0; n < 14 && i < pdf.size() && pdf[i] >= '0' && pdf[i] <= '9';
       ++i, ++n)
    pdf[i] = n == 0 ? '2' : n == 5 || n == 7 ? '1' : '0';
}

}  // namespace

FigureResult write_figure(const Figure& figure, const fs::path& stem, const std::string& gnuplot) {
  FigureResult result;
  const Drawing drawing = lay_out(figure);
  result.left_out = drawing.left_out;
  const bool has_data = std::any_of(drawing.panels.begin(), drawing.panels.end(),
                                    [](const DrawnPanel& panel) { return !panel.curves.empty(); });
  const auto failed = [&](const std::string& reason) {
    result.message = fmt::format("figure '{}' not written: {}", stem.string(), reason);
    return result;
  };
  if (!has_data) return failed("nothing to draw");
  try {
    const fs::path parent = stem.has_parent_path() ? stem.parent_path() : fs::path(".");
    fs::create_directories(parent);
    const TemporaryFolder folder(fs::canonical(parent));
    write_file_atomically(folder.path() / "figure.gp",
                          gnuplot_script(drawing, "figure.svg", "figure.png", "figure.pdf"));
    const std::string problem = run(gnuplot, folder.path());
    if (!problem.empty()) return failed(problem);
    std::string svg = read_file(folder.path() / "figure.svg");
    const std::string png = read_file(folder.path() / "figure.png");
    if (!is_whole_svg(svg) || !is_whole_png(png))
      return failed(fmt::format("'{}' left it incomplete", gnuplot));
    complete_svg(svg, figure);
    write_file_atomically(stem.string() + ".svg", svg);
    write_file_atomically(stem.string() + ".png", png);
    if (fs::exists(folder.path() / "figure.pdf")) {
      std::string pdf = read_file(folder.path() / "figure.pdf");
      if (!is_whole_pdf(pdf)) return failed(fmt::format("'{}' left the PDF incomplete", gnuplot));
      remove_date(pdf);
      write_file_atomically(stem.string() + ".pdf", pdf);
      result.has_pdf = true;
    } else {
      fs::remove(stem.string() + ".pdf");
    }
    result.written = true;
    return result;
  } catch (const std::exception& error) {
    return failed(error.what());
  }
}

}  // namespace gnomon::output
