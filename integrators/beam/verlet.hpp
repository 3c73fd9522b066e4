#pragma once
#include <memory>
#include <string>

#include "integrators/beam/nodal_scheme.hpp"

namespace gnomon::beam {

enum class Mass { lumped, consistent };

/// The largest step at which the linearised velocity Verlet scheme is stable, 2/omega, s. omega bounds the
/// frequencies of the mesh at u from above: it is the highest frequency of any element by itself (B.M. Irons,
/// Swansea report CR/132/70, 1970).
double stable_step(const NodalBeam& beam, const double* u, Mass mass);

/// Why steps of size h are likely to fail at the motion as it is, for a scheme that is stable up to
/// reach/omega; empty if they are not.
std::string stability_caution(const NodalMotion& motion, Mass mass, double reach, double h);

class VerletMotion {
 public:
  VerletMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
               const SchemeOptions& options, Mass mass);
  Status step(double t, double h);
  std::string caution(double h) const { return stability_caution(nodal, mass_, 2.0, h); }

  NodalMotion nodal;

 private:
  Eigen::VectorXd half_;  ///< v in the middle of the step
  Mass mass_;
};

struct LumpedVerletMotion : VerletMotion {
  LumpedVerletMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
                     const SchemeOptions& options);
};
struct ConsistentVerletMotion : VerletMotion {
  ConsistentVerletMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
                         const SchemeOptions& options);
};

/// A scheme that is stable for small steps only.
template <class Motion>
struct ExplicitScheme : NodalScheme<Motion> {
  template <BeamForm M>
  static std::string caution(const M&, const Motion& state, double h) {
    return state.caution(h);
  }
};

/// Its solution differs from that of the mesh, whose mass is consistent, by what lumping makes: no order is
/// declared.
struct BeamVerlet : ExplicitScheme<LumpedVerletMotion> {
  static constexpr SchemeInfo info{
      .name = "beam-verlet",
      .family = "beam",
      .summary = "explicit velocity Verlet, mass lumped at the nodes; order 2 towards a motion of its own",
      .citation =
          "L. Verlet, Phys. Rev. 159 (1967) 98-103; W.C. Swope et al., J. Chem. Phys. 76 (1982) 637: "
          "the velocity form",
      .form = "beam",
      .stages = 1,
      .reversible = true,
  };
};

struct BeamVerletConsistent : ExplicitScheme<ConsistentVerletMotion> {
  static constexpr SchemeInfo info{
      .name = "beam-verlet-consistent",
      .family = "beam",
      .summary = "explicit velocity Verlet with the consistent mass, solved as a band; momenta exact",
      .citation =
          "L. Verlet, Phys. Rev. 159 (1967) 98-103; W.C. Swope et al., J. Chem. Phys. 76 (1982) 637: "
          "the velocity form",
      .form = "beam",
      .stages = 1,
      .orders = {{{"none", 2}, {"dead", 2}, {"follower", 2}}},
      .reversible = true,
      .conserves_momentum = true,
  };
};

}  // namespace gnomon::beam
