#pragma once
#include <type_traits>

#include "integrators/beam/linear/stepper.hpp"
#include "integrators/beam/stepper.hpp"
#include "src/scheme.hpp"

namespace gnomon::beam {

/// The implicit midpoint rule for the geometrically exact beam with the mean velocity of the step as unknown.
template <Turning turning>
struct MidpointStep {
  static constexpr Turning kind = turning;
  template <BeamForm M>
  using State =
      std::conditional_t<M::order == 1 && (turning == Turning::documented || turning == Turning::cayley),
                         linear::FastStepper<M, turning>, Stepper<M, turning>>;

  /// `options.newton_tol`: residual relative to the largest of inertia, internal and external force.
  template <BeamForm M>
  static State<M> start(const M& model, const typename M::State& state, const SchemeOptions& options = {}) {
    return State<M>(model, state, options);
  }
  template <BeamForm M>
  static Status step(const M& model, State<M>& state, double t, double h) {
    return state.step(model, t, h);
  }
  template <BeamForm M>
  static typename M::State view(const M& model, const State<M>& state) {
    return state.view(model);
  }
  template <BeamForm M>
  static Cost cost(const M&, const State<M>& state, long steps) {
    return state.cost(steps);
  }
};

/// Of all schemes on Stepper.
inline constexpr OptionUse stepper_uses{.newton_tol = true, .modified_newton = true, .linear_solver = true};

inline constexpr std::string_view midpoint_citation =
    "the planar beam of the velocity-based formulation of E. and D. Zupan, Nonlinear Dynamics 95 (2019) "
    "1379-1394; working note, sections on the numerical computation and the linearisation";

struct BeamMidpoint : MidpointStep<Turning::documented> {
  static constexpr SchemeInfo info{
      .name = "beam-midpoint",
      .family = "beam",
      .summary = "the documented implicit midpoint scheme on the mean velocity; momenta exact, energy not",
      .citation = midpoint_citation,
      .form = "beam",
      .orders = {{{"none", 2}, {"dead", 2}, {"follower", 2}}},
      .reversible = true,
      .conserves_momentum = true,
      .uses = stepper_uses,
  };
};

struct BeamEnergyMomentum : MidpointStep<Turning::cayley> {
  static constexpr SchemeInfo info{
      .name = "beam-energy-momentum",
      .family = "beam",
      .summary =
          "the same with rotations by the Cayley map and internal forces scaled to match: energy exact",
      .citation = midpoint_citation,
      .form = "beam",
      .orders = {{{"none", 2}, {"dead", 2}, {"follower", 2}}},
      .reversible = true,
      .conserves_energy = true,
      .conserves_momentum = true,
      .uses = stepper_uses,
  };
};

}  // namespace gnomon::beam
