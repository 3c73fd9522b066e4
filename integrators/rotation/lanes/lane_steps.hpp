#pragma once
// One body stepped with eight step counts at once, one a lane. This header is compiled once for each
// instruction set, and everything in it has internal linkage: the linker must not take a function made for
// one set for that of another. For the same reason it uses little of the standard library.

#include <experimental/simd>

#include "integrators/rotation/lanes/kernels.hpp"

namespace gnomon::rotation::lanes {
namespace {

namespace stdx = std::experimental;
using Lanes = stdx::simd<double, stdx::simd_abi::deduce_t<double, count>>;
using HalfOfLanes = stdx::simd<double, stdx::simd_abi::deduce_t<double, count / 2>>;

inline Lanes load(const double* values) { return Lanes(values, stdx::vector_aligned); }

struct NoMoment {
  [[gnu::always_inline]] static void add(const Lanes (&)[3], const Lanes*, const Lanes&, Lanes*) {}
};

/// Adds h times the moment of the weight, centre x R(q)^T (-W e3).
struct GravityMoment {
  [[gnu::always_inline]] static void add(const Lanes (&arm)[3], const Lanes* y, const Lanes& h, Lanes* to) {
    const Lanes h2 = h + h;
    const Lanes g0 = h2 * (y[1] * y[3] - y[0] * y[2]), g1 = h2 * (y[2] * y[3] + y[0] * y[1]),
                g2 = h * ((y[0] * y[0] + y[3] * y[3]) - (y[1] * y[1] + y[2] * y[2]));
    to[0] -= arm[1] * g2 - arm[2] * g1;
    to[1] -= arm[2] * g0 - arm[0] * g2;
    to[2] -= arm[0] * g1 - arm[1] * g0;
  }
};

/// Adds h R(q)^T M.
struct SpaceFixedMoment {
  [[gnu::always_inline]] static void add(const Lanes (&M)[3], const Lanes* y, const Lanes& h, Lanes* to) {
    const Lanes h2 = h + h;
    const Lanes ww = y[0] * y[0], xx = y[1] * y[1], yy = y[2] * y[2], zz = y[3] * y[3];
    const Lanes wx = y[0] * y[1], wy = y[0] * y[2], wz = y[0] * y[3];
    const Lanes xy = y[1] * y[2], xz = y[1] * y[3], yz = y[2] * y[3];
    to[0] += h * ((ww + xx) - (yy + zz)) * M[0] + h2 * ((xy + wz) * M[1] + (xz - wy) * M[2]);
    to[1] += h * ((ww + yy) - (xx + zz)) * M[1] + h2 * ((yz + wx) * M[2] + (xy - wz) * M[0]);
    to[2] += h * ((ww + zz) - (xx + yy)) * M[2] + h2 * ((xz + wy) * M[0] + (yz - wx) * M[1]);
  }
};

struct BodyFixedMoment {
  [[gnu::always_inline]] static void add(const Lanes (&M)[3], const Lanes*, const Lanes& h, Lanes* to) {
    for (int k = 0; k < 3; ++k) to[k] += h * M[k];
  }
};

/// W. B. Gragg, SIAM J. Numer. Anal. 2 (1965) 384: y_(k+1) = y_(k-1) + 2 h f(y_k). The even values alone have
/// an expansion in h^2. A lane that is done goes on with h = 0, which leaves its even values as they are.
template <class Moment>
void midpoint_rows(const Body& body, const Sequence& sequence, const double* y, double H, Rows& rows) {
  const Lanes moment[3] = {body.load[0], body.load[1], body.load[2]};
  Lanes h = H * load(sequence.inverse);
  Lanes turn[3];  // h/2 over the inertia
  for (int k = 0; k < 3; ++k) turn[k] = (0.5 * h) * body.inverse_inertia[k];
  // to += h f(at), f = (1/2 q o (0, I^-1 m), m x I^-1 m + moment)
  const auto advance = [&](Lanes* to, const Lanes* at) {
    const Lanes* m = at + 4;
    const Lanes w0 = turn[0] * m[0], w1 = turn[1] * m[1], w2 = turn[2] * m[2];
    const Lanes m0 = m[0] + m[0], m1 = m[1] + m[1], m2 = m[2] + m[2];
    to[0] -= (at[1] * w0 + at[2] * w1) + at[3] * w2;
    to[1] += (at[0] * w0 + at[2] * w2) - at[3] * w1;
    to[2] += (at[0] * w1 + at[3] * w0) - at[1] * w2;
    to[3] += (at[0] * w2 + at[1] * w1) - at[2] * w0;
    to[4] += m1 * w2 - m2 * w1;
    to[5] += m2 * w0 - m0 * w2;
    to[6] += m0 * w1 - m1 * w0;
    Moment::add(moment, at, h, to + 4);
  };
  Lanes even[7], odd[7];
  for (int c = 0; c < 7; ++c) odd[c] = even[c] = y[c];
  advance(odd, even);
  h += h;
  for (Lanes& each : turn) each += each;
  for (int k = 2;; k += 2) {
    advance(even, odd);
    if (k == sequence.last) break;
    if (k >= sequence.first) {
      const Lanes active = load(sequence.active[k]);
      h *= active;
      for (Lanes& each : turn) each *= active;
    }
    advance(odd, even);
  }
  for (int c = 0; c < 7; ++c) even[c].copy_to(rows.value[c], stdx::vector_aligned);
}

/// cos x and sin x / x by the square of x: to 1e-17 up to x = 1.5, to 1e-12 up to 2.5; even functions of x
/// always.
struct HalfTurn {
  Lanes cosine, sinc;
};
inline HalfTurn half_turn(const Lanes& s) {
  const Lanes s2 = s * s, s4 = s2 * s2, s8 = s4 * s4;
  const auto sum = [&](const double(&c)[11]) {
    const Lanes low = (c[0] + c[1] * s) + (c[2] + c[3] * s) * s2;
    const Lanes high = (c[4] + c[5] * s) + (c[6] + c[7] * s) * s2;
    return (low + high * s4) + ((c[8] + c[9] * s) + c[10] * s2) * s8;
  };
  static constexpr double cosine[11] = {1.0,
                                        -1.0 / 2,
                                        1.0 / 24,
                                        -1.0 / 720,
                                        1.0 / 40320,
                                        -1.0 / 3628800,
                                        1.0 / 479001600,
                                        -1.0 / 87178291200,
                                        1.0 / 20922789888000,
                                        -1.0 / 6402373705728000,
                                        1.0 / 2432902008176640000};
  static constexpr double sinc[11] = {1.0,
                                      -1.0 / 6,
                                      1.0 / 120,
                                      -1.0 / 5040,
                                      1.0 / 362880,
                                      -1.0 / 39916800,
                                      1.0 / 6227020800,
                                      -1.0 / 1307674368000,
                                      1.0 / 355687428096000,
                                      -1.0 / 121645100408832000,
                                      1.0 / 51090942171709440000.0};
  return {sum(cosine), sum(sinc)};
}

/// Half kick, drifts with kicks between, half kick. A drift turns the body by h H/I1 about the momentum; the
/// turn about its own axis commutes with everything and is left out. The moment is that of the weight at the
/// axis n = R(q) e3: -W l n x e3.
inline void strang_rows(const Top& top, const Sequence& sequence, const double* y, double H, Rows& rows) {
  Lanes h = H * load(sequence.inverse);
  Lanes angle = top.half_inverse_inertia * h, kick = top.moment * h;
  Lanes w = y[0], i = y[1], j = y[2], k = y[3], L0 = y[4], L1 = y[5];
  const Lanes L2 = y[6], square2 = y[6] * y[6];
  const auto push = [&](const Lanes& impulse) {  // W l h, of half the axis
    L0 -= impulse * (j * k - w * i);
    L1 += impulse * (i * k + w * j);
  };
  push(kick);
  kick += kick;
  for (int n = 1;; ++n) {
    const HalfTurn turn = half_turn(((L0 * L0 + L1 * L1) + square2) * (angle * angle));
    const Lanes factor = turn.sinc * angle;
    const Lanes a = factor * L0, b = factor * L1, c = factor * L2;
    const Lanes w1 = (turn.cosine * w - a * i) - (b * j + c * k);
    const Lanes i1 = (turn.cosine * i + a * w) + (b * k - c * j);
    const Lanes j1 = (turn.cosine * j + b * w) + (c * i - a * k);
    const Lanes k1 = (turn.cosine * k + c * w) + (a * j - b * i);
    w = w1, i = i1, j = j1, k = k1;
    if (n == sequence.last) break;
    if (n < sequence.first) {
      push(kick);
      continue;
    }
    // A lane that is done gets its last half kick, then nothing.
    const Lanes active = load(sequence.active[n]);
    push(0.5 * kick * (load(sequence.active[n - 1]) + active));
    angle *= active;
  }
  push(0.5 * kick * load(sequence.active[sequence.last - 1]));
  const Lanes values[7] = {w, i, j, k, L0, L1, L2};
  for (int c = 0; c < 7; ++c) values[c].copy_to(rows.value[c], stdx::vector_aligned);
}

/// The sum of the lanes, in the same order whatever the instruction set.
inline double total(const Lanes& lanes) {
  alignas(64) double all[count], half[count / 2];
  lanes.copy_to(all, stdx::vector_aligned);
  const HalfOfLanes sum =
      HalfOfLanes(all, stdx::vector_aligned) + HalfOfLanes(all + count / 2, stdx::vector_aligned);
  sum.copy_to(half, stdx::vector_aligned);
  return (half[0] + half[2]) + (half[1] + half[3]);
}

inline void extrapolate(const Sequence& sequence, const double* y, const Rows& rows, Extrapolated& result) {
  const Lanes weight = load(sequence.weight), defect = load(sequence.defect_weight);
  for (int c = 0; c < 7; ++c) {
    const Lanes increment = load(rows.value[c]) - y[c];
    result.value[c] = y[c] + total(weight * increment);
    result.defect[c] = total(defect * increment);
  }
}

inline constexpr Kernels compiled_kernels{midpoint_rows<NoMoment>,
                                          midpoint_rows<GravityMoment>,
                                          midpoint_rows<SpaceFixedMoment>,
                                          midpoint_rows<BodyFixedMoment>,
                                          strang_rows,
                                          extrapolate};

}  // namespace
}  // namespace gnomon::rotation::lanes
