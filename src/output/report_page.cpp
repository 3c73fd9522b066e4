#include "src/output/report_page.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "src/output/figure_style.hpp"
#include "src/output/files.hpp"
#include "src/output/text.hpp"

namespace gnomon::output {
namespace html {

using Json = nlohmann::ordered_json;

constexpr std::size_t rows_in_the_open = 80;

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : plain_text(text)) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t i = text.find(from); i != std::string::npos; i = text.find(from, i + to.size()))
    text.replace(i, from.size(), to);
}

/// A script that cannot end the element it stands in.
std::string script_html(std::string text) {
  replace_all(text, "</script", "<\\/script");
  return "<script>\n" + text + "\n</script>\n";
}

std::string data_html(std::string json) {
  replace_all(json, "<", "\\u003c");
  return "<script type=\"application/json\">" + json + "</script>\n";
}

std::string base64(const std::string& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() * 4 / 3 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned long block = 0;
    for (std::size_t k = 0; k < 3; ++k)
      block = block << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k < bytes.size() + 1 ? digits[block >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

/// The raw value is what a table is sorted by; empty is missing.
std::string cell_html(const Cell& cell, Align align) {
  std::string attributes = align == Align::left ? " class=\"l\"" : "";
  if (cell.raw != cell.text) attributes += fmt::format(" data-v=\"{}\"", escaped(cell.raw));
  return fmt::format("<td{}>{}</td>", attributes, escaped(cell.text));
}

std::string table_html(const Table& table) {
  std::string text = "<div class=\"wide\"><table class=\"sortable\"><thead><tr>";
  for (const Column& column : table.columns)
    text += fmt::format("<th scope=\"col\"{}><button type=\"button\">{}</button></th>",
                        column.align == Align::left ? " class=\"l\"" : "", escaped(column.heading));
  text += "</tr></thead><tbody>\n";
  for (const std::vector<Cell>& row : table.rows) {
    text += "<tr>";
    for (std::size_t k = 0; k < row.size(); ++k) text += cell_html(row[k], table.columns.at(k).align);
    text += "</tr>\n";
  }
  text += "</tbody></table></div>\n";
  if (!table.notes.empty()) {
    text += "<ul class=\"notes\">";
    for (const std::string& note : table.notes) text += "<li>" + escaped(note) + "</li>";
    text += "</ul>\n";
  }
  if (table.rows.size() > rows_in_the_open || table.caption == "Runs")
    return fmt::format("<details><summary>{} ({} rows)</summary>\n{}</details>\n",
                       escaped(table.caption.empty() ? "Table" : table.caption), table.rows.size(), text);
  return (table.caption.empty() ? "" : "<h3>" + escaped(table.caption) + "</h3>\n") + text;
}

Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
  return list;
}

Json series_json(const Series& series) {
  const SeriesStyle style = style_of(series.style);
  Json hollow = Json::array();
  for (const bool each : series.hollow) hollow.push_back(each);
  Json bars = Json::array();
  for (const Range& bar : series.x_bars) bars.push_back(numbers({bar.low, bar.high}));
  return {{"label", series.label},
          {"x", numbers(series.x)},
          {"y", numbers(series.y)},
          {"hollow", hollow},
          {"bars", bars},
          {"colour", style.colour},
          {"marker", style.filled_marker},
          {"dash", style.dash}};
}

Json figure_json(const Figure& figure) {
  Json json{{"title", figure.title},
            {"hollow_note", figure.hollow_note},
            {"failure_note", figure.failure_note},
            {"front_note", figure.front_note},
            {"panels", Json::array()}};
  for (const Panel& panel : figure.panels) {
    Json each{{"title", panel.title},    {"x_label", panel.x_label},  {"y_label", panel.y_label},
              {"log_x", panel.log_x},    {"log_y", panel.log_y},      {"lines", Json::array()},
              {"series", Json::array()}, {"failures", Json::array()}, {"front", Json::array()}};
    for (const FrontPoint& point : panel.front) each["front"].push_back(numbers({point.x, point.y}));
    for (const Failure& failure : panel.failures)
      each["failures"].push_back({{"x", numbers({failure.x})[0]},
                                  {"label", failure.label},
                                  {"colour", style_of(failure.style).colour}});
    for (const ReferenceLine& line : panel.reference_lines)
      each["lines"].push_back({{"y", line.y}, {"label", line.label}});
    for (const Series& series : panel.series) each["series"].push_back(series_json(series));
    json["panels"].push_back(std::move(each));
  }
  return json;
}

/// The drawn figure; with `interactive` also the data that the script makes plots of.
std::string figure_html(const ReportSection& section, bool interactive) {
  std::string text = "<figure>\n";
  if (!section.svg.empty())
    text += fmt::format("<img class=\"drawn\" alt=\"{}\" src=\"data:image/svg+xml;base64,{}\">\n",
                        escaped(section.figure->title), base64(section.svg));
  if (interactive) text += "<div class=\"plots\"></div>" + data_html(figure_json(*section.figure).dump());
  if (!section.command.empty())
    text += fmt::format("<figcaption>made by <code>{}</code></figcaption>\n", escaped(section.command));
  if (section.svg.empty() && !interactive)
    text += "<p class=\"notes\">No figure: neither gnuplot nor libjs-chart.js was installed.</p>\n";
  return text + "</figure>\n";
}

std::string section_html(const ReportSection& section, bool interactive) {
  std::string text =
      fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n", escaped(section.id), escaped(section.heading));
  if (section.figure)
    text += figure_html(section, interactive);
  else if (!section.command.empty())
    text += fmt::format("<p class=\"notes\">made by <code>{}</code></p>\n", escaped(section.command));
  for (const Table& table : section.tables) text += table_html(table);
  return text + "</section>\n";
}

std::string asset(const char* name) {
  return read_file(std::filesystem::path(GNOMON_SOURCE_DIR) / "src/output/report" / name);
}

}  // namespace html

std::string chart_library(const std::filesystem::path& folder) {
  for (const char* name : {"chart.min.js", "chart.umd.js", "chart.js"}) {
    std::error_code none;
    if (std::filesystem::is_regular_file(folder / name, none)) return read_file(folder / name);
  }
  return "";
}

std::string report_html(const ReportPage& page, const std::string& chart_script) {
  using html::escaped;
  const bool interactive = !chart_script.empty();
  std::string text = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}</title>\n<style>\n{}</style>\n</head>\n<body>\n<h1>{}</h1>\n",
      escaped(page.title), html::asset("page.css"), escaped(page.title));
  text += "<nav><a href=\"#summary\">Summary</a>";
  for (const ReportSection& section : page.sections)
    text += fmt::format(" <a href=\"#{}\">{}</a>", escaped(section.id), escaped(section.heading));
  text += "</nav>\n<section id=\"summary\">\n<h2>Summary</h2>\n";
  for (const Table& table : page.summary) text += html::table_html(table);
  text += "<h3>Where and with what</h3>\n<dl>";
  for (const auto& [name, value] : page.facts)
    text += fmt::format("<dt>{}</dt><dd>{}</dd>", escaped(name), escaped(value));
  text += "</dl>\n<p class=\"notes screen\">A click on a heading sorts its table.";
  text +=
      interactive
          ? " In a plot: drag to zoom in, double-click to zoom out, click on a name to hide its curve."
          : " The figures are drawn ones: plots to zoom into need the package libjs-chart.js, which was not "
            "installed when this page was made.";
  text += "</p>\n</section>\n";
  for (const ReportSection& section : page.sections) text += html::section_html(section, interactive);
  if (interactive) text += html::script_html(chart_script);
  return text + html::script_html(html::asset("page.js")) + "</body></html>\n";
}

}  // namespace gnomon::output
