#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "models/rigid_body/state.hpp"
#include "models/rigid_body_ensemble/random.hpp"

namespace gnomon::rigid_body_ensemble {

/// A body at t = 0.
struct Body {
  Eigen::Vector3d inertia;           ///< principal, kg m^2
  Eigen::Matrix3d attitude;          ///< body -> space
  Eigen::Vector3d angular_momentum;  ///< body components, kg m^2/s
  Eigen::Vector3d load;              ///< of the load, N m; 0 without one
};

struct Interval {
  double least, most;
};

/// What the bodies are drawn from.
struct Distribution {
  std::uint64_t seed = 1;
  Interval inertia{1.0, 1.0};  ///< principal moments, kg m^2; positive
  Interval spin{0.0, 0.0};     ///< angular speed, rad/s
  Interval load{0.0, 0.0};     ///< size of the load's vector, N m
};

/// Body number i: any attitude, any direction of the angular velocity in the body and of the load, sizes
/// uniform in their intervals. Its principal moments are drawn again until each is at most the sum of the two
/// others, as those of a real body are. It depends on the seed and its own number, not on how many there are.
inline Body draw_body(const Distribution& from, std::uint64_t i) {
  Random random(from.seed, i);
  const auto vector = [&](const Interval& size) -> Eigen::Vector3d {
    const auto d = random.direction();
    return random.uniform(size.least, size.most) * Eigen::Vector3d(d[0], d[1], d[2]);
  };
  Body body;
  do {
    for (int k = 0; k < 3; ++k) body.inertia[k] = random.uniform(from.inertia.least, from.inertia.most);
  } while (2.0 * body.inertia.maxCoeff() > body.inertia.sum());
  const auto q = random.quaternion();
  Eigen::Quaterniond orientation(q[0], q[1], q[2], q[3]);
  orientation.normalize();
  const double coefficients[4] = {orientation.w(), orientation.x(), orientation.y(), orientation.z()};
  body.attitude = rigid_body::homogeneous_matrix(coefficients);
  body.angular_momentum = vector(from.spin).cwiseProduct(body.inertia);
  body.load = vector(from.load);
  return body;
}

inline std::vector<Body> draw_bodies(const Distribution& from, std::size_t count) {
  std::vector<Body> bodies;
  bodies.reserve(count);
  for (std::size_t i = 0; i < count; ++i) bodies.push_back(draw_body(from, i));
  return bodies;
}

}  // namespace gnomon::rigid_body_ensemble
