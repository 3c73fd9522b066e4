// The HTML page: whole, self-contained, and alive in a browser where there is one.
#include "src/output/report_page.hpp"

#include <cstdlib>
#include <filesystem>
#include <limits>
#include <regex>
#include <string>

#include "src/output/files.hpp"
#include "tests/catch.hpp"
#include "tests/output/contains.hpp"
#include "tests/output/temporary_folder.hpp"

using namespace gnomon::output;
using namespace gnomon::test;

namespace {

ReportPage sample_page() {
  Table table;
  table.caption = "A <b>table</b> & more";
  table.columns = {{"name", "name", Align::left}, {"error", "error [rad]"}, {"n", "runs"}};
  table.rows = {{"zeta", number_cell(2.5e-3), count_cell(10)},
                {"alpha", Cell(), count_cell(9)},
                {"item10", number_cell(1e-12), count_cell(200)},
                {"item9", at_most_cell(3.1e-15), count_cell(-1)}};
  table.notes = {"a note with </script> in it"};
  Figure figure;
  figure.title = "top, energy";
  figure.hollow_note = "hollow: at the bound";
  Panel panel{.title = "CPU time", .x_label = "time [s]", .y_label = "error [rad]"};
  panel.series.push_back({"one </script>", {1e-5, 1e-4, 1e-3}, {1e-2, 1e-6, 1e-15}, {false, false, true}, 0});
  panel.series.push_back(
      {"two", {1e-5, 1e-4, 1e-3}, {1e-1, std::numeric_limits<double>::quiet_NaN(), 0.0}, {}, 1});
  panel.series.back().x_bars = {{0.9e-5, 1.2e-5}, {0.9e-4, 1.2e-4}, {0.0, 0.0}};
  panel.failures.push_back({1e-2, 1, "two, step 1: diverged <"});
  figure.failure_note = "a run that failed";
  figure.front_note = "Pareto front";
  panel.front = {{1.0, 0.1}, {2.0, 0.01}};
  panel.reference_lines.push_back({1e-15, "bound of the reference"});
  figure.panels = {panel, panel};
  ReportPage page;
  page.title = "A study";
  page.facts = {{"cpu", "a <fast> one"}};
  page.summary = {table};
  page.sections = {
      {"compare-top",
       "Work and precision: top",
       "./gnomon compare top",
       {table},
       figure,
       "<?xml version=\"1.0\"?><svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\"/>"}};
  return page;
}

std::string browser() {
  for (const char* path : {"/usr/bin/chromium", "/usr/bin/chromium-headless-shell", "/usr/bin/google-chrome"})
    if (std::filesystem::exists(path)) return path;
  const char* named = std::getenv("GNOMON_BROWSER");
  return named ? named : "";
}

}  // namespace

TEST_CASE("output: the report is whole and loads nothing") {
  for (const std::string& script : {std::string(), std::string("var Chart = \"</script>\";")}) {
    const std::string html = report_html(sample_page(), script);
    CHECK(html.starts_with("<!DOCTYPE html>"));
    CHECK(html.ends_with("</body></html>\n"));
    CHECK(count(html, "<script") == count(html, "</script>"));
    CHECK(count(html, "<script>") == (script.empty() ? 1 : 2));
    CHECK(contains(html, "A &lt;b&gt;table&lt;/b&gt; &amp; more"));
    CHECK(contains(html, "a note with &lt;/script&gt; in it"));
    CHECK(contains(html, "<td data-v=\"0.0025000000000000001\">0.00250</td>"));
    CHECK(contains(html, "<td data-v=\"\">\u2014</td>"));
    CHECK(contains(html, "made by <code>./gnomon compare top</code>"));
    CHECK(contains(html, "<a href=\"#compare-top\">"));
    CHECK(contains(html, "<section id=\"compare-top\">"));
    CHECK(contains(html, "src=\"data:image/svg+xml;base64,PD94bWwg"));
    CHECK(contains(html, "<script type=\"application/json\">") == !script.empty());
    CHECK(contains(html, "libjs-chart.js, which was not installed") == script.empty());
    // Whatever is in it is in it.
    CHECK_FALSE(std::regex_search(html, std::regex("(src|href)=\"(?!data:|#)")));
    CHECK_FALSE(contains(html, "@import"));
    CHECK_FALSE(contains(html, "url("));
  }
}

TEST_CASE("output: data of plots are JSON without what a page could trip over") {
  const std::string html = report_html(sample_page(), "var none;");
  const std::string begin = "<script type=\"application/json\">";
  const std::size_t from = html.find(begin) + begin.size();
  const std::string json = html.substr(from, html.find("</script>", from) - from);
  CHECK_FALSE(contains(json, "<"));
  CHECK(contains(json, "\"label\":\"one \\u003c/script>\""));
  CHECK(contains(json, "\"y\":[0.1,null,0.0]"));
  CHECK(contains(json, "\"hollow\":[false,false,true]"));
  CHECK(contains(json, "\"front\":[[1.0,0.1],[2.0,0.01]]"));
}

TEST_CASE("output: figures without a drawing and without scripts are said to be missing") {
  ReportPage page = sample_page();
  page.sections[0].svg.clear();
  CHECK(contains(report_html(page, ""), "neither gnuplot nor libjs-chart.js was installed"));
  CHECK_FALSE(contains(report_html(page, "var none;"), "neither gnuplot"));
  CHECK(chart_library("/nowhere").empty());
}

TEST_CASE("output: in a browser tables sort and plots have their data", "[browser]") {
  const std::string program = browser();
  const char* folder_of_library = std::getenv("GNOMON_CHART_FOLDER");
  const std::string library = folder_of_library ? chart_library(folder_of_library) : chart_library();
  if (program.empty() || library.empty()) {
    WARN("skipped: " << (program.empty() ? "there is no Chromium" : "libjs-chart.js is not installed"));
    return;
  }
  const TemporaryFolder folder;
  std::string html = report_html(sample_page(), library);
  const std::string head = "<head>";
  html.insert(
      html.find(head) + head.size(),
      "<script>window.failures = [];\n"
      "window.addEventListener('error', (e) => failures.push(e.message));\n"
      "const say = console.error; console.error = (...a) => { failures.push(a.join(' ')); say(...a); };"
      "</script>");
  const std::string script =
      "<script>\nconst table = document.querySelector('table.sortable');\n"
      "const names = () => Array.from(table.tBodies[0].rows, (row) => row.cells[0].textContent).join(' ');\n"
      "const click = (k) => { table.tHead.rows[0].cells[k].querySelector('button').click(); return names(); "
      "};\n"
      "const seen = [click(1), click(1), click(2), click(2), click(0), click(0)];\n"
      "const points = gnomonPlots.map((p) => p.data.datasets.map((d) => d.data.length).join(','));\n"
      "const before = gnomonPlots[0].scales.x.max;\n"
      "const area = gnomonPlots[0].chartArea;\n"
      "zoom(gnomonPlots[0], { x: area.left + 50, y: area.top + 20 }, { x: area.left + 150, y: area.top + 90 "
      "});\n"
      "const zoomed = gnomonPlots[0].scales.x.max < before;\n"
      "zoom(gnomonPlots[0], null, null);\n"
      "const result = { seen, points, zoomed, back: gnomonPlots[0].scales.x.max === before, failures };\n"
      "document.body.innerHTML = '';\nconst box = document.createElement('pre');\n"
      "box.textContent = 'RESULT ' + JSON.stringify(result) + ' END';\ndocument.body.append(box);\n</script>";
  html.insert(html.rfind("</body>"), script);
  write_file_atomically(folder.path() / "page.html", html);
  const std::string out = (folder.path() / "dom").string();
  const std::string command = "HOME='" + folder.path().string() + "' timeout 60 '" + program +
                              "' --headless --no-sandbox --disable-gpu --dump-dom 'file://" +
                              (folder.path() / "page.html").string() + "' >'" + out + "' 2>/dev/null";
  REQUIRE(std::system(command.c_str()) == 0);
  const std::string dom = read_file(out);
  INFO(dom.substr(dom.find("RESULT") == std::string::npos ? 0 : dom.find("RESULT"), 800));
  // Numbers by size, what is missing last; then the other way; names by their numbers.
  CHECK(contains(dom,
                 "\"seen\":[\"item9 item10 zeta alpha\",\"zeta item10 item9 alpha\","
                 "\"item9 alpha zeta item10\",\"item10 zeta alpha item9\","
                 "\"alpha item9 item10 zeta\",\"zeta item10 item9 alpha\"]"));
  CHECK(contains(dom, "\"points\":[\"3,1,2,5,1\",\"3,1,2,5,1\"]"));
  CHECK(contains(dom, "\"zoomed\":true,\"back\":true"));
  CHECK(contains(dom, "\"failures\":[]"));
}
