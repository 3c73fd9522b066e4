#pragma once
// Tables that are shown (Markdown, terminal) and read by programs (CSV) from one description.

#include <string>
#include <vector>

namespace gnomon::output {

/// What is printed for a value that does not exist or is not finite.
inline constexpr const char* missing_text = "—";

/// `value` with `digits` significant digits, trailing zeros kept: 0.001234 -> "0.00123", 1.2e-5 ->
/// "1.20e-05". Zero is "0"; a value that is not finite is "—".
std::string number(double value, int digits = 3);

/// `value` with `digits` significant digits and an exponent that is a multiple of three: 1.234e-5 ->
/// "12.3e-6", 0.5 -> "500e-3", 42 -> "42.0". For times and counts whose unit stands in the heading.
std::string engineering(double value, int digits = 3);

/// "≤ 3e-15": `bound` with `digits` significant digits, rounded up so that the statement stays true.
std::string at_most(double bound, int digits = 1);

/// `value` with 17 significant digits, from which the double is recovered exactly; empty if not finite.
std::string exact(double value);

/// One entry: `text` is shown, `raw` goes to CSV. Empty `raw` means missing.
struct Cell {
  std::string text = missing_text;
  std::string raw;

  Cell() = default;                   ///< a missing value
  Cell(std::string same_everywhere);  ///< text; an empty string is a missing value only in CSV
  Cell(const char* same_everywhere);
  Cell(std::string shown, std::string raw_text);
};

Cell number_cell(double value, int digits = 3);
Cell engineering_cell(double value, int digits = 3);
Cell count_cell(long long value);
/// An error that is not above the bound of its reference: shown as at_most(bound), the bound itself in CSV.
Cell at_most_cell(double bound, int digits = 1);

enum class Align { left, right, centre };

struct Column {
  std::string key;      ///< CSV header, snake_case, e.g. "cpu_median_s"
  std::string heading;  ///< shown, with the unit, e.g. "CPU time [s]"
  Align align = Align::right;
};

struct Table {
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;
  std::vector<std::string> notes;
};

/// GitHub-flavoured Markdown with columns padded so that the source reads as a table too: caption in bold
/// before, notes as a list after. Cells may hold Markdown; '|' in them is escaped, line ends become spaces.
/// Throws std::invalid_argument if a row's length is not the number of columns; so do the two below.
std::string to_markdown(const Table& table);

/// The same for a terminal: aligned columns, a rule below the headings, no markup added.
std::string to_text(const Table& table);

/// CSV with one header line of keys; fields quoted as in RFC 4180, lines end in LF. No caption, no notes.
std::string to_csv(const Table& table);

}  // namespace gnomon::output
