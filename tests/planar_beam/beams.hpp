#pragma once
// Beams for tests, made without scene files.

#include <cmath>
#include <random>

#include "models/planar_beam/planar_beam.hpp"

namespace gnomon::test {

using planar_beam::Data;
using planar_beam::PlanarBeam;

/// J.C. Simo, L. Vu-Quoc, J. Appl. Mech. 53 (1986) 855.
inline Data flying_beam(int elements, double EI) {
  Data data;
  data.length = 10.0;
  data.elements = elements;
  data.section = {1e4, 1e4, EI, 1.0, 10.0};
  data.start = {6.0, 0.0};
  data.angle = 2.214297435588181;
  data.loads = {{planar_beam::Place::start, {8.0, 0.0}, 80.0, planar_beam::Profile::step, 2.5}};
  data.horizon = 15.0;
  return data;
}

/// A free beam of soft section with a spin; curved by a quarter circle or straight.
inline Data spinning_beam(int elements, bool curved) {
  Data data = flying_beam(elements, 500.0);
  data.loads.clear();
  data.section.rhoI = 1.0;
  data.curvature = curved ? 0.15707963267948966 : 0.0;
  data.velocity = {0.5, 0.2};
  data.angular_velocity = 1.0;
  return data;
}

/// All frequencies of the mesh are low, so that moderate steps are in the range of the order.
inline Data soft_beam(int elements) {
  Data data;
  data.elements = elements;
  data.section = {10.0, 5.0, 0.5, 1.0, 0.1};
  data.gravity = 1.0;
  data.supports[0] = {true, true};
  data.loads = {{planar_beam::Place::end, {0.3, 0.8}, 0.2, planar_beam::Profile::constant, 0.0}};
  data.horizon = 2.0;
  return data;
}

/// Nodal values in [-size, size].
inline Eigen::VectorXd random_values(int count, double size, unsigned seed) {
  std::mt19937 engine(seed);
  Eigen::VectorXd values(count);
  for (double& value : values) value = size * (2.0 * static_cast<double>(engine()) / 4294967295.0 - 1.0);
  return values;
}

}  // namespace gnomon::test
