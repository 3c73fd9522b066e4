#pragma once
#include <Eigen/Core>
#include <cmath>

namespace gnomon::planar_beam {

/// Norm of nodal values (x, z, rotation) of one node after the other, every third times `lever`: the length
/// of the beam for displacements and velocities, its reciprocal for forces and moments.
inline double nodal_norm(const Eigen::Ref<const Eigen::VectorXd>& values, double lever) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const double x = i % 3 == 2 ? lever * values[i] : values[i];
    sum += x * x;
  }
  return std::sqrt(sum);
}

}  // namespace gnomon::planar_beam
