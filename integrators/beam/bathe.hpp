#pragma once
#include <memory>

#include "integrators/beam/nodal_scheme.hpp"

namespace gnomon::beam {

/// The trapezoidal rule to t + (2 - sqrt 2) h, then the backward difference formula of order 2 on the three
/// times; with this split both parts have the same tangent.
class BatheMotion {
 public:
  BatheMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
              const SchemeOptions& options);
  Status step(double t, double h);

  NodalMotion nodal;

 private:
  /// The stage that ends at t, u and v as they are in start_u_ and start_v_ plus rate^2 a and rate a.
  bool solve(double t, double h, double rate);

  Eigen::VectorXd start_u_, start_v_, known_, force_, next_u_, next_v_, next_a_;
};

struct BeamBathe : NodalScheme<BatheMotion> {
  static constexpr SchemeInfo info{
      .name = "beam-bathe",
      .family = "beam",
      .summary = "composite of the trapezoidal rule and BDF2, split at (2 - sqrt 2) h; damps what is fast",
      .citation =
          "R.E. Bank et al., IEEE Trans. Electron Devices 32 (1985) 1992-2007 (TR-BDF2); K.J. Bathe, "
          "Computers & Structures 85 (2007) 437-445, there split at h/2",
      .form = "beam",
      .orders = {{{"none", 2}, {"dead", 2}, {"follower", 2}}},
      .uses = nodal_uses,
  };
};

}  // namespace gnomon::beam
