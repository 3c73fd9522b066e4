#pragma once
#include <atomic>
#include <string>
#include <vector>

#include "src/status.hpp"

namespace gnomon {

/// Equilibrium of a structure whose loads and prescribed displacements grow with a factor from 0 to 1:
/// 0 = r(u, factor), the external less the internal forces of all unknowns u. Held unknowns are among them;
/// their forces count as 0.
class StaticSystem {
 public:
  virtual ~StaticSystem() = default;
  virtual int size() const = 0;
  /// What there is instead of a structure that has an equilibrium, for a message; empty if it may have one.
  virtual std::string refusal() const = 0;
  /// Lengths by which unknowns are multiplied in norms, and forces divided: 1 for displacements, for
  /// rotations the size of the structure, m.
  virtual double lever(int unknown) const = 0;
  /// Sets the prescribed unknowns to their values at a factor.
  virtual void prescribe(double factor, double* u) const = 0;
  /// r, and the size of forces that it is to be compared with.
  virtual double residual(double factor, const double* u, double* r) const = 0;
  /// Roundoff of r.
  virtual double roundoff() const = 0;
  /// dr/dfactor, that through the prescribed unknowns included.
  virtual void load(double factor, const double* u, double* out) const = 0;
  /// Factorises -dr/du.
  virtual void factorise(double factor, const double* u) = 0;
  /// Solves with it in place; held unknowns become 0.
  virtual void solve(double* b) const = 0;
  /// The model state at rest in u, flattened.
  virtual std::vector<double> state(const double* u) const = 0;
};

struct StaticsOptions {
  int load_steps = 10;        ///< no step is larger than 1/load_steps of the loads
  bool arc_length = false;    ///< follow the path by its length, past limit points, until the factor is 1
  double newton_tol = 1e-10;  ///< residual relative to the size of forces
  long max_points = 10'000;
  const std::atomic<bool>* stop = nullptr;
};

/// One point of the path of equilibria.
struct Equilibrium {
  double factor = 0.0;
  int iterations = 0;  ///< corrections by Newton's method
  std::vector<double> state;
};

struct StaticPath {
  Status status = Status::ok;
  std::string message;
  std::vector<Equilibrium> points;  ///< from the first step on; the last is at factor 1 where status is ok
};

/// Follows the equilibria from u = 0 to factor 1. By load control with Newton's method from the tangent's
/// prediction: a step that does not converge, or converges far from where the path leads, is halved. Or by
/// the length of the path in u (cylindrical arc-length method: M.A. Crisfield, Comput. Struct. 13 (1981)
/// 55-62, eqs. 15-22), the last step by load control again. Each point gets one correction more than its
/// residual asks for.
StaticPath follow_equilibrium(StaticSystem& system, const StaticsOptions& options = {});

}  // namespace gnomon
