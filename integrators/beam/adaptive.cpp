#include "integrators/beam/adaptive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gnomon::beam {
namespace {

class DoubledSteps final : public AdaptiveSolver {
 public:
  DoubledSteps(const BeamStepsSystem& system, const RunSpec& spec)
      : system_(system),
        steps_(system.steps(spec.scheme)),
        tolerance_(*spec.tol),
        max_steps_(spec.max_steps),
        whole_u_(steps_->u()),
        whole_v_(steps_->v()) {
    steps_->state(y_);
    restart();
  }

  Status advance(double t_stop, bool one_step) override {
    Status status = Status::ok;
    const long window = std::min(cost_.steps + step_window, max_steps_);
    do {
      if (cost_.steps >= window) status = Status::step_limit;
      if (status == Status::ok) status = step(t_stop);
    } while (status == Status::ok && t_ < t_stop && !one_step);
    steps_->state(y_);
    return status;
  }
  void restart() override { next_ = system_.time() * std::cbrt(tolerance_); }
  double t() const override { return t_; }
  const double* y() const override { return y_.data(); }
  Cost cost() const override {
    Cost cost = steps_->cost();
    cost.steps = cost_.steps;
    cost.rejected = cost_.rejected;
    return cost;
  }
  std::string message() const override { return message_; }

 private:
  /// One step that does not pass t_stop; what is left is divided into equal steps.
  Status step(double t_stop) {
    double growth = 4.0;
    steps_->keep();
    for (;;) {
      const double left = t_stop - t_, parts = std::max(1.0, std::ceil(left / next_ - 1e-9));
      const double h = left / parts;
      if (!(h > 1e-13 * std::abs(t_)) && parts > 1.0) {
        message_ = fmt::format("the step became too small at t = {:.6g} s", t_);
        return Status::solver_failed;
      }
      bool done = steps_->step(t_, h) == Status::ok;
      if (done) {
        whole_u_ = steps_->u();
        whole_v_ = steps_->v();
      }
      steps_->back();
      done = done && steps_->step(t_, 0.5 * h) == Status::ok &&
             steps_->step(t_ + 0.5 * h, 0.5 * h) == Status::ok;
      const double error = done ? estimate() / tolerance_ : 0.0;
      if (done && std::isfinite(error)) {
        next_ = h * std::clamp(0.9 / std::cbrt(error), 0.2, growth);
        if (error <= 1.0) {
          ++cost_.steps;
          t_ = parts > 1.0 ? t_ + h : t_stop;
          return Status::ok;
        }
      } else {
        next_ = 0.25 * h;
      }
      steps_->back();
      ++cost_.rejected;
      growth = 1.0;
    }
  }

  double estimate() const {
    const double length = system_.length(), velocity = system_.velocity();
    return std::max(difference(steps_->u(), whole_u_, length, 1.0),
                    difference(steps_->v(), whole_v_, velocity, velocity / length)) /
           3.0;
  }
  /// The larger of the root mean squares over the nodes in the plane and of rotation, by their scales.
  static double difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b, double in_plane,
                           double of_rotation) {
    double places = 0.0, rotations = 0.0;
    const int n = static_cast<int>(a.size());
    for (int i = 0; i < n; i += 3) {
      const double x = a[i] - b[i], z = a[i + 1] - b[i + 1], r = a[i + 2] - b[i + 2];
      places += x * x + z * z;
      rotations += r * r;
    }
    const double nodes = n / 3;
    return std::max(std::sqrt(places / nodes) / in_plane, std::sqrt(rotations / nodes) / of_rotation);
  }

  const BeamStepsSystem& system_;
  std::unique_ptr<BeamSteps> steps_;
  double tolerance_;
  long max_steps_;
  Eigen::VectorXd whole_u_, whole_v_;
  std::vector<double> y_;
  double t_ = 0.0, next_ = 0.0;
  Cost cost_;
  std::string message_;
};

}  // namespace

std::unique_ptr<AdaptiveSolver> make_adaptive(const BeamStepsSystem& system, const RunSpec& spec) {
  return std::make_unique<DoubledSteps>(system, spec);
}

}  // namespace gnomon::beam
