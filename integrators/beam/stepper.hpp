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
#include "models/planar_beam/planar_beam.hpp"
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
  model.numbering();
  model.damping();
};

/// The state of the scheme and the work space of its Newton iteration on the mean velocity vbar of a step. A
/// step in parts, each of which is to be tested by itself: `begin`, `evaluate`, `linearise`, `correct`,
/// `finish`. Only `start` allocates. Defined in stepper_steps.hpp and compiled once, in stepper.cpp.
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
  using ElementMatrix = typename ElementChain<M::order>::Matrix;

  Stepper(const M& model, const typename M::State& state, const SchemeOptions& options)
      : u(state.u),
        v(state.v),
        mean(state.v),
        history(model.point_count()),
        chain_(model.elements(), model.held(), model.numbering().hinged()),
        points_(model.point_count()),
        tolerance_(options.newton_tol),
        kept_while_(options.modified_newton ? 0.2 : 1e-2) {
    const int n = model.unknowns();
    for (Vector* vector : {&external_, &internal_, &inertia_, &residual_, &correction_, &trial_, &next_})
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
      assembled_.emplace(options.linear_solver, p, model.elements(), model.held(),
                         model.numbering().hinged());
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
  Status step(const M& model, double t, double h);

  /// The first part of a step: loads at its middle and, exactly, the time at which it begins.
  void aim(const M& model, double t, double h);
  /// Whether a prescribed rate jumps at the beginning of the step that `aim` has been told.
  bool jumps() const {
    for (const Driven& end : driven_)
      if (end.motion.rate_after(time_) != end.motion.rate_before(time_)) return true;
    return false;
  }
  /// Sets the mean velocities of driven ends, so that they are at the end of the step where they are
  /// prescribed to be, and the velocity that the inertia term sees before the step, so that the acceleration
  /// is (s'(t_{n+1}-) - s'(t_n+))/h.
  void drive(double h);
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
  double evaluate(const M& model, double h);

  /// The consistent tangent at the mean velocity that was evaluated last, with the inertia term
  /// (2/h) int rho_A P_i P_j dx; factorised.
  void linearise(const M& model, double h);
  ElementMatrix element_tangent(const M& model, int e, double h) const;
  /// Solves for the correction of `mean` with the tangent that was factorised last.
  const Vector& correct();

  /// Takes the step over, at the mean velocity that was evaluated last.
  void finish(double h);

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
  /// The moments of the springs at hinges: adds them to the internal forces, or their derivatives to the
  /// tangent.
  void add_hinges(const M& model, double h);
  void linearise_hinges(const M& model, double h);
  /// Adds the springs' moments at the ends to the internal forces and takes the followers' forces off them.
  void add_ends(const M& model, double h);

  /// Sets the residual and the scale by which it is measured, the largest norm of its three parts; returns
  /// its norm.
  double take_residual();
  double floor() const { return force_floor_ + inertia_floor_; }
  double threshold() const { return std::max(tolerance_ * scale_, floor()); }

  /// A start for Newton's iteration from the mean velocities of the last steps, which unlike v carry no
  /// oscillation of period 2 h; where stiff modes do oscillate, from the last one alone, which amplifies
  /// nothing.
  void extrapolate(double h);

  /// Newton's iteration with line search: a step is taken if it makes the residual or the correction that
  /// would follow with the same tangent smaller (P. Deuflhard, Newton Methods for Nonlinear Problems, 2004,
  /// natural monotonicity test of chapter 3). In stiff beams the stretch of second order that bending gives
  /// makes the residual larger on the way to the solution. The tangent is kept while it reduces the residual
  /// by a hundred, in the modified iteration by five. At least one correction is made: loads below the
  /// roundoff of the stiff directions move the soft ones.
  bool solve(const M& model, double h);
  /// Whether the correction that the residual at hand asks for, with the tangent that was factorised last, is
  /// smaller than the last one by `factor`.
  bool leads_on(double factor);

  /// One more correction by the tangent at hand, unless the residual is far below what is asked or at
  /// roundoff: what is left of it is lost from the invariants in each step.
  bool polish(const M& model, double h, double size);

  /// Large steps: the equations of a smaller step from the same state, whose solutions lead to that of h. The
  /// state advances by h at once or not at all.
  bool continue_in_step(const M& model, double h);

  ElementChain<p> chain_;
  std::optional<planar_beam::AssembledChain> assembled_;  ///< where another solver is asked for
  std::vector<Point> points_;
  std::vector<Driven> driven_;
  Vector external_, internal_, inertia_, residual_, correction_, trial_, next_;
  double time_ = 0.0, middle_ = 0.0;
  bool extrapolated_ = false;
  int plain_ = 0;  ///< steps for which Newton starts from the last mean velocity
  double tolerance_, kept_while_, scale_ = 0.0, length_ = 1.0;
  double force_floor_ = 0.0, mass_floor_ = 0.0, inertia_floor_ = 0.0;
};

extern template class Stepper<planar_beam::PlanarBeam<1>, Turning::documented>;
extern template class Stepper<planar_beam::PlanarBeam<2>, Turning::documented>;
extern template class Stepper<planar_beam::PlanarBeam<3>, Turning::documented>;
extern template class Stepper<planar_beam::PlanarBeam<4>, Turning::documented>;
extern template class Stepper<planar_beam::PlanarBeam<1>, Turning::cayley>;
extern template class Stepper<planar_beam::PlanarBeam<2>, Turning::cayley>;
extern template class Stepper<planar_beam::PlanarBeam<3>, Turning::cayley>;
extern template class Stepper<planar_beam::PlanarBeam<4>, Turning::cayley>;

}  // namespace gnomon::beam
