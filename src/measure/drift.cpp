#include "src/measure/drift.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <stdexcept>

#include "src/measure/statistics.hpp"

namespace gnomon {
namespace {

constexpr double least_rounding = 1e-13;  // of the initial values and of evaluating the invariant
constexpr double least_loss = 1e-9;
constexpr double saturation_level = 1e-2, far_level = 0.1;  // relative to the invariant's scale
constexpr std::size_t min_samples = 32;
constexpr std::size_t max_blocks = 64;
constexpr int max_doublings = 4;

struct Sample {
  double time;
  double error;
};
using Samples = std::vector<Sample>;

struct Line {
  double intercept;
  double slope;
};

Line least_squares(std::span<const Sample> samples) {
  const auto n = static_cast<double>(samples.size());
  double mean_time = 0.0, mean_error = 0.0;
  for (const Sample& s : samples) {
    mean_time += s.time / n;
    mean_error += s.error / n;
  }
  double tt = 0.0, td = 0.0;
  for (const Sample& s : samples) {
    tt += (s.time - mean_time) * (s.time - mean_time);
    td += (s.time - mean_time) * (s.error - mean_error);
  }
  const double slope = tt > 0.0 ? td / tt : 0.0;
  return {mean_error - slope * mean_time, slope};
}

std::vector<double> residuals(std::span<const Sample> samples, const Line& line) {
  std::vector<double> rest;
  for (const Sample& s : samples) rest.push_back(s.error - (line.intercept + line.slope * s.time));
  return rest;
}

Samples block_means(const Samples& samples) {
  const std::size_t count = std::min(max_blocks, samples.size());
  Samples means;
  for (std::size_t block = 0; block < count; ++block) {
    const std::size_t begin = block * samples.size() / count;
    const std::size_t end = (block + 1) * samples.size() / count;
    Sample mean{0.0, 0.0};
    for (std::size_t i = begin; i < end; ++i) {
      mean.time += samples[i].time / static_cast<double>(end - begin);
      mean.error += samples[i].error / static_cast<double>(end - begin);
    }
    means.push_back(mean);
  }
  return means;
}

// Correlation of successive residuals, corrected for the bias that fitting a line brings (-(2 + 4 rho) / n).
double autocorrelation(const std::vector<double>& rest) {
  double product = 0.0, square = 0.0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    square += rest[i] * rest[i];
    if (i > 0) product += rest[i - 1] * rest[i];
  }
  if (square <= 0.0) return 0.0;
  const double rho = product / square;
  return std::max(0.0, rho + (2.0 + 4.0 * rho) / static_cast<double>(rest.size()));
}

// Standard error of the slope if the blocks scatter about a line with correlation rho from one to the next.
double stationary_error(const Samples& blocks, const std::vector<double>& rest, double rho) {
  const auto n = static_cast<double>(blocks.size());
  double mean_time = 0.0, tt = 0.0, square = 0.0;
  for (const Sample& s : blocks) mean_time += s.time / n;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    tt += (blocks[i].time - mean_time) * (blocks[i].time - mean_time);
    square += rest[i] * rest[i];
  }
  return std::sqrt(square / (n - 2.0) / tt * (1.0 + rho) / (1.0 - rho));
}

// Standard error of the least-squares slope if the samples are a random walk with variance v t: sqrt(6/5 v /
// T). The increments of means over blocks of length D have the variance 2/3 v D.
double random_walk_error(const Samples& blocks) {
  const auto n = static_cast<double>(blocks.size() - 1);
  const double mean = (blocks.back().error - blocks.front().error) / n;
  double square = 0.0;
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    const double increment = blocks[i].error - blocks[i - 1].error - mean;
    square += increment * increment;
  }
  return std::sqrt(9.0 / 5.0 * square / (n - 1.0) * n) / (blocks.back().time - blocks.front().time);
}

// Blocks hardly distinguishable from a random walk (Perron & Yabu, J. Econometrics 151 (2009) 56; half their
// distance from rho = 1 is too little for 64 blocks).
bool walks(const Samples& blocks, const Line& line) {
  const double rho = autocorrelation(residuals(blocks, line));
  return rho >= 1.0 - 2.0 / std::sqrt(static_cast<double>(blocks.size()));
}

// Blocks that walk are taken for a random walk, and tiny errors always: the chance trend of a random walk
// must not pass for a real one.
double slope_error(const Samples& blocks, const Line& line, bool tiny) {
  if (tiny || walks(blocks, line)) return random_walk_error(blocks);
  const std::vector<double> rest = residuals(blocks, line);
  return stationary_error(blocks, rest, autocorrelation(rest));
}

// Slope of log max |d| over the windows [start, start + span / 2^k] that hold at least 16 samples.
double growth_exponent(const Samples& samples, double start) {
  constexpr std::size_t fewest = 16;
  const double span = samples.back().time - start;
  Samples maxima;
  for (int k = 0; k <= max_doublings; ++k) {
    const double length = std::ldexp(span, -k);
    double largest = std::numeric_limits<double>::epsilon();  // a smaller error is not resolved
    std::size_t count = 0;
    for (; count < samples.size() && samples[count].time - start <= length; ++count)
      largest = std::max(largest, std::abs(samples[count].error));
    if (count < fewest) break;
    maxima.push_back({std::log(length), std::log(largest)});
  }
  return maxima.size() < 2 ? Drift::none : least_squares(maxima).slope;
}

// A trend towards zero that has levelled off in the second half: the end of a transient.
bool dies_away(const Samples& blocks, const Line& line) {
  const std::span<const Sample> all(blocks);
  const std::size_t half = blocks.size() / 2;
  const auto level = [](std::span<const Sample> part) {
    double sum = 0.0;
    for (const Sample& s : part) sum += s.error;
    return std::abs(sum) / static_cast<double>(part.size());
  };
  const double late = least_squares(all.subspan(half)).slope;
  return std::abs(late) < 0.5 * std::abs(line.slope) && level(all.subspan(half)) < level(all.first(half));
}

// Growth that the second half of the run confirms.
bool keeps_growing(const Samples& blocks) {
  const std::span<const Sample> all(blocks);
  const std::size_t half = blocks.size() / 2;
  const auto largest = [](std::span<const Sample> part) {
    double value = 0.0;
    for (const Sample& s : part) value = std::max(value, std::abs(s.error));
    return value;
  };
  return largest(all.subspan(half)) > 1.5 * largest(all.first(half));
}

// The increments of the block means have one sign more often than chance would have it.
bool moves_one_way(const Samples& blocks) {
  int sum = 0;
  for (std::size_t i = 1; i < blocks.size(); ++i)
    sum += (blocks[i].error > blocks[i - 1].error) - (blocks[i].error < blocks[i - 1].error);
  return std::abs(sum) > 4.0 * std::sqrt(static_cast<double>(blocks.size() - 1));
}

// What is lost and not regained: all of the loss, and that of the second half.
struct Loss {
  double all = 0.0;
  double late = 0.0;
};
std::optional<Loss> loss(const Samples& samples, double middle) {
  double least = std::min(samples.front().error, 0.0), regained = 0.0, before = 0.0, highest = 0.0;
  for (const Sample& s : samples) {
    least = std::min(least, s.error);
    regained = std::max(regained, s.error - least);
    highest = std::max(highest, s.error);
    if (s.time <= middle) before = least;
  }
  const bool seen = samples.front().error > 0.5 * least;  // not lost before the first sample
  if (!(least < -least_loss) || !seen || std::max(regained, highest) > -0.1 * least) return std::nullopt;
  return Loss{-least, before - least};
}

// Grew up to half of the largest error, fourfold or more in the last three doublings of time, and has not
// come back to a quarter of it in the second half does not come back.
bool is_saturated(const Samples& samples, const Samples& blocks, double largest) {
  constexpr std::size_t resolved = 8;
  const auto far = [&](const Sample& s) { return std::abs(s.error) >= 0.5 * largest; };
  const auto arrival = static_cast<std::size_t>(std::ranges::find_if(samples, far) - samples.begin());
  if (arrival < resolved) return false;
  double early = 0.0;
  for (std::size_t i = 0; i < arrival / 8; ++i) early = std::max(early, std::abs(samples[i].error));
  if (early > 0.125 * largest) return false;
  const auto late = std::span<const Sample>(blocks).subspan(blocks.size() / 2);
  return std::ranges::all_of(late, [&](const Sample& s) { return std::abs(s.error) > 0.25 * largest; });
}

DriftVerdict judge(const Drift& drift, const Samples& samples, const Samples& blocks, const Line& line,
                   double span, double rounding) {
  if (const auto lost = loss(samples, samples.back().time - 0.5 * span))
    return lost->late < 0.25 * lost->all ? DriftVerdict::dissipated : DriftVerdict::secular;
  const double change = std::abs(drift.slope) * span;
  const double negligible = rounding * std::max(1.0, drift.max_abs);
  const bool significant = std::abs(drift.slope) > 3.0 * drift.slope_error;
  const bool large = change > std::max(drift.oscillation, negligible);
  if (significant && large && !dies_away(blocks, line)) return DriftVerdict::secular;
  // A blow-up is no line.
  if (drift.growth > 1.2 && moves_one_way(blocks) && keeps_growing(blocks)) return DriftVerdict::secular;
  if (drift.max_abs > saturation_level && is_saturated(samples, blocks, drift.max_abs))
    return DriftVerdict::saturated;
  if (drift.max_abs > far_level) return DriftVerdict::far_off;
  if (drift.growth < 0.1) return DriftVerdict::bounded;
  return walks(blocks, line) || keeps_growing(blocks) ? DriftVerdict::undecided : DriftVerdict::bounded;
}

}  // namespace

std::string_view to_string(DriftVerdict verdict) {
  switch (verdict) {
    case DriftVerdict::bounded:
      return "bounded";
    case DriftVerdict::secular:
      return "secular";
    case DriftVerdict::roundoff:
      return "roundoff";
    case DriftVerdict::dissipated:
      return "dissipated";
    case DriftVerdict::newton:
      return "Newton residue";
    case DriftVerdict::saturated:
      return "saturated";
    case DriftVerdict::far_off:
      return "far off";
    case DriftVerdict::undecided:
      return "undecided";
    case DriftVerdict::failed:
      return "failed";
  }
  return "unknown";
}

double rounding_level(double evaluations) {
  return std::max(least_rounding,
                  4.0 * std::numeric_limits<double>::epsilon() * std::sqrt(std::max(0.0, evaluations)));
}

Drift measure_drift(std::span<const double> times, std::span<const double> errors, double start,
                    double rounding) {
  if (times.size() != errors.size()) throw std::invalid_argument("drift: as many times as errors are needed");
  Drift drift;
  Samples samples;
  double largest = 0.0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i]) || !std::isfinite(errors[i])) return drift;
    samples.push_back({times[i], errors[i]});
    largest = std::max(largest, std::abs(errors[i]));
  }
  if (samples.empty()) return drift;
  std::ranges::stable_sort(samples, {}, &Sample::time);

  drift.max_abs = largest;
  drift.verdict = largest <= rounding   ? DriftVerdict::roundoff
                  : largest > far_level ? DriftVerdict::far_off
                                        : DriftVerdict::undecided;
  const double span = samples.back().time - start;
  if (samples.size() < min_samples || span <= 0.0) return drift;

  const Samples blocks = block_means(samples);
  const Line line = least_squares(blocks);
  const std::vector<double> rest = residuals(samples, line);
  drift.oscillation = 0.5 * (quantile(rest, 0.99) - quantile(rest, 0.01));
  drift.slope = line.slope;
  drift.slope_error = slope_error(blocks, line, largest < 100.0 * rounding);
  drift.growth = growth_exponent(samples, start);
  if (largest > rounding) drift.verdict = judge(drift, samples, blocks, line, span, rounding);
  return drift;
}

void allow_newton_residue(Drift& drift, double newton_tol) {
  const bool open = drift.verdict == DriftVerdict::secular || drift.verdict == DriftVerdict::undecided;
  if (open && drift.max_abs <= newton_tol) drift.verdict = DriftVerdict::newton;
}

std::string why_undecided(const Drift& drift) {
  if (drift.verdict != DriftVerdict::undecided) return {};
  if (std::isnan(drift.growth)) return fmt::format("fewer than {} samples", min_samples);
  return fmt::format(
      "it wanders (largest error ~ t^{:.2f}) without a slope that stands out: a longer run would tell",
      drift.growth);
}

std::vector<double> jittered_times(double t0, double t1, int n, std::uint64_t seed) {
  if (!std::isfinite(t0) || !std::isfinite(t1) || t0 >= t1)
    throw std::invalid_argument("jittered times: a finite interval is needed");
  std::mt19937_64 random(seed);
  const double width = (t1 - t0) / n;
  std::vector<double> times;
  for (int i = 0; i + 1 < n; ++i) {
    const double fraction = (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53;  // in (0, 1)
    times.push_back(t0 + (i + fraction) * width);
  }
  if (n > 0) times.push_back(t1);
  return times;
}

}  // namespace gnomon
