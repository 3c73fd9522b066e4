#pragma once
#include <memory>

#include "integrators/beam/nodal_scheme.hpp"

namespace gnomon::beam {

/// Parameters of the generalised alpha method:
///   M ((1 - alpha_m) a_{n+1} + alpha_m a_n) + (1 - alpha_f)(f - F)_{n+1} + alpha_f (f - F)_n = 0
/// with Newmark's formulas, beta and gamma. Internal forces are averaged, not taken at averaged
/// displacements.
struct AlphaParameters {
  double alpha_m, alpha_f, beta, gamma;
};
/// Newmark's average acceleration: the trapezoidal rule.
AlphaParameters trapezoidal_parameters();
/// Eqs (17), (20) and (25) of Chung and Hulbert for a spectral radius at infinity in [0, 1].
AlphaParameters chung_hulbert_parameters(double spectral_radius);
/// alpha_m = 0, for a spectral radius in [1/2, 1].
AlphaParameters hht_parameters(double spectral_radius);

class GeneralizedAlphaMotion {
 public:
  GeneralizedAlphaMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
                         const SchemeOptions& options, const AlphaParameters& parameters);
  Status step(double t, double h);

  NodalMotion nodal;

 private:
  AlphaParameters parameters_;
  Eigen::VectorXd start_u_, start_v_, known_, external_, force_, next_u_, next_v_, next_a_;
};

struct TrapezoidalMotion : GeneralizedAlphaMotion {
  TrapezoidalMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
                    const SchemeOptions& options);
};
struct ChungHulbertMotion : GeneralizedAlphaMotion {
  ChungHulbertMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
                     const SchemeOptions& options);
};
struct HhtMotion : GeneralizedAlphaMotion {
  HhtMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
            const SchemeOptions& options);
};

struct BeamTrapezoidal : NodalScheme<TrapezoidalMotion> {
  static constexpr SchemeInfo info{
      .name = "beam-trapezoidal",
      .family = "beam",
      .summary = "Newmark's average acceleration, beta = 1/4 and gamma = 1/2: the trapezoidal rule",
      .citation = "N.M. Newmark, J. Eng. Mech. Div. ASCE 85 (1959) 67-94",
      .form = "beam",
      .orders = {{{"none", 2}, {"dead", 2}, {"follower", 2}}},
      .reversible = true,
      .uses = nodal_uses,
  };
};

struct BeamGeneralizedAlpha : NodalScheme<ChungHulbertMotion> {
  static constexpr SchemeInfo info{
      .name = "beam-generalized-alpha",
      .family = "beam",
      .summary = "generalised alpha method, spectral radius 0.8 at infinity or by --spectral-radius",
      .citation = "J. Chung, G.M. Hulbert, J. Appl. Mech. 60 (1993) 371-375, eqs (17), (20), (25)",
      .form = "beam",
      .orders = {{{"none", 2}, {"dead", 2}, {"follower", 2}}},
      .spectral_radii = {{0.0, 1.0}},
      .uses = nodal_uses,
  };
};

struct BeamHht : NodalScheme<HhtMotion> {
  static constexpr SchemeInfo info{
      .name = "beam-hht",
      .family = "beam",
      .summary = "HHT alpha method, spectral radius 0.8 at infinity or by --spectral-radius (0.5 to 1)",
      .citation = "H.M. Hilber, T.J.R. Hughes, R.L. Taylor, Earthq. Eng. Struct. Dyn. 5 (1977) 283-292",
      .form = "beam",
      .orders = {{{"none", 2}, {"dead", 2}, {"follower", 2}}},
      .spectral_radii = {{0.5, 1.0}},
      .uses = nodal_uses,
  };
};

}  // namespace gnomon::beam
