#pragma once
#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <vector>

#include "integrators/beam/point_step.hpp"
#include "models/planar_beam/assembled_chain.hpp"
#include "models/planar_beam/element_chain.hpp"
#include "models/planar_beam/statics.hpp"
#include "src/scheme.hpp"
#include "src/status.hpp"

namespace gnomon::beam {

using planar_beam::ElementChain;

/// What a model offers to be run by these schemes: equal elements in a chain, points, loads, supports.
template <class M>
concept BeamForm = requires(const M& model, double t, double* out) {
  M::order;
  model.element();
  { model.section() } -> std::convertible_to<planar_beam::CrossSection>;
  { model.elements() } -> std::convertible_to<int>;
  { model.point(0) } -> std::convertible_to<planar_beam::PointReference>;
  model.held();
  { model.prescribed(0) } -> std::convertible_to<const planar_beam::Motion*>;
  model.jump(t, out);
  model.external_force(t, out);
  model.following(t, 0, t);
  model.spring(0);
  model.damping();
};

/// The state of the scheme and the work space of its Newton iteration on the mean velocity vbar of a step. A
/// step in parts, each of which is to be tested by itself: `begin`, `evaluate`, `linearise`, `correct`,
/// `finish`. Only `start` allocates.
template <BeamForm M, Turning turning>
class Stepper {
 public:
  /// An unknown whose motion is prescribed.
  struct Driven {
    int unknown;
    planar_beam::Motion motion;
  };

  static constexpr int p = M::order;
  using Vector = Eigen::VectorXd;
  using Point = PointStep<turning>;

  Stepper(const M& model, const typename M::State& state, const SchemeOptions& options)
      : u(state.u),
        v(state.v),
        mean(state.v),
        history(model.point_count()),
        chain_(model.elements(), model.held()),
        points_(model.point_count()),
        tolerance_(options.newton_tol),
        kept_while_(options.modified_newton ? 0.2 : 1e-2) {
    const int n = model.unknowns();
    for (Vector* vector : {&external_, &internal_, &inertia_, &residual_, &correction_, &trial_})
      vector->setZero(n);
    for (Vector& one : past) one.setZero(n);
    for (int e = 0; e < model.elements(); ++e)
      for (int g = 0; g < p; ++g) {
        const planar_beam::PointStrain at = model.strain_at(u.data(), e, g);
        // d = R^T (e - e0) of a point is its slopes and d0.
        history[e * p + g] = {
            at.c * at.g1 + at.s * at.g2, at.c * at.g2 - at.s * at.g1, at.c, at.s, at.g1, at.g2, at.bending};
      }
    if (options.linear_solver != LinearSolver::block)
      assembled_.emplace(options.linear_solver, p, model.elements(), model.held());
    for (int i : model.held())
      if (const planar_beam::Motion* motion = model.prescribed(i)) driven_.push_back({i, *motion});
    length_ = model.data().length;
    const planar_beam::CrossSection& C = model.section();
    force_floor_ = 4.0 * std::numeric_limits<double>::epsilon() * std::max(C.EA, C.GA) *
                   std::sqrt(static_cast<double>(model.nodes()));
    const double density = std::max(C.rhoA, C.rhoI / length_);
    mass_floor_ = 4.0 * std::numeric_limits<double>::epsilon() * density * model.element().length;
  }

  typename M::State view(const M& model) const { return state_of(model, u, v, history); }
  static typename M::State state_of(const M& model, const Vector& u, const Vector& v,
                                    const std::vector<PointHistory>& history) {
    typename M::State state{u, v, Vector(3 * model.point_count())};
    for (int k = 0; k < model.point_count(); ++k) {
      const PointHistory& at = history[k];
      state.strain.template segment<3>(3 * k) << at.g1 + model.point(k).e1, at.g2 + model.point(k).e2,
          at.bending;
    }
    return state;
  }
  Cost cost(long steps) const {
    return {.steps = steps,
            .rhs = evaluations,
            .jacobians = factorizations,
            .factorizations = factorizations,
            .newton_iterations = iterations};
  }

  // A step is long enough to be called; inlined into the loops of all orders it takes minutes to compile.
  [[gnu::noinline]] Status step(const M& model, double t, double h) {
    aim(model, t, h);
    if (!driven_.empty()) model.jump(time_, v.data());
    inertia_floor_ = mass_floor_ * std::abs(2.0 / h) * v.norm();
    extrapolate(h);
    if (!solve(model, h)) {
      mean = v;
      if (!solve(model, h) && !continue_in_step(model, h)) return Status::newton_failed;
    }
    finish(h);
    return Status::ok;
  }

  /// The first part of a step: loads at its middle and, exactly, the time at which it begins.
  void aim(const M& model, double t, double h) {
    load(model, t + 0.5 * h);
    time_ = t;
    for (const Driven& end : driven_) time_ = end.motion.snapped(time_, nearby * h);
  }
  /// Whether a prescribed rate jumps at the beginning of the step that `aim` has been told.
  bool jumps() const {
    for (const Driven& end : driven_)
      if (end.motion.rate_after(time_) != end.motion.rate_before(time_)) return true;
    return false;
  }
  /// Sets the mean velocities of driven ends, so that they are at the end of the step where they are
  /// prescribed to be, and the velocity that the inertia term sees before the step, so that the acceleration
  /// is (s'(t_{n+1}-) - s'(t_n+))/h.
  void drive(double h) {
    for (const Driven& end : driven_) {
      const double t = end.motion.snapped(time_ + h, nearby * h);
      const double turn = end.motion.value(t) - end.motion.value(time_);
      const bool bent = turning == Turning::cayley && end.unknown % 3 == 2;
      const double rate = bent ? 2.0 / h * std::tan(0.5 * turn) : turn / h;
      mean[end.unknown] = rate;
      v[end.unknown] = rate - 0.5 * (end.motion.rate_before(t) - end.motion.rate_after(time_));
    }
  }
  /// Sets the displacements and velocities of driven ends at the end of the step.
  void settle(double h) {
    for (const Driven& end : driven_) {
      const double t = end.motion.snapped(time_ + h, nearby * h);
      u[end.unknown] = end.motion.value(t);
      v[end.unknown] = end.motion.rate_before(t);
    }
  }

  /// Residual of the weak form at the present `mean`, from the state at t_n, for a step of size h; the
  /// external force is that of `load`. Returns its norm; forces and, divided by the length of the beam,
  /// moments.
  [[gnu::noinline]] double evaluate(const M& model, double h) {
    const auto& element = model.element();
    const planar_beam::CrossSection section = model.section();
    const double rate = 2.0 / h;
    internal_.setZero();
    inertia_.setZero();
    for (int e = 0; e < model.elements(); ++e) {
      const double* vbar = mean.data() + 3 * p * e;
      const double* before = v.data() + 3 * p * e;
      double* force = internal_.data() + 3 * p * e;
      double* inertia = inertia_.data() + 3 * p * e;
      for (int g = 0; g < p; ++g) {
        double w1 = 0, w2 = 0, w3 = 0, omega = 0;
        for (int a = 0; a <= p; ++a) {
          w1 += element.slope[g][a] * vbar[3 * a];
          w2 += element.slope[g][a] * vbar[3 * a + 1];
          w3 += element.slope[g][a] * vbar[3 * a + 2];
          omega += element.shape[g][a] * vbar[3 * a + 2];
        }
        const planar_beam::PointReference& r = model.point(e * p + g);
        points_[e * p + g] = Point(history[e * p + g], r.e1, r.e2, section, h, w1, w2, w3, omega);
        element.add_force(g, points_[e * p + g].force(section), force);
      }
      for (int a = 0; a <= p; ++a)
        for (int b = 0; b <= p; ++b) {
          const double m = rate * element.mass[a][b];
          inertia[3 * a] += m * section.rhoA * (vbar[3 * b] - before[3 * b]);
          inertia[3 * a + 1] += m * section.rhoA * (vbar[3 * b + 1] - before[3 * b + 1]);
          inertia[3 * a + 2] += m * section.rhoI * (vbar[3 * b + 2] - before[3 * b + 2]);
        }
    }
    if (model.has_springs() || model.has_followers()) add_ends(model, h);
    if (model.damping() != 0.0) {
      model.momentum(mean.data(), residual_.data());
      inertia_ += model.damping() * residual_;
    }
    for (int i : model.held()) internal_[i] = inertia_[i] = external_[i] = 0.0;
    ++evaluations;
    return take_residual();
  }

  /// The consistent tangent at the mean velocity that was evaluated last, with the inertia term
  /// (2/h) int rho_A P_i P_j dx; factorised.
  [[gnu::noinline]] void linearise(const M& model, double h) {
    for (int e = 0; e < model.elements(); ++e) {
      if (assembled_)
        assembled_->add(e, element_tangent(model, e, h).data());
      else
        chain_.add(e, element_tangent(model, e, h));
    }
    if (assembled_)
      assembled_->factorise();
    else
      chain_.factorise();
    ++factorizations;
  }
  typename ElementChain<p>::Matrix element_tangent(const M& model, int e, double h) const {
    const auto& element = model.element();
    typename ElementChain<p>::Matrix matrix = ElementChain<p>::Matrix::Zero();
    for (int g = 0; g < p; ++g)
      element.add_tangent(g, points_[e * p + g].force_tangent(model.section(), h), matrix);
    if (model.has_springs() || model.has_followers())
      model.for_ends_of(e, [&](int end, int i) {
        const EndTurn turn(u[model.end_unknown(end) + 2], mean[model.end_unknown(end) + 2], h);
        const auto load = model.following(middle_, end, turn.phi);
        matrix(i, i + 2) -= turn.rate * load.slope[0];
        matrix(i + 1, i + 2) -= turn.rate * load.slope[1];
        matrix(i + 2, i + 2) += model.spring(end) * turn.moment_slope;
      });
    const planar_beam::CrossSection& section = model.section();
    for (int a = 0; a <= p; ++a)
      for (int b = 0; b <= p; ++b) {
        const double m = (2.0 / h + model.damping()) * element.mass[a][b];
        matrix(3 * a, 3 * b) += m * section.rhoA;
        matrix(3 * a + 1, 3 * b + 1) += m * section.rhoA;
        matrix(3 * a + 2, 3 * b + 2) += m * section.rhoI;
      }
    return matrix;
  }
  /// Solves for the correction of `mean` with the tangent that was factorised last.
  [[gnu::noinline]] const Vector& correct() {
    correction_ = -residual_;
    if (assembled_)
      assembled_->solve(correction_.data());
    else
      chain_.solve(correction_.data());
    ++iterations;
    return correction_;
  }

  /// Takes the step over, at the mean velocity that was evaluated last.
  void finish(double h) {
    const int n = static_cast<int>(u.size());
    for (int i = 0; i < n; i += 3) {
      u[i] += h * mean[i];
      u[i + 1] += h * mean[i + 1];
      u[i + 2] += turning == Turning::cayley ? 2.0 * std::atan(0.5 * h * mean[i + 2]) : h * mean[i + 2];
    }
    v = 2.0 * mean - v;
    settle(h);
    for (std::size_t k = 0; k < points_.size(); ++k) history[k] = points_[k].end();
    past[2].swap(past[1]);
    past[1].swap(past[0]);
    past[0] = mean;
    known = h == past_step ? std::min(known + 1, 3) : 1;
    past_step = h;
  }

  const Vector& residual() const { return residual_; }
  const Vector& external() const { return external_; }
  double tolerance() const { return tolerance_; }
  const std::vector<Driven>& driven() const { return driven_; }
  /// Roundoff of the residual: of the forces, and of the inertia over |2/h| |v|.
  double force_floor() const { return force_floor_; }
  double mass_floor() const { return mass_floor_; }
  /// Sets the external force to that at time t, the middle of a step.
  void load(const M& model, double t) {
    model.external_force(t, external_.data());
    middle_ = t;
  }

  Vector u, v;
  Vector mean;  ///< vbar = (v_{n+1} + v_n)/2, the unknown
  std::vector<PointHistory> history;
  Vector past[3];          ///< mean velocities of the last steps, the last one first
  int known = 0;           ///< how many of them are known
  double past_step = 0.0;  ///< the size of those steps, s
  long evaluations = 0, factorizations = 0, iterations = 0;

 private:
  static constexpr double nearby = 1e-6;  ///< steps; times that are nearer to a break are meant to be there

  /// The section of an end in the middle of a step with mean angular velocity `omega`: its rotation, the
  /// derivative of that by omega, and the moment of a unit spring with its derivative. By the Cayley map that
  /// moment is the mean rotation times atan(z)/z, z = (h/2) omega, so that its work, with h omega, is the
  /// change of the spring's energy.
  struct EndTurn {
    double phi, rate, moment, moment_slope;
    EndTurn(double before, double omega, double h) {
      const double half = 0.5 * h, z = half * omega;
      phi = before + z;
      rate = half;
      double factor = 1.0, slope = 0.0;
      if constexpr (turning == Turning::cayley) {
        phi = before + std::atan(z);
        rate = half / (1.0 + z * z);
        const bool small = std::abs(z) < 1e-3;
        factor = small ? 1.0 - z * z * (1.0 / 3.0 - z * z / 5.0) : std::atan(z) / z;
        slope = small ? -2.0 / 3.0 * z * half : half * (1.0 / (1.0 + z * z) - factor) / z;
      }
      moment = factor * phi;
      moment_slope = factor * rate + slope * phi;
    }
  };
  /// Adds the springs' moments at the ends to the internal forces and takes the followers' forces off them.
  void add_ends(const M& model, double h) {
    for (int end = 0; end < 2; ++end) {
      const int i = model.end_unknown(end);
      const EndTurn turn(u[i + 2], mean[i + 2], h);
      const auto load = model.following(middle_, end, turn.phi);
      internal_[i] -= load.force[0];
      internal_[i + 1] -= load.force[1];
      internal_[i + 2] += model.spring(end) * turn.moment;
    }
  }

  /// Sets the residual and the scale by which it is measured, the largest norm of its three parts; returns
  /// its norm.
  double take_residual() {
    const double arm = 1.0 / (length_ * length_);
    double inertia = 0.0, internal = 0.0, external = 0.0, total = 0.0;
    const int n = static_cast<int>(residual_.size());
    for (int i = 0; i < n; i += 3)
      for (int k = 0; k < 3; ++k) {
        const double weight = k == 2 ? arm : 1.0;
        const double x = inertia_[i + k], y = internal_[i + k], z = external_[i + k], r = x + y - z;
        residual_[i + k] = r;
        inertia += weight * x * x;
        internal += weight * y * y;
        external += weight * z * z;
        total += weight * r * r;
      }
    scale_ = std::sqrt(std::max({inertia, internal, external}));
    return std::sqrt(total);
  }
  double floor() const { return force_floor_ + inertia_floor_; }
  double threshold() const { return std::max(tolerance_ * scale_, floor()); }

  /// A start for Newton's iteration from the mean velocities of the last steps, which unlike v carry no
  /// oscillation of period 2 h; where stiff modes do oscillate, from the last one alone, which amplifies
  /// nothing.
  void extrapolate(double h) {
    const int usable = h == past_step ? known : 0;
    if (usable == 3)
      mean = 3.0 * (past[0] - past[1]) + past[2];
    else if (usable == 2)
      mean = 2.0 * past[0] - past[1];
    else
      mean = v;
    // Where the last one has been the better start lately, the other is tried only now and then.
    if (usable >= 2 && plain_ > 0) {
      --plain_;
      mean = past[0];
    }
    extrapolated_ = usable >= 2 && plain_ == 0;
  }

  /// Newton's iteration with line search. The tangent is kept while it reduces the residual by a hundred, in
  /// the modified iteration by five.
  [[gnu::noinline]] bool solve(const M& model, double h) {
    drive(h);
    double size = evaluate(model, h);
    if (extrapolated_ && !(size <= 1e-2 * scale_)) {
      trial_ = mean;
      mean = past[0];
      drive(h);
      const double plain = evaluate(model, h);
      if (size < plain) {
        mean = trial_;
        size = evaluate(model, h);
      } else {
        size = plain;
        plain_ = 16;
      }
    }
    extrapolated_ = false;
    bool fresh = false, keep = false;
    for (int k = 0; k < 40; ++k) {
      if (!std::isfinite(size)) return false;
      if (size <= floor() || (k > 0 && size <= threshold())) return polish(model, h, size);
      if (!keep) {
        linearise(model, h);
        fresh = true;
      }
      const double before = size;
      trial_ = mean;
      correct();
      double length = 1.0;
      for (;; length *= 0.5) {
        mean = trial_ + length * correction_;
        size = evaluate(model, h);
        if (size <= (1.0 - 1e-4 * length) * before || size <= floor()) break;
        if (length < 1e-3) return false;
        if (!fresh) break;
      }
      if (size > before && !fresh) {  // the old tangent does not serve any more
        mean = trial_;
        size = evaluate(model, h);
        keep = false;
        continue;
      }
      keep = length == 1.0 && size <= kept_while_ * before;
      fresh = false;
    }
    return false;
  }

  /// One more correction by the tangent at hand, unless the residual is far below what is asked or at
  /// roundoff: what is left of it is lost from the invariants in each step.
  bool polish(const M& model, double h, double size) {
    if (size <= std::max(1e-2 * tolerance_ * scale_, floor())) return true;
    trial_ = mean;
    correct();
    mean += correction_;
    if (evaluate(model, h) <= size) return true;
    mean = trial_;
    evaluate(model, h);
    return true;
  }

  /// Large steps: the equations of a smaller step from the same state, whose solutions lead to that of h. The
  /// state advances by h at once or not at all.
  bool continue_in_step(const M& model, double h) {
    mean = v;
    Vector& good = past[2];  // overwritten after the step anyway
    known = std::min(known, 2);
    double done = 0.0, part = 0.25;
    for (int tries = 0; tries < 60 && done < 1.0; ++tries) {
      good = mean;
      const double next = std::min(1.0, done + part);
      if (solve(model, next * h)) {
        done = next;
        part *= 1.5;
      } else {
        mean = good;
        part *= 0.5;
        if (part < 1e-3) return false;
      }
    }
    return done >= 1.0;
  }

  ElementChain<p> chain_;
  std::optional<planar_beam::AssembledChain> assembled_;  ///< where another solver is asked for
  std::vector<Point> points_;
  std::vector<Driven> driven_;
  Vector external_, internal_, inertia_, residual_, correction_, trial_;
  double time_ = 0.0, middle_ = 0.0;
  bool extrapolated_ = false;
  int plain_ = 0;  ///< steps for which Newton starts from the last mean velocity
  double tolerance_, kept_while_, scale_ = 0.0, length_ = 1.0;
  double force_floor_ = 0.0, mass_floor_ = 0.0, inertia_floor_ = 0.0;
};

}  // namespace gnomon::beam
