#include "src/study/vary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

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

/// A finite number in decimal digits.
std::optional<double> decimal(const std::string& text) {
  const std::size_t plus = text.starts_with("+") ? 1 : 0;
  double number = 0.0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data() + plus, end, number);
  if (result.ec != std::errc() || result.ptr != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

}  // namespace

std::optional<std::vector<double>> Variation::numbers() const {
  std::vector<double> list;
  for (const std::string& value : values) {
    const auto number = decimal(value);
    if (!number) return std::nullopt;
    list.push_back(*number);
  }
  return list;
}

std::optional<Variation::Axis> Variation::axis() const {
  if (auto list = numbers()) return Axis{key, std::move(*list)};
  std::vector<std::vector<double>> lists;
  for (const std::string& value : values) {
    if (value.size() < 2 || value.front() != '[' || value.back() != ']') return std::nullopt;
    lists.emplace_back();
    for (const std::string& part : outer_parts(value.substr(1, value.size() - 2))) {
      const auto number = decimal(part);
      if (!number) return std::nullopt;
      lists.back().push_back(*number);
    }
    if (lists.back().size() != lists.front().size()) return std::nullopt;
  }
  std::optional<std::size_t> changing;
  std::vector<std::string> shown;
  for (std::size_t place = 0; place < lists.front().size(); ++place) {
    const double first = lists.front()[place];
    const bool changes = std::ranges::any_of(lists, [&](const auto& list) { return list[place] != first; });
    if (changes && changing) return std::nullopt;
    if (changes) changing = place;
    shown.push_back(changes ? "x" : fmt::format("{:g}", first));
  }
  if (!changing) return std::nullopt;
  Axis axis{fmt::format("x in {} = [{}]", key, fmt::join(shown, ", ")), {}};
  for (const auto& list : lists) axis.values.push_back(list[*changing]);
  return axis;
}

std::string Variation::repeated() const {
  const auto list = numbers();
  for (std::size_t k = 0; k < values.size(); ++k)
    for (std::size_t j = 0; j < k; ++j)
      if (values[j] == values[k] || (list && (*list)[j] == (*list)[k])) return values[k];
  return "";
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
    variation.values.push_back(std::move(value));
  }
  if (const std::string twice = variation.repeated(); !twice.empty())
    refuse(fmt::format("'{}' twice", twice));
  return variation;
}

}  // namespace gnomon
