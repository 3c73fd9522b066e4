#include "src/statics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace gnomon {
namespace {

using Vector = std::vector<double>;

class Path {
 public:
  Path(StaticSystem& system, const StaticsOptions& options) : system_(system), options_(options) {
    const std::size_t n = static_cast<std::size_t>(system.size());
    for (Vector* vector : {&u_, &from_, &change_, &predicted_, &before_, &residual_, &along_})
      vector->assign(n, 0.0);
  }

  StaticPath follow() {
    const bool reached = options_.arc_length ? by_length() : by_load(1.0 / options_.load_steps);
    if (!reached && path_.status == Status::ok) path_.status = Status::newton_failed;
    return std::move(path_);
  }

 private:
  static constexpr int most_iterations = 25;
  static constexpr double smallest_part = 1.0 / 8192.0;  ///< of the first step

  double norm(const Vector& values, bool forces) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double lever = system_.lever(static_cast<int>(i));
      const double value = forces ? values[i] / lever : values[i] * lever;
      sum += value * value;
    }
    return std::sqrt(sum);
  }
  double product(const Vector& a, const Vector& b) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double lever = system_.lever(static_cast<int>(i));
      sum += a[i] * b[i] * lever * lever;
    }
    return sum;
  }
  double evaluate(double factor) {
    scale_ = system_.residual(factor, u_.data(), residual_.data());
    return norm(residual_, true);
  }
  bool small(double size) const { return size <= std::max(options_.newton_tol * scale_, system_.roundoff()); }
  /// Whether an iteration is done with a correction of size `now` after one of size `before`: at roundoff
  /// corrections do not shrink any more, before that they shrink quadratically.
  bool settled(double now, double before) const {
    const double size = norm(u_, false);
    return now <= 1e-14 * size || (now <= 1e-7 * size && now > 0.1 * before);
  }
  /// du/dfactor along the path at u.
  void tangent(double factor) {
    system_.factorise(factor, u_.data());
    tangent_again(factor);
  }
  /// The same with the factors at hand.
  void tangent_again(double factor) {
    system_.load(factor, u_.data(), along_.data());
    system_.solve(along_.data());
    // What is prescribed grows by itself.
    std::fill(before_.begin(), before_.end(), 0.0);
    system_.prescribe(1.0, before_.data());
    for (std::size_t i = 0; i < along_.size(); ++i) along_[i] += before_[i];
  }

  /// Newton's method at a fixed factor; the number of corrections if it converges.
  std::optional<int> correct(double factor) {
    double size = evaluate(factor);
    const double first = size;
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= most_iterations; ++k) {
      bool last = small(size);
      if (!std::isfinite(size) || size > 1e6 * (first + scale_)) return std::nullopt;
      system_.factorise(factor, u_.data());
      system_.solve(residual_.data());
      const double now = norm(residual_, false);
      for (std::size_t i = 0; i < u_.size(); ++i) u_[i] += residual_[i];
      last = last || settled(now, std::exchange(before, now));
      size = evaluate(factor);
      if (last) return std::isfinite(size) ? std::optional<int>(k + 1) : std::nullopt;
    }
    return std::nullopt;
  }

  bool keep(double factor, int iterations) {
    path_.points.push_back({factor, iterations, system_.state(u_.data())});
    if (options_.stop && options_.stop->load(std::memory_order_relaxed)) {
      path_.status = Status::interrupted;
      path_.message = "interrupted";
    } else if (static_cast<long>(path_.points.size()) >= options_.max_points && factor != 1.0) {
      path_.status = Status::step_limit;
      path_.message = fmt::format("{} points were found before the whole load was reached, at factor {:.6g}",
                                  path_.points.size(), factor);
    }
    return path_.status == Status::ok;
  }

  /// One step of load control from a point of the path, whose tangent is `along_`.
  std::optional<int> load_step(double factor, double next) {
    from_ = u_;
    for (std::size_t i = 0; i < u_.size(); ++i) u_[i] += (next - factor) * along_[i];
    system_.prescribe(next, u_.data());
    const Vector predicted = u_;
    const double step = (next - factor) * norm(along_, false);
    const std::optional<int> iterations = correct(next);
    double off = 0.0;
    for (std::size_t i = 0; i < u_.size(); ++i) {
      const double d = (u_[i] - predicted[i]) * system_.lever(static_cast<int>(i));
      off += d * d;
    }
    // A solution that is not where the path leads may belong to another branch.
    if (iterations && std::sqrt(off) <= 0.5 * step + system_.roundoff()) return iterations;
    u_ = from_;
    return std::nullopt;
  }

  bool by_load(double first) {
    double factor = 0.0, step = first;
    while (factor < 1.0) {
      tangent(factor);
      std::optional<int> iterations;
      double next = 1.0;
      for (;;) {
        next = factor + step;
        // Whole steps are exact multiples of the first, whatever was added up.
        const double whole = std::round(next / first) * first;
        if (std::abs(next - whole) <= 1e-9 * first) next = whole;
        if (next > 1.0 - 1e-9 * first) next = 1.0;
        iterations = load_step(factor, next);
        if (iterations || step < smallest_part * first) break;
        step *= 0.5;
      }
      if (!iterations) {
        path_.message = fmt::format(
            "no equilibrium was found beyond load factor {:.6g}; --arc-length passes limit points", factor);
        return false;
      }
      factor = next;
      if (!keep(factor, *iterations)) return false;
      if (*iterations <= 5) step = std::min(2.0 * step, first);
    }
    return true;
  }

  bool by_length() {
    double factor = 0.0, length = 0.0, least = 0.0, most = 0.0;
    Vector last_change(u_.size(), 0.0);
    for (;;) {
      tangent(factor);
      const double speed = norm(along_, false);
      if (!(speed > 0.0) || !std::isfinite(speed)) {
        path_.message = "the loads move nothing";
        return false;
      }
      if (length == 0.0) {
        length = speed / options_.load_steps;
        most = length;
        least = smallest_part * length;
      }
      const double sign = product(along_, last_change) < 0.0 ? -1.0 : 1.0;
      from_ = u_;
      std::optional<int> iterations;
      double next = factor;
      for (;;) {
        const double predicted = next = factor + sign * length / speed;
        for (std::size_t i = 0; i < u_.size(); ++i) predicted_[i] = sign * length / speed * along_[i];
        iterations = length_step(factor, next, sign, length);
        if (iterations && !follows(predicted, next, factor, length)) iterations.reset();
        if (iterations || length < least) break;
        u_ = from_;
        length *= 0.5;
        tangent(factor);
      }
      if (!iterations) {
        path_.message = fmt::format("the path of equilibria was lost at load factor {:.6g}", factor);
        return false;
      }
      if (factor < 1.0 && next >= 1.0) return finish(factor, next);
      for (std::size_t i = 0; i < u_.size(); ++i) last_change[i] = u_[i] - from_[i];
      factor = next;
      if (!keep(factor, *iterations)) return false;
      length = std::min(most, length * std::clamp(std::sqrt(5.0 / *iterations), 0.5, 2.0));
    }
  }

  /// Newton's method with the length of the step in u fixed; `next` becomes the factor.
  std::optional<int> length_step(double factor, double& next, double sign, double length) {
    change_ = along_;
    const double scale = length / norm(along_, false) * sign;
    for (double& value : change_) value *= scale;
    set(next);
    double size = evaluate(next), before = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= most_iterations; ++k) {
      bool last = small(size);
      if (!std::isfinite(size)) return std::nullopt;
      system_.factorise(next, u_.data());
      system_.solve(residual_.data());
      tangent_again(next);
      // |change + x + y along| = length, x the correction at a fixed factor
      Vector moved = change_;
      for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += residual_[i];
      const double a = product(along_, along_), b = product(along_, moved),
                   c = product(moved, moved) - length * length, root = b * b - a * c;
      if (!(root >= 0.0)) return std::nullopt;
      // The root that keeps nearer to the direction so far.
      const double ahead = product(change_, along_);
      const double y = (-b + (ahead >= 0.0 ? 1.0 : -1.0) * std::sqrt(root)) / a;
      for (std::size_t i = 0; i < moved.size(); ++i) {
        const double now = moved[i] + y * along_[i];
        residual_[i] = now - change_[i];
        change_[i] = now;
      }
      next += y;
      set(next);
      const double now = norm(residual_, false);
      last = last || settled(now, std::exchange(before, now));
      size = evaluate(next);
      if (std::abs(next - factor) > 10.0 / options_.load_steps + 1.0) return std::nullopt;
      if (last) return std::isfinite(size) ? std::optional<int>(k + 1) : std::nullopt;
    }
    return std::nullopt;
  }
  /// Whether a step of `length` from `factor` to `next`, which converged, is short enough to see what the
  /// path does: the factor changes by no more than a step of the loads, by less than half of it otherwise
  /// than predicted, and u goes where the tangent pointed.
  bool follows(double predicted, double next, double factor, double length) const {
    const double most = 1.0 / options_.load_steps;
    double off = 0.0;
    for (std::size_t i = 0; i < u_.size(); ++i) {
      const double d = (change_[i] - predicted_[i]) * system_.lever(static_cast<int>(i));
      off += d * d;
    }
    return std::abs(next - factor) <= (1.0 + 1e-9) * most && std::abs(next - predicted) <= 0.5 * most &&
           std::sqrt(off) <= 0.5 * length;
  }
  void set(double factor) {
    for (std::size_t i = 0; i < u_.size(); ++i) u_[i] = from_[i] + change_[i];
    system_.prescribe(factor, u_.data());
  }

  /// From the two points of the path between which the factor passes 1 to the one where it is 1.
  bool finish(double factor, double next) {
    const double part = (1.0 - factor) / (next - factor);
    for (std::size_t i = 0; i < u_.size(); ++i) u_[i] = from_[i] + part * (u_[i] - from_[i]);
    system_.prescribe(1.0, u_.data());
    const std::optional<int> iterations = correct(1.0);
    if (!iterations) {
      path_.message = "Newton's method failed at the whole load";
      return false;
    }
    return keep(1.0, *iterations);
  }

  StaticSystem& system_;
  const StaticsOptions& options_;
  StaticPath path_;
  Vector u_, from_, change_, predicted_, before_, residual_, along_;
  double scale_ = 0.0;
};

}  // namespace

StaticPath follow_equilibrium(StaticSystem& system, const StaticsOptions& options) {
  return Path(system, options).follow();
}

}  // namespace gnomon
