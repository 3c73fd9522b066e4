#include "src/output/latex.hpp"

#include <stdexcept>
#include <string>

#include "tests/catch.hpp"
#include "tests/output/contains.hpp"

using namespace gnomon::output;
using gnomon::test::contains;

TEST_CASE("output: any text is escaped for LaTeX") {
  CHECK(latex_text("rkmk4") == "rkmk4");
  CHECK(latex_text("a_b & 50 % of #1 {x} $5") == "a\\_b \\& 50 \\% of \\#1 \\{x\\} \\$5");
  CHECK(latex_text("\\input{x}^~") == "\\textbackslash{}input\\{x\\}\\textasciicircum{}\\textasciitilde{}");
  CHECK(latex_text("a < b > c | \"d\"") ==
        "a \\textless{} b \\textgreater{} c \\textbar{} \\textquotedbl{}d\\textquotedbl{}");
  CHECK(latex_text("reached --max-steps 3") == "reached -{}-max-steps 3");
  CHECK(latex_text("---") == "-{}-{}-");
  CHECK(latex_text("—") == "---");
  CHECK(latex_text("≤ 12") == "$\\le$ 12");
  CHECK(latex_text("error [m]") == "error {[}m{]}");
  CHECK(latex_text("a\nb\tc") == "a b c");
  CHECK(latex_text("Störmer") == "Störmer");
}

TEST_CASE("output: numbers with an exponent become powers of ten in LaTeX") {
  CHECK(latex_text("1.20e-05") == "$1.20\\cdot10^{-5}$");
  CHECK(latex_text("-1.20e-05") == "$-1.20\\cdot10^{-5}$");
  CHECK(latex_text("-0.25 to -1") == "$-$0.25 to $-$1");
  CHECK(latex_text("≤ 3e-15") == "$\\le$ $3\\cdot10^{-15}$");
  CHECK(latex_text("1e+04, 2e5") == "$1\\cdot10^{4}$, $2\\cdot10^{5}$");
  CHECK(latex_text("energy off by 3e+01") == "energy off by $3\\cdot10^{1}$");
  // Not numbers.
  CHECK(latex_text("cf4e1") == "cf4e1");
  CHECK(latex_text("1e") == "1e");
  CHECK(latex_text("2em") == "2em");
  CHECK(latex_text("1e5x") == "1e5x");
  CHECK(latex_text("0.25") == "0.25");
}

TEST_CASE("output: a table for booktabs") {
  const Table table{"A_1",
                    {{"name", "name", Align::left}, {"h", "h [s]"}, {"c", "mid", Align::centre}},
                    {{"x & y", number_cell(1.5e-7), Cell()}, {"z", "2", "ok"}},
                    {"note 1 %", "second"}};
  CHECK(to_latex(table) ==
        "\\begin{table}[htbp]\n\\centering\\small\n\\caption{A\\_1}\n\\begin{tabular}{lrc}\n\\toprule\n"
        "name & h {[}s{]} & mid \\\\\n\\midrule\n"
        "x \\& y & $1.50\\cdot10^{-7}$ & --- \\\\\nz & 2 & ok \\\\\n"
        "\\bottomrule\n\\end{tabular}\n\\par\\footnotesize note 1 \\%\n\\par\\footnotesize second\n"
        "\\end{table}\n");
  const std::string document = latex_document({table, table});
  CHECK(document.starts_with("% \\usepackage"));
  CHECK(document.find("\\begin{table}") != document.rfind("\\begin{table}"));
}

TEST_CASE("output: a table of many rows breaks over pages, one of the wrong shape is refused") {
  Table table{"long", {{"n", "n"}}, {}, {}};
  for (int k = 0; k < 41; ++k) table.rows.push_back({count_cell(k)});
  const std::string text = to_latex(table);
  CHECK(contains(text, "\\begin{longtable}{r}"));
  CHECK(contains(text, "\\endfirsthead"));
  CHECK_FALSE(contains(text, "\\begin{table}"));
  table.rows.pop_back();
  CHECK(contains(to_latex(table), "\\begin{table}"));
  table.rows.push_back({});
  CHECK_THROWS_AS(to_latex(table), std::invalid_argument);
}
