#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "models/planar_beam/data.hpp"

namespace gnomon::planar_beam {

/// Typical sizes of the motion, by which drifts and tolerances are measured.
struct Scales {
  double energy, momentum, angular_momentum, velocity, time;
};

/// From the energy at the start and what the loads bring: a free beam is moved by their impulses like a
/// rigid body, a held one is bent like a cantilever, at most to the length of the beam or one radian.
/// `inertia` is about the centre of mass [kg m^2], `last` the
/// place of the beam's end [m].
inline Scales estimate_scales(const Data& data, const std::array<double, 2>& centre,
                              const std::array<double, 2>& last, double inertia, double initial) {
  const CrossSection& s = data.section;
  const double L = data.length, mass = s.rhoA * L;
  const bool held = data.supports[0].place || data.supports[1].place;
  double energy = initial;
  const double weight = mass * std::abs(data.gravity);
  double impulse[3] = {0, 0, 0};
  for (const Load& load : data.loads) {
    const double size = load.at == Place::distributed ? L : 1.0;
    const double force = size * std::hypot(load.force[0], load.force[1]),
                 moment = size * std::abs(load.moment);
    if (held) {
      energy += force * std::min(L, force * L * L * L / (3.0 * s.EI) + force * L / s.GA + force * L / s.EA) +
                moment * std::min(1.0, moment * L / s.EI);
      continue;
    }
    const double time = size * load.impulse(data.horizon);
    double at[2] = {centre[0], centre[1]};
    if (load.at == Place::start) at[0] = data.start[0], at[1] = data.start[1];
    if (load.at == Place::end) at[0] = last[0], at[1] = last[1];
    impulse[0] += time * load.force[0];
    impulse[1] += time * load.force[1];
    impulse[2] +=
        time * (load.moment + (at[1] - centre[1]) * load.force[0] - (at[0] - centre[0]) * load.force[1]);
  }
  energy += (impulse[0] * impulse[0] + impulse[1] * impulse[1]) / (2.0 * mass) +
            impulse[2] * impulse[2] / (2.0 * inertia);
  for (const Support& end : data.supports) {  // moved like a rigid body, or turned like one round that end
    for (const auto& motion : end.displacement)
      if (motion) energy += 0.5 * mass * motion->largest_rate() * motion->largest_rate();
    if (end.motion)
      energy +=
          0.5 * (inertia + mass * L * L / 4.0) * end.motion->largest_rate() * end.motion->largest_rate();
  }
  energy += weight * (held ? std::min(L, weight * L * L * L / (8.0 * s.EI) + weight * L / s.GA)
                           : 0.5 * std::abs(data.gravity) * data.horizon * data.horizon);
  if (held && !data.supports[0].rotation && !data.supports[1].rotation &&
      data.supports[0].place != data.supports[1].place)
    energy = std::max(energy, 0.5 * weight * L);  // a pendulum falls by its length
  if (!(energy > 0.0)) energy = s.EI / L;         // at rest for ever: bent by a radian

  Scales scales{};
  scales.energy = energy;
  scales.velocity = std::sqrt(2.0 * energy / mass);
  scales.momentum = mass * scales.velocity;
  scales.angular_momentum =
      std::sqrt(2.0 * energy * inertia) + scales.momentum * std::hypot(centre[0], centre[1]);
  // The first bending mode of a free beam, slowed by shear and rotary inertia, or the turning.
  const double bending = 22.37 / (L * L) * std::sqrt(s.EI / s.rhoA);
  const double slow = 1.0 + 22.37 / (L * L) * (s.rhoI / s.rhoA + s.EI / s.GA);
  const double turning = std::sqrt(2.0 * energy / inertia);
  scales.time = 1.0 / std::max(bending / std::sqrt(slow), std::min(turning, 1e3 * bending));
  return scales;
}

}  // namespace gnomon::planar_beam
