#pragma once
#include <string_view>

#include "src/instruction_set.hpp"

namespace gnomon::beam::linear {

/// A straight or curved beam of equal linear elements with one integration point each.
struct Beam {
  int elements;
  double element_length, length;   ///< m
  double EA, GA, EI, rhoA, rhoI;   ///< as in planar_beam::CrossSection
  bool held[2][3];                 ///< unknowns of the first and of the last node that supports hold
  double tolerance;                ///< of the residual, relative to the largest of its three parts
  double force_floor, mass_floor;  ///< roundoff of the residual: F + M |2/h| |v|
};

/// The beam cut into as many substructures of consecutive elements as there are lanes, an even number: `full`
/// elements each and one more in the first `extra` lanes. Even lanes run from the start of the beam to its
/// middle, odd ones from its end to the middle. Local node 0 of a lane is the one it begins with, local node
/// `rows()` the last, also where the lane is shorter by one: there its last two local nodes are the same.
struct Layout {
  int lanes, full, extra;

  int elements() const { return lanes * full + extra; }
  int rows() const { return full + (extra > 0 ? 1 : 0); }
  int count(int lane) const { return full + (lane < extra ? 1 : 0); }
  /// Elements between the beam's end on its side and a lane.
  int before(int lane) const {
    const int others = lane / 2, longer = lane % 2 == 0 ? (extra + 1) / 2 : extra / 2;
    return others * full + (others < longer ? others : longer);
  }
  /// The beam's node that is local node i of a lane, and the element between local nodes i and i + 1.
  int node(int lane, int i) const {
    const int local = before(lane) + (i < count(lane) ? i : count(lane));
    return lane % 2 == 0 ? local : elements() - local;
  }
  int element(int lane, int i) const {
    const int local = before(lane) + i;
    return lane % 2 == 0 ? local : elements() - 1 - local;
  }
};

/// Numbers of one local node or element: component by component, in each the lanes side by side.
inline constexpr int node_components = 3;     ///< x, z, rotation
inline constexpr int element_components = 9;  ///< d1, d2, cos, sin, g1, g2, bending; 2 e1, 2 e2
inline constexpr int block_components = 21;   ///< what elimination leaves behind at a node

/// All of them aligned to 64 bytes. `mean` is where the extrapolation of the means of the last steps goes; it
/// may be that of the step before the last two.
struct Arrays {
  double *u, *v, *mean;
  const double *past0, *past1, *past2;
  const double* external;
  double *elements, *blocks;
};

/// Where Newton's iteration starts: v_n, or the mean velocities of the last one, two or three steps
/// extrapolated as a constant, by a line or by a parabola. The parabola is best while all modes of the mesh
/// are resolved, the constant, which amplifies nothing, where stiff ones oscillate from step to step.
enum class Start { velocity, constant, line, parabola };

struct StepInput {
  double h;
  Start start;
  bool compare;          ///< whether a poor start is compared with the constant
  double imposed[2][3];  ///< mean velocities of held unknowns
  double curvature;      ///< of late: |r| after a correction x of the mean velocities over |h x|^2, or < 0
};

struct StepResult {
  bool solved;                           ///< else u, v and the elements are as before
  bool constant_better, constant_worse;  ///< as a start, where both have been tried
  int evaluations, iterations;
  double curvature;
};

/// One step of the implicit midpoint scheme, all in one: start, Newton's iteration, end.
using StepFunction = StepResult (*)(const Beam& beam, const Layout& layout, const Arrays& arrays,
                                    const StepInput& input);

/// The same functions compiled for one instruction set.
struct Kernels {
  int lanes;
  StepFunction documented, cayley;
};

/// Substructures in lanes; null if this machine does not have that set or the program holds none for it.
const Kernels* kernels(InstructionSet set);
/// Two lanes that meet in the middle: no wider registers than every machine has, and no more arithmetic than
/// one after the other.
const Kernels& paired_kernels();
/// The same two lanes without any vector instructions.
const Kernels& scalar_kernels();
/// By "scalar" or the name of an InstructionSet; null as in `kernels`. "baseline" are the paired ones.
const Kernels* kernels_named(std::string_view name);
/// The ones for a beam of that many elements on this machine; null where there are too few elements.
const Kernels* fitting_kernels(int elements);

// One object file each; null where it was not compiled for the set it is named after.
const Kernels* baseline_kernels();
const Kernels* avx2_kernels();
const Kernels* avx512_kernels();

}  // namespace gnomon::beam::linear
