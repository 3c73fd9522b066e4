#pragma once
// UTF-8 text as it is shown: what is printable, and how wide it is.

#include <cstddef>
#include <string>
#include <string_view>

namespace gnomon::output {

/// A copy fit for one line of output: control characters (line ends and tabs too) become spaces, bytes that
/// are not valid UTF-8 become '?'.
std::string plain_text(std::string_view text);

/// Number of terminal columns of valid UTF-8 text, one for each code point. (Wide and combining characters
/// are not used in this program.)
std::size_t display_columns(std::string_view text);

/// The first `columns` columns of `text`, never cutting a code point.
std::string first_columns(std::string_view text, std::size_t columns);

/// Approximate width of `text` in a sans-serif font (DejaVu Sans), in the unit of `font_size`.
double text_width(std::string_view text, double font_size);

}  // namespace gnomon::output
