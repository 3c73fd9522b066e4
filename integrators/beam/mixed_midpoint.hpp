#pragma once
#include "integrators/beam/midpoint.hpp"

namespace gnomon::beam {

/// A point that carries its strains by their rates at the middle of the step,
///   e_{n+1} = e_n + h (R_m vbar' + Obar J R_m d_m),   phi_m = phi_n + (h/2) Obar,   d_m = d_n + (h/2) vbar',
/// and answers with R_m^T N, N = C (e_{n+1} + e_n)/2: the work is the change of the strain energy. `g1`, `g2`
/// of its history are e - e0, which is not R(phi) d.
template <>
struct PointStep<Turning::mixed> {
  double c, s;        ///< R at the middle of the step
  double gm1, gm2;    ///< R_m d_m
  double n1, n2;      ///< N_{n+1/2}
  PointHistory next;  ///< at the end of the step
  double rw1, rw2;    ///< R_m vbar'
  double turn;        ///< (h/2) Obar
  double bending;     ///< mean bending strain

  PointStep() = default;
  PointStep(const PointHistory& now, double e1, double e2, const CrossSection& section, double h, double w1,
            double w2, double slope3, double omega)
      : turn(0.5 * h * omega) {
    const double half = 0.5 * h;
    const CosSin by = cos_sin(turn);
    c = by.c * now.c - by.s * now.s;
    s = by.s * now.c + by.c * now.s;
    next.c = by.c * c - by.s * s;
    next.s = by.s * c + by.c * s;
    rw1 = c * w1 - s * w2;
    rw2 = s * w1 + c * w2;
    const double dm1 = now.d1 + half * w1, dm2 = now.d2 + half * w2;
    gm1 = c * dm1 - s * dm2;
    gm2 = s * dm1 + c * dm2;
    next.d1 = now.d1 + h * w1;
    next.d2 = now.d2 + h * w2;
    next.g1 = now.g1 + h * (rw1 - omega * gm2);
    next.g2 = now.g2 + h * (rw2 + omega * gm1);
    n1 = section.EA * (0.5 * (now.g1 + next.g1) + e1);
    n2 = section.GA * (0.5 * (now.g2 + next.g2) + e2);
    next.bending = now.bending + h * slope3;
    bending = now.bending + half * slope3;
  }

  PointForce force(const CrossSection& section) const {
    return {c * n1 + s * n2, c * n2 - s * n1, section.EI * bending, n2 * gm1 - n1 * gm2};
  }

  PointTangent force_tangent(const CrossSection& section, double h) const {
    const double half = 0.5 * h;
    // dN = C de_{n+1}/2: by the slopes C (h/2) (1 + turn J) R_m,
    const double a11 = half * section.EA * (c - turn * s), a12 = -half * section.EA * (s + turn * c);
    const double a21 = half * section.GA * (s + turn * c), a22 = half * section.GA * (c - turn * s);
    // by omega C (h/2) (J (R_m d_m + (h/2) R_m vbar') - turn R_m d_m), as dR_m = (h/2) J R_m.
    const double r1 = -half * section.EA * (gm2 + half * rw2 + turn * gm1);
    const double r2 = half * section.GA * (gm1 + half * rw1 - turn * gm2);
    PointTangent d;
    d.a11 = c * a11 + s * a21;
    d.a12 = c * a12 + s * a22;
    d.a21 = c * a21 - s * a11;
    d.a22 = c * a22 - s * a12;
    const double q1 = r1 + half * n2, q2 = r2 - half * n1;
    d.t1r = c * q1 + s * q2;
    d.t2r = c * q2 - s * q1;
    d.c1 = a21 * gm1 + n2 * half * c - a11 * gm2 - n1 * half * s;
    d.c2 = a22 * gm1 - n2 * half * s - a12 * gm2 - n1 * half * c;
    d.cr = r2 * gm1 - n2 * half * gm2 - r1 * gm2 - n1 * half * gm1;
    d.mk = section.EI * half;
    d.mr = 0.0;
    return d;
  }

  PointHistory end() const {
    PointHistory end = next;
    const double norm = 1.5 - 0.5 * (next.c * next.c + next.s * next.s);
    end.c *= norm;
    end.s *= norm;
    return end;
  }
};

struct BeamMixedMidpoint : MidpointStep<Turning::mixed> {
  static constexpr SchemeInfo info{
      .name = "beam-mixed-midpoint",
      .family = "beam",
      .summary =
          "midpoint with strains carried by their rates, as independent unknowns: energy and momenta exact",
      .citation =
          "P.L. Kinon, P. Betsch, S.R. Eugster, energy-momentum-consistent simulation of planar "
          "geometrically exact beams in a port-Hamiltonian framework, Multibody Syst. Dyn. (2025), "
          "doi 10.1007/s11044-025-10087-9: midpoint rule, strains as state",
      .form = "beam",
      .orders = {{{"none", 2}, {"dead", 2}, {"follower", 2}}},
      .reversible = true,
      .conserves_energy = true,
      .conserves_momentum = true,
      .uses = stepper_uses,
  };
};

extern template class Stepper<planar_beam::PlanarBeam<1>, Turning::mixed>;
extern template class Stepper<planar_beam::PlanarBeam<2>, Turning::mixed>;
extern template class Stepper<planar_beam::PlanarBeam<3>, Turning::mixed>;
extern template class Stepper<planar_beam::PlanarBeam<4>, Turning::mixed>;

}  // namespace gnomon::beam
