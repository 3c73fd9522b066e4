#include "src/output/figure_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "src/output/text.hpp"

namespace gnomon::output {
namespace {

constexpr double smallest = 1e-300;
constexpr double largest = 1e300;
constexpr int fewest_labels = 6;       // from which on steps of 1, 2, 5 always leave two
constexpr double margin = 0.04;        // of the axis, on each side of the data
constexpr double least_decades = 0.9;  // of a log axis, so that there are always two labels

std::string with_minus_sign(std::string text) {
  for (std::size_t i = text.find('-'); i != std::string::npos; i = text.find('-', i)) text.replace(i, 1, "−");
  return text;
}

std::string power_label(int multiple, int exponent) {
  const std::string power = with_minus_sign(fmt::format("10^{{{}}}", exponent));
  return multiple == 1 ? power : fmt::format("{}×{}", multiple, power);
}

/// multiple * 10^exponent, correctly rounded.
double decimal(int multiple, int exponent) {
  return std::strtod(fmt::format("{}e{}", multiple, exponent).c_str(), nullptr);
}

bool contains(const Range& range, double value) { return range.low <= value && value <= range.high; }

/// Ticks at multiples of powers of ten: those in `labelled` have labels.
std::vector<Tick> ticks_within_decades(const Range& range, int first, int last,
                                       const std::vector<int>& labelled) {
  const bool plain = labelled.size() > 1 && range.low >= 9e-4 && range.high <= 1.1e4;
  std::vector<Tick> ticks;
  for (int exponent = first; exponent <= last; ++exponent) {
    for (int multiple = 1; multiple <= 9; ++multiple) {
      const double value = decimal(multiple, exponent);
      if (!contains(range, value)) continue;
      const bool has_label = std::find(labelled.begin(), labelled.end(), multiple) != labelled.end();
      const std::string label = plain ? fmt::format("{:g}", value) : power_label(multiple, exponent);
      ticks.push_back({value, has_label ? label : ""});
    }
  }
  return ticks;
}

int label_count(const std::vector<Tick>& ticks) {
  return static_cast<int>(
      std::count_if(ticks.begin(), ticks.end(), [](const Tick& tick) { return !tick.label.empty(); }));
}

std::vector<Tick> log_ticks(const Range& range, int labels) {
  const int first = static_cast<int>(std::floor(std::log10(range.low)));
  const int last = static_cast<int>(std::ceil(std::log10(range.high)));
  if (std::log10(range.high) - std::log10(range.low) < 2.0) {
    for (const auto& labelled : {std::vector<int>{1, 2, 5}, std::vector<int>{1, 3}}) {
      auto ticks = ticks_within_decades(range, first, last, labelled);
      if (label_count(ticks) <= labels) return ticks;
    }
  }
  if (last - first <= labels + 1) {
    auto ticks = ticks_within_decades(range, first, last, {1});
    if (label_count(ticks) <= labels && label_count(ticks) >= 2) return ticks;
  }
  std::vector<int> powers;
  for (int exponent = first; exponent <= last; ++exponent) {
    if (contains(range, decimal(1, exponent))) powers.push_back(exponent);
  }
  // Multiples of the step, so that labels do not depend on where the data begin; there are then two or more.
  const int count = static_cast<int>(powers.size());
  const int step = (count + labels - 1) / labels;
  std::vector<Tick> ticks;
  for (const int exponent : powers) {
    if (step > 5 && exponent % step != 0) continue;
    ticks.push_back({decimal(1, exponent), exponent % step == 0 ? power_label(1, exponent) : ""});
  }
  return ticks;
}

/// k * step as a label; `step` is 1, 2 or 5 times 10^exponent.
std::string linear_label(double value, double largest_value, int exponent) {
  if (value == 0.0) return "0";
  if (largest_value < 1e6 && exponent >= -5) {
    return with_minus_sign(fmt::format("{:.{}f}", value, std::max(0, -exponent)));
  }
  const int power = static_cast<int>(std::floor(std::log10(largest_value) + 1e-9));
  const std::string mantissa =
      fmt::format("{:.{}f}", value / std::pow(10.0, power), std::max(0, power - exponent));
  return with_minus_sign(fmt::format("{}×10^{{{}}}", mantissa, power));
}

std::vector<Tick> linear_ticks(const Range& range, int labels) {
  const double span = range.high - range.low;
  int exponent = static_cast<int>(std::floor(std::log10(span / labels)));
  int multiple = 1;
  const auto step = [&] { return decimal(multiple, exponent); };
  while (std::floor(range.high / step()) - std::ceil(range.low / step()) + 1 > labels) {
    multiple = multiple == 1 ? 2 : multiple == 2 ? 5 : 1;
    if (multiple == 1) ++exponent;
  }
  const int parts = multiple == 2 ? 4 : 5;
  const double minor = step() / parts;
  const double largest_value = std::max(std::abs(range.low), std::abs(range.high));
  std::vector<Tick> ticks;
  for (double k = std::ceil(range.low / minor - 1e-9); k * minor <= range.high + 1e-9 * minor; k += 1.0) {
    const bool major = std::fmod(k, parts) == 0.0;
    const double value = major ? k / parts * step() : k * minor;
    ticks.push_back({value, major ? linear_label(value, largest_value, exponent) : ""});
  }
  return ticks;
}

/// Whether the ends of a linear range can be told apart on an axis.
bool has_extent(const Range& range) {
  const double scale = std::max(std::abs(range.low), std::abs(range.high));
  return range.high - range.low > std::max(1e-12 * scale, smallest);
}

bool is_valid(const Range& range, bool log) {
  if (!can_be_drawn(range.low, log) || !can_be_drawn(range.high, log)) return false;
  return log ? range.high / 1.01 > range.low : has_extent(range);
}

Range padded(Range data, bool log) {
  if (log) {
    double low = std::log10(data.low);
    double high = std::log10(data.high);
    double extra = margin * (high - low);
    extra = std::max(extra, 0.5 * (least_decades - (high - low)));
    return {std::pow(10.0, std::max(low - extra, -304.0)), std::pow(10.0, std::min(high + extra, 304.0))};
  }
  const double span = data.high - data.low;
  if (has_extent(data)) return {data.low - margin * span, data.high + margin * span};
  const double scale = std::max(std::abs(data.low), std::abs(data.high));
  const double extra = scale > smallest ? 0.5 * scale : 1.0;
  return {data.low - extra, data.high + extra};
}

}  // namespace

double Axis::position(double value) const {
  // Not the logarithm of ratios, which can overflow.
  if (log) return (std::log(value) - std::log(range.low)) / (std::log(range.high) - std::log(range.low));
  return (value - range.low) / (range.high - range.low);
}

double Axis::decade() const { return log ? 1.0 / (std::log10(range.high) - std::log10(range.low)) : 0.0; }

bool can_be_drawn(double value, bool log) {
  if (!std::isfinite(value) || std::abs(value) > largest) return false;
  return !log || value >= smallest;
}

std::optional<Range> range_of(const std::vector<double>& values, bool log) {
  std::optional<Range> range;
  for (const double value : values) {
    if (can_be_drawn(value, log)) range = united(range, Range{value, value});
  }
  return range;
}

std::optional<Range> united(const std::optional<Range>& a, const std::optional<Range>& b) {
  if (!a) return b;
  if (!b) return a;
  return Range{std::min(a->low, b->low), std::max(a->high, b->high)};
}

Axis make_axis(bool log, const std::optional<Range>& data, const std::optional<Range>& fixed, int labels) {
  Axis axis;
  axis.log = log;
  if (fixed && is_valid(*fixed, log)) {
    axis.range = *fixed;
  } else {
    axis.range = data ? padded(*data, log) : Range{log ? 1.0 : 0.0, log ? 10.0 : 1.0};
  }
  labels = std::max(labels, fewest_labels);
  axis.ticks = log ? log_ticks(axis.range, labels) : linear_ticks(axis.range, labels);
  return axis;
}

int widest_label(const Axis& axis) {
  int widest = 0;
  for (const Tick& tick : axis.ticks) {
    std::string drawn = tick.label;
    std::erase_if(drawn, [](char c) { return std::string_view("^{}").find(c) != std::string_view::npos; });
    widest = std::max(widest, static_cast<int>(display_columns(drawn)));
  }
  return widest;
}

}  // namespace gnomon::output
