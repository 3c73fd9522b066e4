#include "src/output/figure.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "src/output/files.hpp"
#include "tests/catch.hpp"
#include "tests/output/contains.hpp"
#include "tests/output/sample_figures.hpp"
#include "tests/output/temporary_folder.hpp"

using namespace gnomon::output;
using namespace gnomon::test;
namespace fs = std::filesystem;

namespace {

/// Whether every element is closed in order; attributes are only skipped.
bool is_well_formed(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t i = xml.find('<'); i != std::string::npos; i = xml.find('<', i)) {
    std::size_t end = i + 1;
    for (char quote = '\0'; end < xml.size() && (quote != '\0' || xml[end] != '>'); ++end) {
      if (quote == '\0' && (xml[end] == '"' || xml[end] == '\'')) {
        quote = xml[end];
      } else if (xml[end] == quote) {
        quote = '\0';
      }
    }
    if (end >= xml.size()) return false;
    const std::string tag = xml.substr(i + 1, end - i - 1);
    const std::string name = tag.substr(0, tag.find_first_of(" \t\n/", 1));
    i = end;
    if (tag.front() == '?' || tag.front() == '!' || tag.back() == '/') continue;
    if (tag.front() != '/') {
      open.push_back(name);
    } else {
      if (open.empty() || open.back() != tag.substr(1)) return false;
      open.pop_back();
    }
  }
  return open.empty() && count(xml, "<svg") == 1;
}

unsigned big_endian(const std::string& bytes, std::size_t at) {
  unsigned value = 0;
  for (std::size_t k = 0; k < 4; ++k) value = 256U * value + static_cast<unsigned char>(bytes[at + k]);
  return value;
}

}  // namespace

TEST_CASE("output: a figure is written as SVG with its text and curves") {
  const TemporaryFolder folder;
  const Figure figure = work_precision();
  const FigureResult result = write_figure(figure, folder.path() / "sub" / "figure");
  INFO(result.message);
  REQUIRE(result);
  CHECK(result.left_out.empty());
  const std::string svg = read_file(folder.path() / "sub" / "figure.svg");
  CHECK(is_well_formed(svg));
  CHECK_FALSE(is_well_formed(svg.substr(0, svg.size() - 8)));
  for (const Series& series : figure.panels.front().series) {
    CAPTURE(series.label);
    CHECK(contains(svg, ">" + series.label + "</text>"));
  }
  CHECK(contains(svg, "CPU time [µs]</text>"));
  CHECK(contains(svg, ">reference’s error bound</text>"));
  CHECK(contains(svg, "<title>Error against CPU time</title>"));
  CHECK(contains(svg, "width=\"900\" height=\"600\""));
  // The curve of each scheme: a path in its colour within its group, which is named after it.
  const std::size_t group = svg.find("<title>rkmk4</title>");
  REQUIRE(group != std::string::npos);
  const std::string curve = svg.substr(group, svg.find("<title>", group + 1) - group);
  CHECK(contains(curve, "<path stroke='rgb(  0,   0,   0)' stroke-dasharray="));
  const std::size_t points = figure.panels.front().series[3].x.size();
  CHECK(count(curve, "L") == points - 1);
  CHECK(contains(svg,
                 "<tspan font-family=\"DejaVu Sans, Verdana, sans-serif\"  font-size=\"12.0\" "
                 "dy=\"-7.50px\">−12</tspan>"));
}

TEST_CASE("output: a figure is written as PNG with twice the pixels") {
  const TemporaryFolder folder;
  REQUIRE(write_figure(work_precision(), folder.path() / "one"));
  const std::string one = read_file(folder.path() / "one.png");
  CHECK(one.substr(0, 8) == "\x89PNG\r\n\x1a\n");
  CHECK(big_endian(one, 16) == 1800);
  CHECK(big_endian(one, 20) == 1200);
  CHECK(one.size() > 20000);  // an empty frame is far smaller
  REQUIRE(write_figure(work_precision_in_two_panels(), folder.path() / "two"));
  CHECK(big_endian(read_file(folder.path() / "two.png"), 16) == 2000);
  CHECK(folder.entries() == 6);  // nothing but the figures
}

TEST_CASE("output: a figure is written as PDF where gnuplot can, and without one elsewhere") {
  const TemporaryFolder folder;
  const FigureResult result = write_figure(convergence(), folder.path() / "a");
  REQUIRE(result);
  REQUIRE(result.has_pdf);
  const std::string pdf = read_file(folder.path() / "a.pdf");
  CHECK(pdf.starts_with("%PDF-"));
  CHECK(pdf.size() > 5000);
  // A gnuplot without that terminal leaves none, nor an older one.
  const fs::path program = folder.path() / "program";
  write_file_atomically(
      program,
      "#!/bin/sh\nsed -i \"s/, 'pdfcairo')/, 'no such terminal')/\" figure.gp\nexec gnuplot \"$@\"\n");
  ::chmod(program.c_str(), 0755);
  const FigureResult without = write_figure(convergence(), folder.path() / "a", program.string());
  INFO(without.message);
  REQUIRE(without);
  CHECK_FALSE(without.has_pdf);
  CHECK(fs::exists(folder.path() / "a.svg"));
  CHECK(folder.entries() == 3);
}

TEST_CASE("output: the same data give the same bytes, other data do not") {
  const TemporaryFolder folder;
  REQUIRE(write_figure(convergence(), folder.path() / "a"));
  REQUIRE(write_figure(convergence(), folder.path() / "other" / "b"));
  Figure changed = convergence();
  changed.panels.front().series[0].y[3] *= 2.0;
  REQUIRE(write_figure(changed, folder.path() / "c"));
  for (const char* suffix : {".svg", ".png", ".pdf"}) {
    const auto content = [&](const char* name) {
      return read_file(folder.path() / (std::string(name) + suffix));
    };
    CHECK(content("a") == content("other/b"));
    CHECK(content("a") != content("c"));
  }
  const std::string svg = read_file(folder.path() / "a.svg");
  CHECK_FALSE(contains(svg, folder.path().string()));
}

TEST_CASE("output: the user's own gnuplot settings do not change a figure") {
  const TemporaryFolder folder;
  REQUIRE(write_figure(convergence(), folder.path() / "a"));
  write_file_atomically(folder.path() / ".gnuplot", "set object 1 rectangle from graph 0,0 to graph 1,1\n");
  const char* before = std::getenv("HOME");
  const std::string home = before != nullptr ? before : "/";
  ::setenv("HOME", folder.path().c_str(), 1);
  const FigureResult result = write_figure(convergence(), folder.path() / "b");
  ::setenv("HOME", home.c_str(), 1);
  REQUIRE(result);
  CHECK(read_file(folder.path() / "a.svg") == read_file(folder.path() / "b.svg"));
}

TEST_CASE("output: labels are shown as they are written") {
  const TemporaryFolder folder;
  Figure figure = convergence();
  auto& series = figure.panels.front().series;
  series[0].label = "a_b {c}^2 \"d\" it's <e> & f";
  series[1].label = "`touch evil` \\n %d @x ~y";
  series[2].label = "bytes \xff\xfe";
  figure.panels.front().x_label = "{/Bold x}_{y} [s]";
  figure.caption = "a < b & c";
  REQUIRE(write_figure(figure, folder.path() / "a"));
  const std::string svg = read_file(folder.path() / "a.svg");
  CHECK(is_well_formed(svg));
  CHECK(contains(svg, ">a_b {c}^2 \"d\" it's &lt;e> &amp; f</text>"));
  CHECK(contains(svg, ">`touch evil` \\n %d @x ~y</text>"));
  CHECK(contains(svg,
                 ">bytes ?"
                 "?</text>"));
  CHECK(contains(svg, ">{/Bold x}_{y} [s]</text>"));
  CHECK(contains(svg, "<title>a &lt; b &amp; c</title>"));
  CHECK(folder.entries() == 3);
}

TEST_CASE("output: paths need no particular characters") {
  const TemporaryFolder folder;
  const fs::path stem = folder.path() / "it's a \"folder\"\n\xff" / "fig.1 ü";
  const FigureResult result = write_figure(convergence(), stem);
  INFO(result.message);
  REQUIRE(result);
  CHECK(fs::exists(stem.string() + ".svg"));
  CHECK(fs::exists(stem.string() + ".png"));
}

TEST_CASE("output: a figure without gnuplot is a message, not a failure of the program") {
  const TemporaryFolder folder;
  const FigureResult result = write_figure(convergence(), folder.path() / "a", "no-such-gnuplot");
  CHECK_FALSE(result);
  CHECK(contains(result.message, "no-such-gnuplot"));
  CHECK(contains(result.message, "No such file or directory"));
  CHECK(folder.entries() == 0);
}

TEST_CASE("output: when gnuplot fails or does nothing, nothing is written and old figures stay") {
  const TemporaryFolder folder;
  REQUIRE(write_figure(convergence(), folder.path() / "a"));
  const std::string svg = read_file(folder.path() / "a.svg");
  const auto failing = [&](const std::string& script) {
    const fs::path program = folder.path() / "program";
    write_file_atomically(program, "#!/bin/sh\n" + script);
    ::chmod(program.c_str(), 0755);
    const FigureResult result = write_figure(drift(), folder.path() / "a", program.string());
    CHECK_FALSE(result);
    CHECK(read_file(folder.path() / "a.svg") == svg);
    CHECK(folder.entries() == 4);
    return result.message;
  };
  CHECK(contains(failing("echo broken >&2; exit 7"), "ended with code 7: broken"));
  CHECK(contains(failing("kill -9 $$"), "ended by signal 9"));
  CHECK(contains(failing("exit 0"), "figure.svg"));
  CHECK(contains(failing("echo '<?xml' > figure.svg; echo x > figure.png"), "incomplete"));
}

TEST_CASE("output: a folder that cannot be made is a message") {
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "file", "x");
  const FigureResult result = write_figure(convergence(), folder.path() / "file" / "a");
  CHECK_FALSE(result);
  CHECK(contains(result.message, "Not a directory"));
}

TEST_CASE("output: empty figures are refused, empty panels are drawn as such") {
  const TemporaryFolder folder;
  CHECK(contains(write_figure({}, folder.path() / "a").message, "nothing to draw"));
  Figure figure = convergence();
  figure.panels.front().series.resize(1);
  figure.panels.front().series[0].y.assign(12, 0.0);
  const FigureResult zero = write_figure(figure, folder.path() / "a");
  CHECK(contains(zero.message, "nothing to draw"));
  REQUIRE(zero.left_out.size() >= 1);
  CHECK(contains(zero.left_out[0], "munjiza"));
  CHECK(folder.entries() == 0);

  figure = convergence();
  figure.panels.push_back({});
  REQUIRE(write_figure(figure, folder.path() / "b"));
  CHECK(contains(read_file(folder.path() / "b.svg"), ">no data</text>"));
}

TEST_CASE("output: odd data are drawn too") {
  const TemporaryFolder folder;
  Figure figure;
  const auto problem = [&](const char* name) { return write_figure(figure, folder.path() / name).message; };
  figure.panels.resize(1);
  Panel& panel = figure.panels.front();
  panel.series = {{"one point", {3.0}, {5.0}, {}, 0}};
  CHECK(problem("point").empty());
  panel.series = {{"huge", {1e-299, 1.0, 1e299}, {1e299, 1.0, 1e-299}, {}, 0}};
  CHECK(problem("huge").empty());
  panel.x_range = Range{1e3, 1e4};
  panel.y_range = Range{1e3, 1e4};
  CHECK(problem("outside").empty());
  panel = {};
  panel.log_x = panel.log_y = false;
  panel.series = {{"constant", {0.0, 1.0}, {-2.0, -2.0}, {}, 0}, {"", {0.5}, {-2.0}, {true}, -3}};
  CHECK(problem("linear").empty());
  for (int i = 0; i < 50; ++i) {
    const std::string name =
        "scheme number " + std::to_string(i) + std::string(static_cast<std::size_t>(2 * i), 'm');
    panel.series.push_back({name, {0.0, 1.0}, {1.0 * i, 60.0 - i}, {}, i});
  }
  CHECK(problem("many").empty());
  figure.panels.push_back(panel);
  CHECK(problem("twice").empty());
  CHECK(is_well_formed(read_file(folder.path() / "twice.svg")));
}
