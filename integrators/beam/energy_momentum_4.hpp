#pragma once
#include <cmath>

#include "integrators/beam/midpoint.hpp"

namespace gnomon::beam {

/// Five energy-momentum steps, the middle one back in time. All of them begin and end within the step, so
/// that what jumps at its ends does not matter to them.
struct BeamEnergyMomentum4 : MidpointStep<Turning::cayley> {
  static constexpr SchemeInfo info{
      .name = "beam-energy-momentum-4",
      .family = "beam",
      .summary = "Suzuki's composition of five energy-momentum steps: order 4, energy and momenta exact",
      .citation =
          "M. Suzuki, Phys. Lett. A 146 (1990) 319-323; E. Hairer, C. Lubich, G. Wanner, Geometric "
          "Numerical Integration, II.4, eq. (4.5)",
      .form = "beam",
      .orders = {{{"none", 4}, {"dead", 4}, {"follower", 4}}},
      .reversible = true,
      .conserves_energy = true,
      .conserves_momentum = true,
      .uses = stepper_uses,
  };

  template <BeamForm M>
  static Status step(const M& model, State<M>& state, double t, double h) {
    const double outer = 1.0 / (4.0 - std::cbrt(4.0)), middle = 1.0 - 4.0 * outer;
    const double parts[] = {outer, outer, middle, outer, outer};
    double at = 0.0;
    for (double part : parts) {
      if (const Status status = state.step(model, t + at * h, part * h); status != Status::ok) return status;
      at += part;
    }
    return Status::ok;
  }
};

}  // namespace gnomon::beam
