#pragma once
#include "integrators/rotation/newton.hpp"
#include "integrators/rotation/pose.hpp"

namespace gnomon::rotation {

/// Which terms an equation of the family below has beside the common ones.
struct CayleyTerms {
  bool cubic;   ///< (c.J c) c on the left
  bool scaled;  ///< the factor 1 + |c|^2 on the right
};

/// Solves J c + c x (J c) [+ (c.J c) c] = [(1 + |c|^2)] p for the vector c = tan(angle/2) along the axis of a
/// turn, J diagonal, p half the impulse h m/2 of a step. Newton's method to rounding from one sweep of the
/// fixed-point iteration; `iterations` counts.
template <CayleyTerms terms>
[[gnu::noinline]] Status solve_cayley(const Vector3& J, const Vector3& p, Vector3& c, long& iterations) {
  c = p.cwiseQuotient(J);
  c = ((terms.scaled ? 1.0 + c.squaredNorm() : 1.0) * p - c.cross(p)).cwiseQuotient(J);
  Corrections corrections;
  for (;;) {
    ++iterations;
    const Vector3 Jc = J.cwiseProduct(c);
    Vector3 residual = Jc + c.cross(Jc) - p;
    Matrix3 derivative = cross_matrix(c) * J.asDiagonal();
    derivative -= cross_matrix(Jc);
    derivative.diagonal() += J;
    if constexpr (terms.scaled) {
      residual -= c.squaredNorm() * p;
      derivative -= 2.0 * p * c.transpose();
    }
    if constexpr (terms.cubic) {
      residual += c.dot(Jc) * c;
      derivative += 2.0 * c * Jc.transpose();
      derivative.diagonal().array() += c.dot(Jc);
    }
    const Vector3 change = solve(derivative, residual);
    c -= change;
    switch (corrections.add(change.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff())) {
      case Corrections::Verdict::done:
        return c.allFinite() ? Status::ok : Status::newton_failed;
      case Corrections::Verdict::failed:
        return Status::newton_failed;
      case Corrections::Verdict::go_on:
        break;
    }
  }
}

/// A map of the free body of this family with J the inertia itself.
template <CayleyTerms terms>
class CayleyFlow {
 public:
  static constexpr bool exact = false;
  explicit CayleyFlow(const Vector3& inertia) : inertia_(inertia) {}

  /// The turn that the momentum m (body components) makes in the time tau.
  Status turn(const Vector3& m, double tau, Quaternion& by) {
    Vector3 c;
    const Status status = solve_cayley<terms>(inertia_, 0.5 * tau * m, c, iterations_);
    by = cayley(c);
    return status;
  }
  long iterations() const { return iterations_; }

 private:
  Vector3 inertia_;
  long iterations_ = 0;
};

}  // namespace gnomon::rotation
