#include "integrators/rotation/exact_drift.hpp"

#include "models/rigid_body/exact_free_top.hpp"

namespace gnomon::rotation {

Status ExactDrift::long_turn(const Vector3& inertia, const Vector3& m, double tau, Quaternion& by) {
  // A turn of 1e12 rad has errors of 1e-3 rad.
  if (!(std::abs(tau) * m.cwiseQuotient(inertia).stableNorm() <= 1e12)) return Status::diverged;
  by = rigid_body::ExactFreeTop<double>(inertia, Quaternion::Identity(), m).at(tau).orientation;
  return Status::ok;
}

}  // namespace gnomon::rotation
