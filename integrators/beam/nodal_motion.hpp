#pragma once
#include <memory>
#include <vector>

#include "integrators/beam/nodal_beam.hpp"
#include "src/scheme.hpp"

namespace gnomon::beam {

/// One implicit stage for the accelerations a at its end:
///   mass M a + force (damping M v + f(u, t-)) + known = 0,   u = start_u + kappa a,   v = start_v + rate a.
struct Stage {
  double mass, force, kappa, rate;
  double t, h;           ///< the end of the stage; the size of the whole step
  double external_size;  ///< norm of the external force in `known`, for the scale of the residual
};

/// What all schemes on nodal values carry and do: u, v, a and f(u) at the end of the last step, held and
/// prescribed unknowns, jumps of the data, and Newton's iteration. Only the constructor allocates.
///
/// A prescribed motion s(t) gives u = s(t), v = s'(t-) and a = s''(t-) of its unknown: what the formulas of a
/// scheme would give for v and a rings. Where the data jump, velocities jump as in the other beam schemes,
/// and a is set anew from the forces just behind; a step has to begin there.
class NodalMotion {
 public:
  using Vector = Eigen::VectorXd;

  NodalMotion(std::unique_ptr<NodalBeam> beam, Vector displacements, Vector velocities,
              const SchemeOptions& options);

  /// Before a step of size h from t.
  void begin(double t, double h);
  /// F at the limit t- or t+, to `force`; 0 for held unknowns.
  void force_before(double t, double h, Vector& force) const;
  void force_after(double t, double h, Vector& force) const;
  /// Sets the held entries of u, v and a to those at the limit t-.
  void drive(double t, double h, Vector& at_u, Vector& at_v, Vector& at_a) const;
  /// Sets the accelerations to those at u and time t-, the held ones as they are; damping is left out for the
  /// velocities of the free unknowns.
  void accelerate(double t, double h);
  /// Solves for `at_a`, which holds a first guess. Sets the held entries of all vectors. On success `at_u`,
  /// `at_v` and `force` are u, v and f at the end of the stage.
  bool solve(const Stage& stage, Vector& start_u, Vector& start_v, const Vector& known, Vector& at_u,
             Vector& at_v, Vector& at_a, Vector& force);
  /// Norm of forces and, divided by the length of the beam, moments.
  double size_of(const Vector& force) const;
  /// Whether `internal` is that of strains beyond 1e6, which only an unstable scheme reaches.
  bool torn() const;
  Cost cost(long steps) const;

  NodalBeamValue beam;
  Vector u, v, a;
  Vector internal;             ///< f, with 0 for held unknowns
  std::vector<double> lumped;  ///< row sums of M instead of M, for explicit schemes; empty: M
  long evaluations = 0, factorizations = 0, iterations = 0;

 private:
  struct Driven {
    int unknown;
    planar_beam::Motion motion;
  };
  static constexpr double nearby = 1e-6;  ///< steps; times that are nearer to a break are meant to be there

  double snapped(double t, double h) const;
  /// The limit t-, at which functions that are continuous from the right have their value before a jump.
  double before(double t, double h) const;
  void accelerate_by(double t, Vector& force);
  void evaluate_force(double t, const Vector& at_u, Vector& force);
  double residual(const Stage& stage, const Vector& start_v, const Vector& known, const Vector& at_a,
                  const Vector& force);
  /// As in Stepper: whether the next correction with the same tangent is smaller than the last by `factor`.
  bool leads_on(double factor);
  bool newton(const Stage& stage, const Vector& start_u, const Vector& start_v, const Vector& known,
              Vector& at_u, Vector& at_a, Vector& force);
  void clear_held(Vector& values) const;

  std::vector<double> breaks_;  ///< of the data; the first is 0
  std::vector<Driven> driven_;
  Vector residual_, correction_, trial_, next_, guess_, inertia_;
  bool started_ = false;
  double damping_, tolerance_, kept_while_, floor_, element_length_, scale_ = 0.0;
};

}  // namespace gnomon::beam
