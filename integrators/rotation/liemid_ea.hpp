#pragma once
#include "integrators/rotation/kicked.hpp"
#include "integrators/rotation/newton.hpp"

namespace gnomon::rotation {

/// Two midpoint Lie steps of half the time: th = (h/2) I^-1 exp(-th/2) m, then the turn by the rotation
/// vector th. Each equation is solved by Newton's method to rounding.
class MidpointLieFlow {
 public:
  static constexpr bool exact = false;
  explicit MidpointLieFlow(const Vector3& inertia) : inertia_(inertia) {}

  Status turn(const Vector3& m, double tau, Quaternion& by) {
    Vector3 first, second;
    Status status = half(m, 0.5 * tau, first);
    if (status != Status::ok) return status;
    status = half(Rotation(first).inverse(m), 0.5 * tau, second);
    by = exponential(first) * exponential(second);
    return status;
  }
  long iterations() const { return iterations_; }

 private:
  [[gnu::noinline]] Status half(const Vector3& m, double tau, Vector3& angle) {
    angle = tau * m.cwiseQuotient(inertia_);
    Corrections corrections;
    for (;;) {
      ++iterations_;
      const Vector3 v = Rotation(0.5 * angle).inverse(m);
      const Vector3 residual = inertia_.cwiseProduct(angle) - tau * v;
      // d v = v x (D d angle)/2, D of -angle/2
      Matrix3 derivative = -0.5 * tau * (cross_matrix(v) * left_derivative(-0.5 * angle));
      derivative.diagonal() += inertia_;
      const Vector3 change = solve(derivative, residual);
      angle -= change;
      switch (corrections.add(change.cwiseAbs().maxCoeff(), angle.cwiseAbs().maxCoeff())) {
        case Corrections::Verdict::done:
          return angle.allFinite() ? Status::ok : Status::newton_failed;
        case Corrections::Verdict::failed:
          return Status::newton_failed;
        case Corrections::Verdict::go_on:
          break;
      }
    }
  }

  Vector3 inertia_;
  long iterations_ = 0;
};

struct LiemidEa : Kicked<MidpointLieFlow, strang> {
  static constexpr SchemeInfo info{
      .name = "liemid-ea",
      .family = "rotation",
      .summary = "LIEMID[EA]: half kick, two midpoint Lie steps of half the size, half kick",
      .citation = "P. Krysl, Int. J. Numer. Meth. Engng 63 (2005) 2171-2193",
      .form = "rotation",
      .orders = {{{"none", 2}, {"gravity", 2}, {"space_moment", 2}, {"body_moment", 2}}},
      .reversible = true,
      .conserves_momentum = true,
  };
};

}  // namespace gnomon::rotation
