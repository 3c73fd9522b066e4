#include "src/output/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "src/output/text.hpp"

namespace gnomon::output {
namespace {

void check_rows(const Table& table) {
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    if (table.rows[r].size() != table.columns.size()) {
      throw std::invalid_argument(fmt::format("table '{}': row {} has {} cells for {} columns", table.caption,
                                              r + 1, table.rows[r].size(), table.columns.size()));
    }
  }
}

/// Decimal exponent of `value` once it is rounded to `digits` significant digits.
int rounded_exponent(double value, int digits) {
  const std::string text = fmt::format("{:.{}e}", value, digits - 1);
  return std::atoi(text.c_str() + text.find('e') + 1);
}

std::string padded(const std::string& text, std::size_t width, Align align) {
  const std::size_t space = width - std::min(width, display_columns(text));
  const std::size_t left = align == Align::left ? 0 : align == Align::right ? space : space / 2;
  return std::string(left, ' ') + text + std::string(space - left, ' ');
}

std::string escaped_for_markdown(std::string_view text) {
  std::string result;
  for (const char c : plain_text(text)) {
    if (c == '|') result += '\\';
    result += c;
  }
  return result;
}

/// Headings and cells as they will be printed: first row the headings.
std::vector<std::vector<std::string>> printed(const Table& table, std::string (*prepare)(std::string_view)) {
  check_rows(table);
  std::vector<std::vector<std::string>> lines(1);
  for (const Column& column : table.columns) lines.front().push_back(prepare(column.heading));
  for (const auto& row : table.rows) {
    lines.emplace_back();
    for (const Cell& cell : row) lines.back().push_back(prepare(cell.text));
  }
  return lines;
}

std::vector<std::size_t> widths(const std::vector<std::vector<std::string>>& lines, std::size_t least) {
  std::vector<std::size_t> result(lines.front().size(), least);
  for (const auto& line : lines) {
    for (std::size_t c = 0; c < line.size(); ++c) result[c] = std::max(result[c], display_columns(line[c]));
  }
  return result;
}

std::string markdown_rule(std::size_t width, Align align) {
  std::string rule(width, '-');
  if (align != Align::left) rule.back() = ':';
  if (align != Align::right) rule.front() = ':';
  return rule;
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

}  // namespace

std::string number(double value, int digits) {
  if (!std::isfinite(value)) return missing_text;
  if (value == 0.0) return "0";
  // As "%g" chooses, but with trailing zeros.
  const int exponent = rounded_exponent(value, digits);
  if (exponent < -4 || exponent >= digits) return fmt::format("{:.{}e}", value, digits - 1);
  return fmt::format("{:.{}f}", value, std::max(0, digits - 1 - exponent));
}

std::string engineering(double value, int digits) {
  if (!std::isfinite(value)) return missing_text;
  if (value == 0.0) return "0";
  const int exponent = rounded_exponent(value, digits);
  const int group = 3 * static_cast<int>(std::floor(exponent / 3.0));
  const int decimals = std::max(0, digits - 1 - (exponent - group));
  // The decimal digits are those of `value` itself: dividing by a power of ten could change the last one.
  std::string mantissa = fmt::format("{:.{}e}", std::abs(value), digits - 1);
  mantissa.erase(mantissa.find('e'));
  mantissa.erase(std::remove(mantissa.begin(), mantissa.end(), '.'), mantissa.end());
  mantissa.resize(std::max(mantissa.size(), static_cast<std::size_t>(exponent - group + 1)), '0');
  if (decimals > 0) mantissa.insert(mantissa.size() - static_cast<std::size_t>(decimals), ".");
  return (value < 0.0 ? "-" : "") + mantissa + (group == 0 ? "" : fmt::format("e{}", group));
}

std::string at_most(double bound, int digits) {
  if (!std::isfinite(bound)) return missing_text;
  std::string text = fmt::format("{:.{}g}", bound, digits);
  if (bound > 0.0 && std::strtod(text.c_str(), nullptr) < bound) {
    // Printed digits are below the bound: one unit in the last printed place more is above it.
    const double unit = std::pow(10.0, rounded_exponent(bound, digits) - digits + 1);
    text = fmt::format("{:.{}g}", std::strtod(text.c_str(), nullptr) + unit, digits);
  }
  return "≤ " + text;
}

std::string exact(double value) { return std::isfinite(value) ? fmt::format("{:.17g}", value) : ""; }

Cell::Cell(std::string same_everywhere) : text(same_everywhere), raw(std::move(same_everywhere)) {}
Cell::Cell(const char* same_everywhere) : Cell(std::string(same_everywhere)) {}
Cell::Cell(std::string shown, std::string raw_text) : text(std::move(shown)), raw(std::move(raw_text)) {}

Cell number_cell(double value, int digits) { return {number(value, digits), exact(value)}; }
Cell engineering_cell(double value, int digits) { return {engineering(value, digits), exact(value)}; }
Cell count_cell(long long value) { return {std::to_string(value)}; }
Cell at_most_cell(double bound, int digits) { return {at_most(bound, digits), exact(bound)}; }

std::string to_markdown(const Table& table) {
  const auto lines = printed(table, escaped_for_markdown);
  const auto width = widths(lines, 3);
  std::string result;
  if (!table.caption.empty()) result += "**" + plain_text(table.caption) + "**\n\n";
  for (std::size_t r = 0; r < lines.size(); ++r) {
    for (std::size_t c = 0; c < width.size(); ++c) {
      result += (c == 0 ? "| " : " | ") + padded(lines[r][c], width[c], table.columns[c].align);
    }
    result += " |\n";
    if (r > 0) continue;
    for (std::size_t c = 0; c < width.size(); ++c) {
      result += (c == 0 ? "| " : " | ") + markdown_rule(width[c], table.columns[c].align);
    }
    result += " |\n";
  }
  if (!table.notes.empty()) result += '\n';
  for (const std::string& note : table.notes) result += "- " + plain_text(note) + '\n';
  return result;
}

std::string to_text(const Table& table) {
  const auto lines = printed(table, plain_text);
  const auto width = widths(lines, 1);
  std::string result;
  if (!table.caption.empty()) result += plain_text(table.caption) + "\n\n";
  for (std::size_t r = 0; r < lines.size(); ++r) {
    std::string line;
    for (std::size_t c = 0; c < width.size(); ++c) {
      line += (c == 0 ? "" : "  ") + padded(lines[r][c], width[c], table.columns[c].align);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    result += line + '\n';
    if (r > 0) continue;
    for (std::size_t c = 0; c < width.size(); ++c)
      result += (c == 0 ? "" : "  ") + std::string(width[c], '-');
    result += '\n';
  }
  if (!table.notes.empty()) result += '\n';
  for (const std::string& note : table.notes) result += "- " + plain_text(note) + '\n';
  return result;
}

std::string to_csv(const Table& table) {
  check_rows(table);
  std::string result;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    result += (c == 0 ? "" : ",") + csv_field(table.columns[c].key);
  }
  result += '\n';
  for (const auto& row : table.rows) {
    for (std::size_t c = 0; c < row.size(); ++c) result += (c == 0 ? "" : ",") + csv_field(row[c].raw);
    result += '\n';
  }
  return result;
}

}  // namespace gnomon::output
