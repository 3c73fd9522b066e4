#include "integrators/rotation/lanes/extrapolation.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/rotation/lanes/sequence.hpp"

namespace gnomon::rotation::lanes {
namespace {

using Quaternion = Eigen::Quaterniond;
using Vector3 = Eigen::Vector3d;

/// Counts close to one another make the most of a number of substeps, but their weights grow, and with them
/// rounding: the moduli of the weights add up to 251, 1007 and 10 160.
constexpr Sequence midpoint_fine = sequence_of({4, 6, 8, 10, 12, 14, 16, 18});
constexpr Sequence midpoint_middle = sequence_of({8, 10, 12, 14, 16, 18, 20, 22});
constexpr Sequence midpoint_coarse = sequence_of({16, 18, 20, 22, 24, 26, 28, 30});
/// 251 and 3440.
constexpr Sequence strang_fine = sequence_of({2, 3, 4, 5, 6, 7, 8, 9});
constexpr Sequence strang_coarse = sequence_of({6, 7, 8, 9, 10, 11, 12, 13});

/// y = (q, m) or, for a top, (p, L): what a kernel steps.
using State = std::array<double, 7>;

/// The axis of a body with two equal moments on which its weight acts; -1 if there is none.
int axis_of_top(const Problem& problem) {
  if (problem.load != Load::gravity) return -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
    if (problem.inertia[a] == problem.inertia[b] && problem.load_vector[a] == 0.0 &&
        problem.load_vector[b] == 0.0)
      return static_cast<int>(k);
  }
  return -1;
}

/// A body by the midpoint rule.
class MidpointBody {
 public:
  MidpointBody(const Problem& problem, double tol, const Kernels& kernels)
      : sequence_(&(tol >= 1e-8    ? midpoint_coarse
                    : tol >= 1e-11 ? midpoint_middle
                                   : midpoint_fine)),
        extrapolate_(kernels.extrapolate) {
    for (std::size_t k = 0; k < 3; ++k) {
      body_.inverse_inertia[k] = 1.0 / problem.inertia[k];
      body_.load[k] = problem.load_vector[k];
    }
    switch (problem.load) {
      case Load::none:
        rows_ = kernels.free;
        break;
      case Load::gravity:
        rows_ = kernels.gravity;
        break;
      case Load::space_moment:
        rows_ = kernels.space_moment;
        break;
      case Load::body_moment:
        rows_ = kernels.body_moment;
        break;
    }
    const auto [least, most] = std::minmax_element(problem.inertia.begin(), problem.inertia.end());
    const double load = Vector3::Map(problem.load_vector.data()).norm();
    own_rate_ = problem.load == Load::gravity ? std::sqrt(load / *least) : load / *most;
  }
  const Sequence& sequence() const { return *sequence_; }
  /// A rate of the motion [1/s]; 0 for a body at rest.
  double rate(const State& y) const {
    const Vector3 w(y[4] * body_.inverse_inertia[0], y[5] * body_.inverse_inertia[1],
                    y[6] * body_.inverse_inertia[2]);
    return w.norm() + own_rate_;
  }
  /// The first step times that rate, for a tolerance of 1.
  static constexpr double first_step = 8.0;
  static constexpr double most_turn = std::numeric_limits<double>::infinity();

  State inner(double, const State& y) const { return y; }
  State outer(double, const State& y) const { return y; }
  void step(const State& y, double H, Extrapolated& result) const {
    Rows rows;
    rows_(body_, sequence(), y.data(), H, rows);
    extrapolate_(sequence(), y.data(), rows, result);
  }

 private:
  Body body_;
  const Sequence* sequence_;
  MidpointRows rows_ = nullptr;
  Extrapolate extrapolate_;
  double own_rate_;
};

/// A heavy symmetric top by kicks and drifts. Its axis is made the third one, and its turn about it, which is
/// uniform once the common turn about the momentum is taken out, is applied at output.
class StrangTop {
 public:
  StrangTop(const Problem& problem, int axis, double tol, const Kernels& kernels)
      : sequence_(&(tol >= 1e-9 ? strang_coarse : strang_fine)),
        rows_(kernels.strang),
        extrapolate_(kernels.extrapolate) {
    const std::size_t a = static_cast<std::size_t>(axis);
    const double across = problem.inertia[(a + 1) % 3], along = problem.inertia[a];
    top_ = {0.5 / across, problem.load_vector[a]};
    own_rate_ = std::sqrt(std::abs(top_.moment) / across);
    spin_per_momentum_ = (across - along) / (across * along);
    const double sign = axis == 0 ? 0.5 : -0.5;
    if (axis != 2) axes_ = Quaternion(0.5, sign, sign, sign);
  }
  const Sequence& sequence() const { return *sequence_; }
  double rate(const State& y) const {
    return 2.0 * top_.half_inverse_inertia * Vector3(y[4], y[5], y[6]).norm() + own_rate_;
  }
  static constexpr double first_step = 28.0;
  /// The most that a substep turns [rad]: the series of the drift are good to 1e-12 there.
  static constexpr double most_turn = 5.0;

  State inner(double t, const State& y) {
    const Quaternion q(y[0], y[1], y[2], y[3]);
    const Vector3 L = q * Vector3(y[4], y[5], y[6]);
    spin_ = spin_per_momentum_ * (axes_.conjugate() * Vector3(y[4], y[5], y[6]))[2];
    const Quaternion p = q * axes_ * about_axis(-spin_ * t);
    return {p.w(), p.x(), p.y(), p.z(), L[0], L[1], L[2]};
  }
  State outer(double t, const State& y) const {
    const Quaternion p(y[0], y[1], y[2], y[3]);
    const Quaternion q = (p * about_axis(spin_ * t) * axes_.conjugate()).normalized();
    const Vector3 m = q.conjugate() * Vector3(y[4], y[5], y[6]);
    return {q.w(), q.x(), q.y(), q.z(), m[0], m[1], m[2]};
  }
  void step(const State& y, double H, Extrapolated& result) const {
    Rows rows;
    rows_(top_, sequence(), y.data(), H, rows);
    extrapolate_(sequence(), y.data(), rows, result);
  }

 private:
  static Quaternion about_axis(double angle) {
    return {std::cos(0.5 * angle), 0.0, 0.0, std::sin(0.5 * angle)};
  }

  Top top_;
  const Sequence* sequence_;
  StrangRows rows_;
  Extrapolate extrapolate_;
  double own_rate_, spin_per_momentum_, spin_ = 0.0;
  Quaternion axes_ = Quaternion::Identity();  // from axes with the symmetry axis third to those of the body
};

template <class Stepper>
class Extrapolation final : public AdaptiveSolver {
 public:
  Extrapolation(Stepper stepper, const BodySystem& system, const RunSpec& spec)
      : stepper_(std::move(stepper)),
        scale_(system.problem().momentum_scale),
        rounding_(rounding(stepper_.sequence())),
        allowed_(std::max(*spec.tol, rounding_)),
        max_steps_(spec.max_steps) {
    system.start(outer_.data());
    inner_ = stepper_.inner(0.0, outer_);
    horizon_ = spec.t_end;
    restart();
  }

  Status advance(double t_stop, bool one_step) override {
    Status status = Status::ok;
    const long window = std::min(cost_.steps + step_window, max_steps_);
    do {
      if (cost_.steps >= window) status = Status::step_limit;
      if (status == Status::ok) status = step(t_stop);
    } while (status == Status::ok && t_ < t_stop && !one_step);
    outer_ = stepper_.outer(t_, inner_);
    return status;
  }
  void restart() override {
    const double rate = stepper_.rate(inner_);
    next_ = rate > 0.0 ? Stepper::first_step * std::pow(allowed_, exponent) / rate : horizon_;
  }
  double t() const override { return t_; }
  const double* y() const override { return outer_.data(); }
  Cost cost() const override {
    Cost cost = cost_;
    cost.rhs = evaluations(stepper_.sequence()) * (cost.steps + cost.rejected);
    return cost;
  }
  std::string message() const override { return message_; }

 private:
  /// Of a tolerance in a step whose error is of order 15 in it.
  static constexpr double exponent = 1.0 / 15.0;
  static constexpr double safety = 0.9;
  /// Steps are long against the time in which the motion changes, so that one says little about the next:
  /// once one has failed, steps grow slowly.
  static constexpr double growth_limit = 1.1;

  /// What rounding may make of the estimated error: some units in the last place of each count times its
  /// weight; half as much was seen on heavy tops.
  static double rounding(const Sequence& sequence) {
    double sum = 0.0;
    for (double weight : sequence.weight) sum += std::abs(weight);
    return 8.0 * std::numeric_limits<double>::epsilon() * sum;
  }

  /// One step that does not pass t_stop; what is left is divided into equal steps.
  Status step(double t_stop) {
    Extrapolated result;
    for (;;) {
      const double left = t_stop - t_;
      double longest = next_;
      if constexpr (Stepper::most_turn < std::numeric_limits<double>::infinity())
        longest = std::min(longest, Stepper::most_turn * stepper_.sequence().first / stepper_.rate(inner_));
      const double parts = std::max(1.0, std::ceil(left / longest - 1e-9));
      const double H = left / parts;
      if (!(std::abs(H) > 1e-14 * std::abs(t_)) && parts > 1.0) {
        message_ = fmt::format("the step became too small at t = {:.6g} s", t_);
        return Status::solver_failed;
      }
      stepper_.step(inner_, H, result);
      const double estimated = estimate(result), error = estimated / allowed_;
      // Single precision is enough for a step's length.
      const float wanted =
          std::pow(static_cast<float>(std::clamp(error, 1e-30, 1e30)), -static_cast<float>(exponent));
      const double factor = std::clamp(safety * static_cast<double>(wanted), 0.1, growth_);
      next_ = H * (std::isfinite(error) ? factor : 0.1);
      if (error <= 1.0) {
        // Shorter steps do not lessen rounding: without a limit they would shrink to nothing.
        if (estimated <= rounding_) next_ = std::max(next_, H);
        accept(result);
        ++cost_.steps;
        t_ = parts > 1.0 ? t_ + H : t_stop;
        return Status::ok;
      }
      ++cost_.rejected;
      growth_ = growth_limit;
    }
  }

  double estimate(const Extrapolated& result) const {
    const auto square = [&](int c) { return result.defect[c] * result.defect[c]; };
    const double turn = square(0) + square(1) + square(2) + square(3);
    const double momentum = square(4) + square(5) + square(6);
    return std::sqrt(std::max(4.0 * turn, momentum / (scale_ * scale_)));
  }

  void accept(const Extrapolated& result) {
    double square = 0.0;
    for (int c = 0; c < 4; ++c) square += result.value[c] * result.value[c];
    const double inverse = 1.0 / std::sqrt(square);
    for (std::size_t c = 0; c < 7; ++c) inner_[c] = result.value[c] * (c < 4 ? inverse : 1.0);
  }

  Stepper stepper_;
  double scale_, rounding_, allowed_, horizon_ = 0.0;
  long max_steps_;
  double t_ = 0.0, next_ = 0.0, growth_ = 4.0;
  State inner_{}, outer_{};
  Cost cost_;
  std::string message_;
};

}  // namespace

std::unique_ptr<AdaptiveSolver> make_extrapolation(const BodySystem& system, const RunSpec& spec,
                                                   const Kernels& kernels) {
  const Problem& problem = system.problem();
  const int axis = axis_of_top(problem);
  if (axis >= 0)
    return std::make_unique<Extrapolation<StrangTop>>(StrangTop(problem, axis, *spec.tol, kernels), system,
                                                      spec);
  return std::make_unique<Extrapolation<MidpointBody>>(MidpointBody(problem, *spec.tol, kernels), system,
                                                       spec);
}

}  // namespace gnomon::rotation::lanes
