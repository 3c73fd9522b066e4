#include "models/planar_beam/rigid_motion.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

namespace gnomon::planar_beam {

bool is_held_rigidly(const Data& data, const Numbering& numbering, const std::vector<double>& positions,
                     const std::array<double, 2>& centre) {
  const int hinges = static_cast<int>(data.hinges.size()), count = 3 * (hinges + 1);
  // Of each piece the displacement (x, z) of what is at the beam's centre, and L times the rotation.
  Eigen::MatrixXd held = Eigen::MatrixXd::Zero(count, count);
  const auto rate_at = [&](int node, int k) {
    const double x = (positions[2 * node] - centre[0]) / data.length,
                 z = (positions[2 * node + 1] - centre[1]) / data.length;
    return k == 0   ? Eigen::RowVector3d(1.0, 0.0, z)
           : k == 1 ? Eigen::RowVector3d(0.0, 1.0, -x)
                    : Eigen::RowVector3d(0.0, 0.0, 1.0);
  };
  const auto hold = [&](int piece, int node, int k, bool with_next) {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(count);
    row.segment<3>(3 * piece) = rate_at(node, k);
    if (with_next) row.segment<3>(3 * piece + 3) = -rate_at(node, k);
    held += row.transpose() * row;
  };
  for (int k = 0; k < 3; ++k) {
    for (int end = 0; end < 2; ++end)
      if (data.supports[end].holds(k) || (k == 2 && data.supports[end].spring > 0.0))
        hold(end == 0 ? 0 : hinges, end == 0 ? 0 : numbering.unknowns() / 3 - 1, k, false);
    for (int hinge = 0; hinge < hinges; ++hinge)
      if (k < 2 || data.hinges[hinge].spring > 0.0) hold(hinge, numbering.right_rotation(hinge) / 3, k, true);
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(held, Eigen::EigenvaluesOnly).eigenvalues()[0] >
         1e-10;
}

}  // namespace gnomon::planar_beam
