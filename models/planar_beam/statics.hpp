#pragma once
#include <cmath>

#include "models/planar_beam/data.hpp"
#include "models/planar_beam/element.hpp"

namespace gnomon::planar_beam {

/// The unstressed configuration at an integration point: initial tangent d0 = (d1, d2), strain offset e0 =
/// (e1, e2) so that e = R(phi) d + e0 vanishes there, and phi = -phi0. The curvature kappa - kappa0 is the
/// slope of the rotation's increment, so kappa0 itself drops out.
struct PointReference {
  double d1, d2, e1, e2, phi;
};

/// R(phi) d + e0 and phi' - kappa0 from the slopes (s1, s2, s3) of u and the rotation's increment.
struct PointStrain {
  double c, s;             ///< cos phi, sin phi
  double g1, g2;           ///< R(phi) d
  double e1, e2, bending;  ///< epsilon, gamma, kappa

  PointStrain(const PointReference& r, double s1, double s2, double s3, double rotation)
      : c(std::cos(r.phi + rotation)), s(std::sin(r.phi + rotation)) {
    const double d1 = r.d1 + s1, d2 = r.d2 + s2;
    g1 = c * d1 - s * d2;
    g2 = s * d1 + c * d2;
    e1 = g1 + r.e1;
    e2 = g2 + r.e2;
    bending = s3;
  }

  /// T = R^T C e, M = EI kappa, couple N2 g1 - N1 g2: the derivative of the strain energy by slopes and
  /// rotation (note, basic equations).
  PointForce force(const CrossSection& section) const {
    const double n1 = section.EA * e1, n2 = section.GA * e2;
    return {c * n1 + s * n2, -s * n1 + c * n2, section.EI * bending, n2 * g1 - n1 * g2};
  }
  PointTangent tangent(const CrossSection& section) const {
    const double n1 = section.EA * e1, n2 = section.GA * e2;
    const double m1 = -section.EA * g2, m2 = section.GA * g1;  // dN/dphi = C J g
    const double q1 = m1 + n2, q2 = m2 - n1;                   // dT/dphi = R^T (dN/dphi + J^T N)
    PointTangent d{};
    d.a11 = c * c * section.EA + s * s * section.GA;
    d.a12 = d.a21 = c * s * (section.GA - section.EA);
    d.a22 = s * s * section.EA + c * c * section.GA;
    d.t1r = c * q1 + s * q2;
    d.t2r = -s * q1 + c * q2;
    d.c1 = d.t1r;
    d.c2 = d.t2r;
    d.cr = m2 * g1 - n2 * g2 - m1 * g2 - n1 * g1;
    d.mk = section.EI;
    return d;
  }
};

}  // namespace gnomon::planar_beam
