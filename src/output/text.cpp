#include "src/output/text.hpp"

#include <algorithm>

namespace gnomon::output {
namespace {

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// Length in bytes of the valid code point at `i`, or 0. Overlong forms, surrogates and values above U+10FFFF
/// are not valid (RFC 3629, section 4).
std::size_t code_point_length(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned lead = byte(i);
  std::size_t length = 0;
  if (lead < 0x80) return 1;
  if (lead >= 0xC2 && lead <= 0xDF) length = 2;
  if (lead >= 0xE0 && lead <= 0xEF) length = 3;
  if (lead >= 0xF0 && lead <= 0xF4) length = 4;
  if (length == 0 || i + length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if (!is_continuation(text[i + k])) return 0;
  }
  const unsigned second = byte(i + 1);
  if (lead == 0xE0 && second < 0xA0) return 0;
  if (lead == 0xED && second > 0x9F) return 0;
  if (lead == 0xF0 && second < 0x90) return 0;
  if (lead == 0xF4 && second > 0x8F) return 0;
  return length;
}

}  // namespace

std::string plain_text(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = code_point_length(text, i);
    const unsigned byte = static_cast<unsigned char>(text[i]);
    if (length == 0) {
      result += '?';
    } else if (byte < 0x20 || byte == 0x7F) {
      result += ' ';
    } else {
      result += text.substr(i, length);
    }
    i += std::max<std::size_t>(length, 1);
  }
  return result;
}

std::size_t display_columns(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return !is_continuation(c); }));
}

std::string first_columns(std::string_view text, std::size_t columns) {
  std::size_t end = 0;
  std::size_t seen = 0;
  while (end < text.size()) {
    if (!is_continuation(text[end]) && seen++ == columns) break;
    ++end;
  }
  return std::string(text.substr(0, end));
}

double text_width(std::string_view text, double font_size) {
  double em = 0.0;
  for (const char c : text) {
    if (is_continuation(c)) continue;
    const auto is_in = [c](std::string_view set) { return set.find(c) != std::string_view::npos; };
    if (is_in("ijl.,:;'|! ")) {
      em += 0.31;
    } else if (is_in("rft()[]/-")) {
      em += 0.39;
    } else if (is_in("csz")) {
      em += 0.54;
    } else if (is_in("mwMW@%")) {
      em += 0.92;
    } else if (c >= 'A' && c <= 'Z') {
      em += 0.70;
    } else {
      em += 0.625;
    }
  }
  return em * font_size;
}

}  // namespace gnomon::output
