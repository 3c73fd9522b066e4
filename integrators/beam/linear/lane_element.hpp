#pragma once
// The equations of one linear element in each lane. Compiled once for each instruction set, see
// lane_step.hpp. Lanes<n>, n numbers side by side, has to be defined before: vector_lanes.hpp or
// scalar_lanes.hpp.

#include "integrators/beam/linear/kernels.hpp"
#include "integrators/beam/linear/lane_blocks.hpp"

namespace gnomon::beam::linear {
namespace {

/// cos z and sin z for |z| <= 0.8 by their series, to rounding.
template <class V>
struct CosSin {
  V c, s;
};
template <class V>
[[gnu::always_inline]] inline CosSin<V> cos_sin(const V& z) {
  const V x = z * z;
  V c = -1.0 / 6402373705728000.0 * x + 1.0 / 20922789888000.0;
  c = c * x - 1.0 / 87178291200.0;
  c = c * x + 1.0 / 479001600.0;
  c = c * x - 1.0 / 3628800.0;
  c = c * x + 1.0 / 40320.0;
  c = c * x - 1.0 / 720.0;
  c = c * x + 1.0 / 24.0;
  c = c * x - 0.5;
  V s = 1.0 / 355687428096000.0 * x - 1.0 / 1307674368000.0;
  s = s * x + 1.0 / 6227020800.0;
  s = s * x - 1.0 / 39916800.0;
  s = s * x + 1.0 / 362880.0;
  s = s * x - 1.0 / 5040.0;
  s = s * x + 1.0 / 120.0;
  s = s * x - 1.0 / 6.0;
  return {c * x + 1.0, (s * x) * z + z};
}
/// atan z for |z| <= 0.66 to rounding: the rational function of S.L. Moshier's Cephes library.
template <class V>
[[gnu::always_inline]] inline V arctan(const V& z) {
  const V x = z * z;
  V p = -8.750608600031904122785e-1 * x - 1.615753718733365076637e1;
  p = p * x - 7.500855792314704667340e1;
  p = p * x - 1.228866684490136173410e2;
  p = p * x - 6.485021904942025371773e1;
  V q = x + 2.485846490142306297962e1;
  q = q * x + 1.650270098316988542046e2;
  q = q * x + 4.328810604912902668951e2;
  q = q * x + 4.853903996359136964868e2;
  q = q * x + 1.945506571482613964425e2;
  return z + z * (x * (p / q));
}
/// Half a step may turn an element by this, rad; it is not for larger turns.
inline constexpr double most_half_turn = 0.6;

/// What stays the same in all elements of a step of size h. `sign` is -1 in lanes that run against the
/// beam's direction.
template <class V>
struct StepConstants {
  V sign, slope, half_sign, lever;  ///< 1, 1/l, 1/2, l/2, all times the sign
  double h, half_h, EA, GA, EI, half_EA, half_GA, EA_rate, GA_rate, EI_rate, quarter_h, half_length;
  double mass[3], half_mass[3];  ///< (2/h) int rho P_a P_b: for a = b, and for a != b

  StepConstants(const Beam& beam, double step, const V& direction)
      : sign(direction),
        slope(direction / beam.element_length),
        half_sign(0.5 * direction),
        lever(0.5 * beam.element_length * direction),
        h(step),
        half_h(0.5 * step),
        EA(beam.EA),
        GA(beam.GA),
        EI(beam.EI),
        half_EA(0.5 * beam.EA),
        half_GA(0.5 * beam.GA),
        EA_rate(half_h * beam.EA / beam.element_length),
        GA_rate(half_h * beam.GA / beam.element_length),
        EI_rate(half_h * beam.EI / beam.element_length),
        quarter_h(0.25 * step),
        half_length(0.5 * beam.element_length) {
    for (int k = 0; k < 3; ++k) {
      half_mass[k] = (k < 2 ? beam.rhoA : beam.rhoI) * beam.element_length / (3.0 * step);
      mass[k] = 2.0 * half_mass[k];
    }
  }
};

/// The middle and the end of a step at an integration point: integrators/beam/point_step.hpp has the same
/// equations one by one. `cayley`: rotations by the Cayley map, forces scaled to match.
template <class V, bool cayley>
struct Point {
  V z, factor, turn_c, turn_s;
  V c, s, next_c, next_s, d1, d2, g1, g2;  ///< R at the middle; R, d, g = e - e0 at the end
  V increment;                             ///< of the bending strain

  [[gnu::always_inline]] Point(const StepConstants<V>& step, const V* now, const V& w1, const V& w2,
                               const V& w3, const V& omega) {
    z = step.half_h * omega;
    if constexpr (cayley) {
      factor = 1.0 / sqrt(1.0 + z * z);
      turn_c = factor;
      turn_s = z * factor;
      increment = (factor * factor) * (step.h * w3);
    } else {
      const CosSin<V> turn = cos_sin(z);
      turn_c = turn.c;
      turn_s = turn.s;
      increment = step.h * w3;
    }
    c = turn_c * now[2] - turn_s * now[3];
    s = turn_s * now[2] + turn_c * now[3];
    next_c = turn_c * c - turn_s * s;
    next_s = turn_s * c + turn_c * s;
    d1 = now[0] + step.h * w1;
    d2 = now[1] + step.h * w2;
    g1 = next_c * d1 - next_s * d2;
    g2 = next_s * d1 + next_c * d2;
  }
};

/// Force and inertia of an element on its two nodes, and the blocks of its tangent, first index the row.
template <class V>
struct ElementTerms {
  Triple<V> force[2], inertia[2];
  V p11, p12, p21, p22, t1, t2, c1, c2, stretch, turn, couple;
  double mass[3], half_mass[3];

  [[gnu::always_inline]] Block<V> block(double row, double column) const {
    // slope_a slope_b, slope_a shape_b and shape_a slope_b have these signs
    const double both = row * column;
    const double* m = row == column ? mass : half_mass;
    return {{{both * p11 + m[0], both * p12, row * t1},
             {both * p21, both * p22 + m[1], row * t2},
             {column * c1, column * c2, ((both * stretch + row * turn) + couple) + m[2]}}};
  }
};

template <class V, bool cayley>
[[gnu::always_inline]] inline ElementTerms<V> element_terms(const StepConstants<V>& step, const V* now,
                                                            const Triple<V>& left, const Triple<V>& right,
                                                            const Triple<V>& left_change,
                                                            const Triple<V>& right_change, V& largest) {
  const V w1 = step.slope * (right.at[0] - left.at[0]), w2 = step.slope * (right.at[1] - left.at[1]),
          w3 = step.slope * (right.at[2] - left.at[2]), omega = 0.5 * (left.at[2] + right.at[2]);
  const Point<V, cayley> at(step, now, w1, w2, w3, omega);
  largest = max(largest, at.z * at.z);
  const V u1 = step.half_h * w1, u2 = step.half_h * w2;
  const V &c = at.c, &s = at.s;
  // e_{n+1/2} - e0, N_{n+1/2} = C (e_{n+1} + e_n)/2
  const V gm1 = (at.turn_c * now[4] - at.turn_s * now[5]) + (c * u1 - s * u2);
  const V gm2 = (at.turn_s * now[4] + at.turn_c * now[5]) + (s * u1 + c * u2);
  V n1 = step.half_EA * ((now[4] + at.g1) + now[7]), n2 = step.half_GA * ((now[5] + at.g2) + now[8]);
  const V bending = now[6] + 0.5 * at.increment;
  V ka = step.EA_rate, kg = step.GA_rate, moment = step.EI * bending, rate = step.half_h;
  ElementTerms<V> to;
  to.stretch = step.EI_rate;
  if constexpr (cayley) {
    const V square = at.factor * at.factor;
    n1 *= at.factor;
    n2 *= at.factor;
    ka *= at.factor;
    kg *= at.factor;
    rate *= square;  // d(phi_m)/d(omega)
    // d(cos a)/d(omega) = -cos a z d(phi_m)/d(omega)
    to.turn = ((step.half_sign * rate) * at.z) * (moment + 0.5 * (square * (step.EI * (step.h * w3))));
    to.turn *= -2.0 * square;
    moment *= square;
    to.stretch *= square * square;
  } else {
    to.turn = 0.0;
  }
  const V t1 = c * n1 + s * n2, t2 = c * n2 - s * n1, couple = n2 * gm1 - n1 * gm2;
  const V s1 = step.sign * t1, s2 = step.sign * t2, sm = step.sign * moment, pull = step.half_length * couple;
  to.force[0] = {{-s1, -s2, pull - sm}};
  to.force[1] = {{s1, s2, pull + sm}};
  for (int k = 0; k < 3; ++k) {
    const V common = step.half_mass[k] * (left_change.at[k] + right_change.at[k]);
    to.inertia[0].at[k] = common + step.half_mass[k] * left_change.at[k];
    to.inertia[1].at[k] = common + step.half_mass[k] * right_change.at[k];
    to.mass[k] = step.mass[k];
    to.half_mass[k] = step.half_mass[k];
  }
  // dN by the slopes, C (h/2) R_{n+1}, and by omega, C J (e_{n+1} - e0) d(phi_m)/d(omega)
  const V a11 = ka * at.next_c, a12 = -ka * at.next_s, a21 = kg * at.next_s, a22 = kg * at.next_c;
  to.p11 = c * a11 + s * a21;
  to.p12 = c * a12 + s * a22;
  to.p21 = c * a21 - s * a11;
  to.p22 = c * a22 - s * a12;
  const V signed_rate = step.half_sign * rate;
  V scale_EA = step.EA * signed_rate, scale_GA = step.GA * signed_rate;
  if constexpr (cayley) {
    scale_EA *= at.factor;
    scale_GA *= at.factor;
  }
  const V q1 = signed_rate * n2 - scale_EA * at.g2, q2 = scale_GA * at.g1 - signed_rate * n1;
  to.t1 = c * q1 + s * q2;
  to.t2 = c * q2 - s * q1;
  const V arm1 = step.lever * gm1, arm2 = step.lever * gm2, by_turn = step.half_h * step.half_sign;
  to.c1 = (a21 * arm1 - a11 * arm2) + by_turn * t2;
  to.c2 = (a22 * arm1 - a12 * arm2) - by_turn * t1;
  to.couple = q2 * arm1 - q1 * arm2;
  if constexpr (cayley) {
    const V by_factor = at.z * signed_rate;
    to.t1 -= by_factor * t1;
    to.t2 -= by_factor * t2;
    to.couple -= (by_factor * step.lever) * couple;
  }
  return to;
}

}  // namespace
}  // namespace gnomon::beam::linear
