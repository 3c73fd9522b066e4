#pragma once
#include <memory>

#include "integrators/beam/nodal_motion.hpp"

namespace gnomon::beam {

/// Of implicit schemes on nodal values; they have one way to solve linear systems.
inline constexpr OptionUse nodal_uses{.newton_tol = true, .modified_newton = true};

/// A scheme on nodal values, the same for elements of all orders. `Motion` is made of a NodalBeam, u, v and
/// SchemeOptions; it has a NodalMotion `nodal` and `step(t, h)`.
template <class Motion>
struct NodalScheme {
  template <BeamForm M>
  using State = Motion;

  template <BeamForm M>
  static Motion start(const M& model, const typename M::State& state, const SchemeOptions& options = {}) {
    return Motion(std::make_unique<NodalBeamOf<M>>(model), state.u, state.v, options);
  }
  template <BeamForm M>
  static Status step(const M&, Motion& state, double t, double h) {
    return state.step(t, h);
  }
  template <BeamForm M>
  static typename M::State view(const M& model, const Motion& state) {
    return {state.nodal.u, state.nodal.v, model.strains(state.nodal.u.data())};
  }
  template <BeamForm M>
  static Cost cost(const M&, const Motion& state, long steps) {
    return state.nodal.cost(steps);
  }
};

}  // namespace gnomon::beam
