#pragma once
// Random bodies of chosen speed, and one body of an ensemble as a model of its own.

#include <cmath>
#include <vector>

#include "integrators/ensemble/schemes.hpp"
#include "models/rigid_body/rigid_body.hpp"
#include "models/rigid_body_ensemble/ensemble.hpp"

namespace gnomon::test {

using rigid_body_ensemble::Body;
using rigid_body_ensemble::Ensemble;
using rigid_body_ensemble::Execution;

/// Seeded bodies whose spins, in turn, turn them by these angles [rad] in a step of h [s].
inline std::vector<Body> bodies_turning(std::size_t count, const std::vector<double>& angles, double h,
                                        std::uint64_t seed) {
  rigid_body_ensemble::Distribution from;
  from.seed = seed;
  from.inertia = {0.5, 1.5};
  from.spin = {1.0, 1.0};
  from.load = {0.1, 1.0};
  std::vector<Body> bodies = draw_bodies(from, count);
  for (std::size_t i = 0; i < count; ++i) bodies[i].angular_momentum *= angles[i % angles.size()] / h;
  return bodies;
}

/// The load of one body of an ensemble.
template <class Load>
Load load_of(const Body& body) {
  if constexpr (std::is_same_v<Load, rigid_body::Gravity>)
    return {1.0, body.load};
  else if constexpr (std::is_same_v<Load, rigid_body::SpaceMoment>)
    return {body.load};
  else
    return {};
}
template <class Load>
rigid_body::RigidBody<Load> single(const Body& body) {
  return {body.inertia, {body.attitude, body.angular_momentum}, load_of<Load>(body), 1.0};
}

/// All bodies after some steps of the ensemble's scheme, flattened.
template <class S, class M>
std::vector<double> after_steps(const M& model, double h, long steps) {
  auto state = S::start(model, model.initial());
  for (long n = 0; n < steps; ++n) S::step(model, state, 0.0, h);
  return model.flatten(S::view(model, state));
}

/// Calls `body` with a null pointer to each load that ensembles know.
template <class Body>
void for_each_load(Body&& body) {
  body(static_cast<rigid_body::Free*>(nullptr));
  body(static_cast<rigid_body::SpaceMoment*>(nullptr));
  body(static_cast<rigid_body::Gravity*>(nullptr));
}

}  // namespace gnomon::test
