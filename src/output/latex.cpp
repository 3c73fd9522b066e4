#include "src/output/latex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "src/output/text.hpp"

namespace gnomon::output {
namespace {

constexpr std::size_t longest_float = 40;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Length of a number with an exponent ("1.20e-05") that begins at `i`, or 0. What stands within a word, as
/// in "cf4e1" or "a1e5b", is none.
std::size_t exponential_length(std::string_view text, std::size_t i) {
  const auto is_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.';
  };
  if (i > 0 && is_word(text[i - 1])) return 0;
  const std::size_t first = text[i] == '-' ? i + 1 : i;
  std::size_t k = first;
  while (k < text.size() && (is_digit(text[k]) || (text[k] == '.' && k > first))) ++k;
  if (k == first || k >= text.size() || text[k] != 'e') return 0;
  ++k;
  if (k < text.size() && (text[k] == '-' || text[k] == '+')) ++k;
  const std::size_t digits = k;
  while (k < text.size() && is_digit(text[k])) ++k;
  if (k == digits || k - digits > 4 || (k < text.size() && is_word(text[k]) && text[k] != '.')) return 0;
  return k - i;
}

std::string power_of_ten(std::string_view number) {
  const std::size_t e = number.find('e');
  const int exponent = std::stoi(std::string(number.substr(e + 1)));
  return fmt::format("${}\\cdot10^{{{}}}$", number.substr(0, e), exponent);
}

struct Replacement {
  std::string_view from, to;
};
constexpr Replacement replacements[] = {
    {"\\", "\\textbackslash{}"},
    {"{", "\\{"},
    {"}", "\\}"},
    {"$", "\\$"},
    {"&", "\\&"},
    {"#", "\\#"},
    {"%", "\\%"},
    {"_", "\\_"},
    {"^", "\\textasciicircum{}"},
    {"~", "\\textasciitilde{}"},
    {"<", "\\textless{}"},
    {">", "\\textgreater{}"},
    {"|", "\\textbar{}"},
    {"\"", "\\textquotedbl{}"},
    {"'", "{'}"},
    {"`", "{`}"},
    {"--", "-{}-"},
    {"[", "{[}"},
    {"]", "{]}"},
    {"—", "---"},
    {"≤", "$\\le$"},
    {"≥", "$\\ge$"},
    {"−", "$-$"},
};

std::string columns_of(const Table& table) {
  std::string text;
  for (const Column& column : table.columns)
    text += column.align == Align::left ? 'l' : column.align == Align::right ? 'r' : 'c';
  return text;
}

std::string headings_of(const Table& table) {
  std::string text;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    text += (c == 0 ? "" : " & ") + latex_text(table.columns[c].heading);
  return text + " \\\\\n";
}

std::string rows_of(const Table& table) {
  std::string text;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const auto& row = table.rows[r];
    if (row.size() != table.columns.size())
      throw std::invalid_argument(fmt::format("table '{}': row {} has {} cells for {} columns", table.caption,
                                              r + 1, row.size(), table.columns.size()));
    for (std::size_t c = 0; c < row.size(); ++c) text += (c == 0 ? "" : " & ") + latex_text(row[c].text);
    text += " \\\\\n";
  }
  return text;
}

std::string notes_of(const Table& table) {
  std::string text;
  for (const std::string& note : table.notes)
    text += fmt::format("\\par\\footnotesize {}\n", latex_text(note));
  return text;
}

}  // namespace

std::string latex_text(std::string_view raw) {
  const std::string text = plain_text(raw);
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (const std::size_t length = exponential_length(text, i)) {
      result += power_of_ten(std::string_view(text).substr(i, length));
      i += length;
      continue;
    }
    if (text[i] == '-' && i + 1 < text.size() && is_digit(text[i + 1]) && (i == 0 || text[i - 1] == ' ')) {
      result += "$-$";
      ++i;
      continue;
    }
    const auto found = std::ranges::find_if(replacements, [&](const Replacement& each) {
      return std::string_view(text).substr(i).starts_with(each.from);
    });
    if (found == std::end(replacements)) {
      result += text[i++];
      continue;
    }
    // Of a row of dashes every one but the last is kept apart from the next.
    const bool dashes = found->from == "--";
    result += dashes ? "-{}" : found->to;
    i += dashes ? 1 : found->from.size();
  }
  return result;
}

std::string to_latex(const Table& table) {
  const bool is_long = table.rows.size() > longest_float;
  const std::string columns = columns_of(table), headings = headings_of(table), rows = rows_of(table);
  const std::string caption =
      table.caption.empty() ? "" : fmt::format("\\caption{{{}}}", latex_text(table.caption));
  std::string text;
  if (is_long) {
    text += fmt::format("{{\\small\n\\begin{{longtable}}{{{}}}\n", columns);
    if (!caption.empty()) text += caption + " \\\\\n";
    text += "\\toprule\n" + headings + "\\midrule\n\\endfirsthead\n\\toprule\n" + headings +
            "\\midrule\n\\endhead\n\\bottomrule\n\\endfoot\n" + rows + "\\end{longtable}\n" +
            notes_of(table) + "}\n";
    return text;
  }
  text += "\\begin{table}[htbp]\n\\centering\\small\n";
  if (!caption.empty()) text += caption + "\n";
  text += fmt::format("\\begin{{tabular}}{{{}}}\n\\toprule\n", columns) + headings + "\\midrule\n" + rows +
          "\\bottomrule\n\\end{tabular}\n" + notes_of(table) + "\\end{table}\n";
  return text;
}

std::string latex_document(const std::vector<Table>& tables) {
  std::string text =
      "% \\usepackage[utf8]{inputenc} \\usepackage[T1]{fontenc} \\usepackage{booktabs,longtable}\n";
  for (const Table& table : tables) text += "\n" + to_latex(table);
  return text;
}

}  // namespace gnomon::output
