#include "src/output/text.hpp"

#include <cmath>
#include <utility>

#include "tests/catch.hpp"

using namespace gnomon::output;

TEST_CASE("output: plain text keeps valid UTF-8 and replaces what cannot be printed") {
  CHECK(plain_text("ω² ≤ 3 — 𝛼") == "ω² ≤ 3 — 𝛼");
  CHECK(plain_text("a\nb\tc\x7f") == "a b c ");
  CHECK(plain_text("\xff") == "?");
  CHECK(plain_text("x\xe2\x89") == "x??");          // cut short
  CHECK(plain_text("\xc0\xaf") == "??");            // overlong '/'
  CHECK(plain_text("\xe0\x80\xaf") == "???");       // overlong '/'
  CHECK(plain_text("\xed\xa0\x80") == "???");       // a surrogate
  CHECK(plain_text("\xf4\x90\x80\x80") == "????");  // above U+10FFFF
  CHECK(plain_text("\xf4\x8f\xbf\xbf") == "\xf4\x8f\xbf\xbf");
}

TEST_CASE("output: columns count code points, and cutting never splits one") {
  CHECK(display_columns("") == 0);
  CHECK(display_columns("a—b≤") == 4);
  CHECK(first_columns("a—b≤", 2) == "a—");
  CHECK(first_columns("a—b≤", 4) == "a—b≤");
  CHECK(first_columns("a—b≤", 9) == "a—b≤");
  CHECK(first_columns("—", 0).empty());
}

TEST_CASE("output: text width is near that of DejaVu Sans, and not below it by much") {
  // Sums of the advance widths in DejaVuSans.ttf 2.37, in units of the font size.
  const std::pair<const char*, double> widths[] = {{"munjiza", 3.935},
                                                   {"munjiza-stage-moments", 12.155},
                                                   {"arkode-erk4", 6.067},
                                                   {"exact-free-top", 7.116},
                                                   {"beam-energy-momentum", 12.870},
                                                   {"reference’s error bound", 11.903},
                                                   {"CPU time [µs]", 6.866},
                                                   {"orientation error at t = 10 s [rad]", 16.623}};
  for (const auto& [text, width] : widths) {
    CAPTURE(text);
    CHECK(text_width(text, 1.0) > 0.98 * width);
    CHECK(text_width(text, 1.0) < 1.08 * width);
    CHECK(std::abs(text_width(text, 15.0) - 15.0 * text_width(text, 1.0)) < 1e-12 * 15.0 * width);
  }
}
