#include "src/study/vary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "src/error.hpp"

namespace gnomon {
namespace {

/// Parts between the commas that stand outside of brackets and quotes, blanks around them removed.
std::vector<std::string> outer_parts(const std::string& text) {
  std::vector<std::string> parts(1);
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      --depth;
    }
    if (c == ',' && depth == 0 && quote == 0)
      parts.emplace_back();
    else if (c != ' ' || (!parts.back().empty() && (depth > 0 || quote != 0)))
      parts.back() += c;
  }
  return parts;
}

}  // namespace

std::optional<std::vector<double>> Variation::numbers() const {
  std::vector<double> list;
  for (const std::string& value : values) {
    const std::size_t plus = value.starts_with("+") ? 1 : 0;
    double number = 0.0;
    const char* end = value.data() + value.size();
    const auto result = std::from_chars(value.data() + plus, end, number);
    if (result.ec != std::errc() || result.ptr != end || !std::isfinite(number)) return std::nullopt;
    list.push_back(number);
  }
  return list;
}

Variation read_variation(const std::string& option, const std::string& text) {
  const auto refuse = [&](const std::string& found) {
    throw UsageError(
        fmt::format("{}: found {}, expected KEY.PATH=V1,V2,.. with every value once, as in "
                    "beam.EA=1e4,1e6,1e8",
                    option, found));
  };
  Variation variation;
  const std::size_t equals = text.find('=');
  variation.key = text.substr(0, equals);
  if (equals == std::string::npos || variation.key.empty()) refuse(fmt::format("'{}'", text));
  for (std::string& value : outer_parts(text.substr(equals + 1))) {
    if (value.empty()) refuse(fmt::format("'{}'", text));
    if (std::ranges::find(variation.values, value) != variation.values.end())
      refuse(fmt::format("'{}' twice", value));
    variation.values.push_back(std::move(value));
  }
  // The same number in two spellings is the same scene.
  if (const auto list = variation.numbers())
    for (std::size_t k = 0; k < list->size(); ++k)
      if (std::find(list->begin(), list->begin() + static_cast<std::ptrdiff_t>(k), (*list)[k]) !=
          list->begin() + static_cast<std::ptrdiff_t>(k))
        refuse(fmt::format("'{}' twice", variation.values[k]));
  return variation;
}

}  // namespace gnomon
