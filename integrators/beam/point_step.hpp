#pragma once
#include <cmath>

#include "models/planar_beam/data.hpp"
#include "models/planar_beam/element.hpp"

namespace gnomon::beam {

using planar_beam::CrossSection;
using planar_beam::PointForce;
using planar_beam::PointTangent;

/// How a point steps: the rotation advances by h times the mean angular velocity as documented, or by the
/// Cayley map, by 2 atan of half that. `stander_stein` and `mixed` turn as documented; the first scales the
/// forces to the change of the strains, the second carries the strains by their rates.
enum class Turning { documented, cayley, stander_stein, mixed };

/// What the scheme carries from step to step at an integration point: d = (d1, d2), the rotation as cos phi
/// and sin phi, g = R(phi) d = e - e0, and the bending strain phi' - kappa0.
struct PointHistory {
  double d1, d2, c, s, g1, g2, bending;
};

struct CosSin {
  double c, s;
};

/// To rounding; by series where the angle is small, as it is in all but very large steps.
inline CosSin cos_sin(double z) {
  if (std::abs(z) > 0.125) return {std::cos(z), std::sin(z)};
  const double x = z * z;
  const double c =
      1.0 - x * (1.0 / 2 - x * (1.0 / 24 - x * (1.0 / 720 - x * (1.0 / 40320 - x * (1.0 / 3628800)))));
  const double s =
      z - z * x * (1.0 / 6 - x * (1.0 / 120 - x * (1.0 / 5040 - x * (1.0 / 362880 - x * (1.0 / 39916800)))));
  return {c, s};
}

/// One integration point in a step of size h for a mean velocity whose slopes are (w1, w2, w3) and whose
/// angular velocity is `omega`. Equations of the note, section "numerical computation"; `cayley` is the
/// repair that makes the energy exact (see models/planar_beam/README.md). The other kinds are specialisations
/// in files of their own.
template <Turning turning>
struct PointStep {
  static constexpr bool cayley = turning == Turning::cayley;

  double c, s;        ///< R at the middle of the step
  double gm1, gm2;    ///< e_{n+1/2} - e0
  double n1, n2;      ///< N_{n+1/2} = C (e_{n+1} + e_n)/2
  PointHistory next;  ///< at the end of the step
  double factor;      ///< cos a of the Cayley map, else 1
  double tangent;     ///< sin a of the Cayley map
  double w3;
  double bending;  ///< mean bending strain

  PointStep() = default;
  PointStep(const PointHistory& now, double e1, double e2, const CrossSection& section, double h, double w1,
            double w2, double slope3, double omega)
      : w3(slope3) {
    const double half = 0.5 * h, z = half * omega;
    CosSin turn;
    if constexpr (cayley) {
      factor = 1.0 / std::sqrt(1.0 + z * z);
      tangent = z * factor;
      turn = {factor, tangent};
    } else {
      factor = 1.0;
      tangent = 0.0;
      turn = cos_sin(z);
    }
    c = turn.c * now.c - turn.s * now.s;
    s = turn.s * now.c + turn.c * now.s;
    next.c = turn.c * c - turn.s * s;
    next.s = turn.s * c + turn.c * s;
    // e_{n+1/2} = R((h/2) Obar)(e_n - e0) + e0 + (h/2) R(phi_n + (h/2) Obar) vbar'
    gm1 = turn.c * now.g1 - turn.s * now.g2 + half * (c * w1 - s * w2);
    gm2 = turn.s * now.g1 + turn.c * now.g2 + half * (s * w1 + c * w2);
    // e_{n+1} = R(phi_n + h Obar) d_{n+1} + e0
    next.d1 = now.d1 + h * w1;
    next.d2 = now.d2 + h * w2;
    next.g1 = next.c * next.d1 - next.s * next.d2;
    next.g2 = next.s * next.d1 + next.c * next.d2;
    n1 = section.EA * (0.5 * (now.g1 + next.g1) + e1);
    n2 = section.GA * (0.5 * (now.g2 + next.g2) + e2);
    const double increment = cayley ? factor * factor * h * slope3 : h * slope3;
    next.bending = now.bending + increment;
    bending = now.bending + 0.5 * increment;
  }

  /// Rbar = R^T N_{n+1/2}, the bending moment and the couple; of the Cayley map times cos a, cos^2 a, cos a.
  PointForce force(const CrossSection& section) const {
    return {factor * (c * n1 + s * n2), factor * (c * n2 - s * n1), factor * factor * section.EI * bending,
            factor * (n2 * gm1 - n1 * gm2)};
  }

  /// The derivative of the force by w1, w2, w3 and omega (note, section "linearisation").
  PointTangent force_tangent(const CrossSection& section, double h) const {
    const double half = 0.5 * h;
    const double rate = cayley ? half * factor * factor : half;  // d(phi_m)/d(omega)
    // dN = C d(e_{n+1})/2: by the slopes C (h/2) R_{n+1}, by omega C J (e_{n+1} - e0) d(phi_m)/d(omega)
    const double a11 = half * section.EA * next.c, a12 = -half * section.EA * next.s;
    const double a21 = half * section.GA * next.s, a22 = half * section.GA * next.c;
    const double r1 = -rate * section.EA * next.g2, r2 = rate * section.GA * next.g1;
    PointTangent d;
    d.a11 = factor * (c * a11 + s * a21);
    d.a12 = factor * (c * a12 + s * a22);
    d.a21 = factor * (c * a21 - s * a11);
    d.a22 = factor * (c * a22 - s * a12);
    const double q1 = r1 + rate * n2, q2 = r2 - rate * n1;
    d.t1r = factor * (c * q1 + s * q2);
    d.t2r = factor * (c * q2 - s * q1);
    // couple N2 g1 - N1 g2 with dg_m = (h/2) R dw + J g_m d(phi_m)
    d.c1 = factor * (a21 * gm1 + n2 * half * c - a11 * gm2 - n1 * half * s);
    d.c2 = factor * (a22 * gm1 - n2 * half * s - a12 * gm2 - n1 * half * c);
    d.cr = factor * (r2 * gm1 - n2 * rate * gm2 - r1 * gm2 - n1 * rate * gm1);
    d.mk = section.EI * half;
    d.mr = 0.0;
    if constexpr (cayley) {
      const double q = factor * factor, by_omega = -tangent * rate;  // d(cos a)/d(omega)
      const double t1 = c * n1 + s * n2, t2 = c * n2 - s * n1;
      d.t1r += by_omega * t1;
      d.t2r += by_omega * t2;
      d.cr += by_omega * (n2 * gm1 - n1 * gm2);
      d.mk *= q * q;
      d.mr = section.EI * 2.0 * factor * by_omega * (bending + q * half * w3);
    }
    return d;
  }

  /// What the next step begins with; the length of (cos, sin) is put right to rounding.
  PointHistory end() const {
    PointHistory end = next;
    const double norm = 1.5 - 0.5 * (next.c * next.c + next.s * next.s);
    end.c *= norm;
    end.s *= norm;
    return end;
  }
};

}  // namespace gnomon::beam
