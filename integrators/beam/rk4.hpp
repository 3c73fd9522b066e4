#pragma once
#include <memory>
#include <string>

#include "integrators/beam/verlet.hpp"

namespace gnomon::beam {

/// u' = v, v' = M^-1 (F(t) - f(u, t)) - damping v with the consistent mass; what supports prescribe has its
/// values at the times of the stages.
class Rk4Motion {
 public:
  Rk4Motion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
            const SchemeOptions& options);
  Status step(double t, double h);
  /// Stable up to |h omega| = 2 sqrt(2) on the imaginary axis.
  std::string caution(double h) const;

  NodalMotion nodal;

 private:
  /// The rates at t + part h and start + part h (slope of u, slope of v), which are v and a of `nodal`.
  void stage(double t, double h, double part);

  Eigen::VectorXd start_u_, start_v_, sum_u_, sum_v_;
};

struct BeamRk4 : ExplicitScheme<Rk4Motion> {
  static constexpr SchemeInfo info{
      .name = "beam-rk4",
      .family = "beam",
      .summary = "the classical explicit Runge-Kutta method of order 4, consistent mass solved as a band",
      .citation =
          "W. Kutta, Z. Math. Phys. 46 (1901) 435-453; E. Hairer, S.P. Norsett, G. Wanner, Solving Ordinary "
          "Differential Equations I, II.1, table 1.2",
      .form = "beam",
      .stages = 4,
      .orders = {{{"none", 4}, {"dead", 4}, {"follower", 4}}},
  };
};

}  // namespace gnomon::beam
