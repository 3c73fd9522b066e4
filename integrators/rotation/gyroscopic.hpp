#pragma once
#include "integrators/rotation/newton.hpp"
#include "src/status.hpp"

namespace gnomon::rotation {

/// Solves I w - (h/2) (I w) x w = known for the body velocity w by Newton's method to rounding, from the
/// velocity of `known` alone.
[[gnu::noinline]] inline Status solve_gyroscopic(const Vector3& inertia, const Vector3& known, double h,
                                                 Vector3& w, long& iterations) {
  Vector3 next = known.cwiseQuotient(inertia);
  Corrections corrections;
  for (;;) {
    ++iterations;
    const Vector3 m = inertia.cwiseProduct(next);
    const Vector3 residual = m - 0.5 * h * m.cross(next) - known;
    // d (I w x w) = -w x (I dw) + (I w) x dw
    Matrix3 derivative = 0.5 * h * (cross_matrix(next) * inertia.asDiagonal() - cross_matrix(m));
    derivative.diagonal() += inertia;
    const Vector3 change = solve(derivative, residual);
    next -= change;
    const auto verdict = corrections.add(change.cwiseAbs().maxCoeff(), next.cwiseAbs().maxCoeff());
    if (verdict == Corrections::Verdict::failed || !next.allFinite()) return Status::newton_failed;
    if (verdict == Corrections::Verdict::done) break;
  }
  w = next;
  return Status::ok;
}

}  // namespace gnomon::rotation
