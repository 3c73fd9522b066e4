#pragma once
#include <cmath>

#include "integrators/beam/midpoint.hpp"

namespace gnomon::beam {

/// The documented step whose strains change by sinc(a) h Obar J R_m d_m + cos(a) h R_m vbar', a = (h/2) Obar:
/// with the forces times cos a and the couple times sinc a the work is the change of the strain energy.
template <>
struct PointStep<Turning::stander_stein> : PointStep<Turning::documented> {
  using Documented = PointStep<Turning::documented>;

  double cosine, sine, sinc, sinc_slope;  ///< of a

  PointStep() = default;
  PointStep(const PointHistory& now, double e1, double e2, const CrossSection& section, double h, double w1,
            double w2, double slope3, double omega)
      : Documented(now, e1, e2, section, h, w1, w2, slope3, omega) {
    const double a = 0.5 * h * omega, x = a * a;
    const CosSin turn = cos_sin(a);
    cosine = turn.c;
    sine = turn.s;
    if (std::abs(a) > 0.125) {
      sinc = sine / a;
      sinc_slope = (cosine - sinc) / a;
    } else {
      sinc = 1.0 - x / 6 * (1.0 - x / 20 * (1.0 - x / 42 * (1.0 - x / 72 * (1.0 - x / 110))));
      sinc_slope = -a / 3 * (1.0 - x / 10 * (1.0 - x / 28 * (1.0 - x / 54 * (1.0 - x / 88))));
    }
  }

  PointForce force(const CrossSection& section) const {
    PointForce f = Documented::force(section);
    f.t1 *= cosine;
    f.t2 *= cosine;
    f.couple *= sinc;
    return f;
  }

  PointTangent force_tangent(const CrossSection& section, double h) const {
    const double half = 0.5 * h;
    const PointForce f = Documented::force(section);
    PointTangent d = Documented::force_tangent(section, h);
    for (double* t : {&d.a11, &d.a12, &d.a21, &d.a22, &d.t1r, &d.t2r}) *t *= cosine;
    for (double* m : {&d.c1, &d.c2, &d.cr}) *m *= sinc;
    d.t1r -= half * sine * f.t1;
    d.t2r -= half * sine * f.t2;
    d.cr += half * sinc_slope * f.couple;
    return d;
  }
};

struct BeamStanderStein : MidpointStep<Turning::stander_stein> {
  static constexpr SchemeInfo info{
      .name = "beam-stander-stein",
      .family = "beam",
      .summary =
          "midpoint with forces scaled to the change of the strains: energy exact, angular momentum not",
      .citation =
          "E. Stander, E. Stein, Engineering Computations 13 (1996) 60-85, strain factors cos and sinc "
          "of half the rotation in a step",
      .form = "beam",
      .orders = {{{"none", 2}, {"dead", 2}, {"follower", 2}}},
      .reversible = true,
      .conserves_energy = true,
      .uses = stepper_uses,
  };
};

extern template class Stepper<planar_beam::PlanarBeam<1>, Turning::stander_stein>;
extern template class Stepper<planar_beam::PlanarBeam<2>, Turning::stander_stein>;
extern template class Stepper<planar_beam::PlanarBeam<3>, Turning::stander_stein>;
extern template class Stepper<planar_beam::PlanarBeam<4>, Turning::stander_stein>;

}  // namespace gnomon::beam
