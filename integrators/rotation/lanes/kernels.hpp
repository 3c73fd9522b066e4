#pragma once
#include "src/instruction_set.hpp"

namespace gnomon::rotation::lanes {

/// Number of step counts that are run side by side, one a lane.
inline constexpr int count = 8;
/// Step counts are less than this.
inline constexpr int most_steps = 32;

/// The step counts of a step H, ascending; their inverses; and the weights, by powers of (H/n)^2, of the
/// value extrapolated from all counts and of its difference from the one that leaves the last count out.
struct alignas(64) Sequence {
  double steps[count];
  double inverse[count];
  double weight[count];
  double defect_weight[count];
  double active[most_steps][count];  ///< 1 where a lane has more steps than that, else 0
  int first, last;                   // the least and the greatest count
};

/// One body with its load.
struct Body {
  double inverse_inertia[3];  ///< of the principal moments, 1/(kg m^2)
  double load[3];             ///< gravity: weight times centre, body components; moments: as they are; N m
};

/// A body with two equal moments whose weight acts on its axis, in axes of which the third is that axis.
struct Top {
  double half_inverse_inertia;  ///< 1/(2 I1), 1/(kg m^2)
  double moment;                ///< weight times distance, N m, positive where the centre is on the axis
};

/// What eight step counts give for one step: component by lane.
struct alignas(64) Rows {
  double value[7][count];
};

/// From the state y at the start of a step H and what the step counts make of it: the extrapolated state and
/// its difference from the column before.
struct Extrapolated {
  double value[7];
  double defect[7];
};

/// y = (w, x, y, z, m1, m2, m3), orientation (body -> space) and body momentum, by the explicit midpoint rule
/// with an Euler start. All step counts are even.
using MidpointRows = void (*)(const Body& body, const Sequence& sequence, const double* y, double H,
                              Rows& rows);
/// y = (w, x, y, z, H1, H2, H3), the orientation without the turn about the axis, and the momentum in space,
/// by kicks and drifts in Strang's order.
using StrangRows = void (*)(const Top& top, const Sequence& sequence, const double* y, double H, Rows& rows);
using Extrapolate = void (*)(const Sequence& sequence, const double* y, const Rows& rows,
                             Extrapolated& result);

/// The same functions compiled for one instruction set; all sets give the same bits.
struct Kernels {
  MidpointRows free, gravity, space_moment, body_moment;
  StrangRows strang;
  Extrapolate extrapolate;
};

/// Null if the program holds none for that set or this machine does not have it.
const Kernels* kernels(InstructionSet set);
/// Those for the widest registers.
const Kernels& widest_kernels();

// One object file each; null where it was not compiled for the set it is named after.
const Kernels* baseline_kernels();
const Kernels* avx2_kernels();
const Kernels* avx512_kernels();

}  // namespace gnomon::rotation::lanes
