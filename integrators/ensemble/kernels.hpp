#pragma once
#include <array>
#include <stdexcept>
#include <string_view>

#include "integrators/ensemble/bodies.hpp"
#include "src/instruction_set.hpp"

namespace gnomon::ensemble {

enum class Scheme { munjiza, rkmk4 };

/// What loads the bodies, and what the fields from Field::load on then are.
enum class Load {
  none,
  space_moment,  ///< a moment that is constant in space [N m], in space components
  gravity        ///< weight times the body point it acts at [N m], in body components; along -z of space
};

/// The load that a model calls by that name. Throws std::invalid_argument if there is none.
constexpr Load load_named(std::string_view name) {
  if (name == "none") return Load::none;
  if (name == "space_moment") return Load::space_moment;
  if (name == "gravity") return Load::gravity;
  throw std::invalid_argument("ensembles know no such load");
}

/// Takes the bodies of a range through one step of h [s]; no two of them act on one another. Results do not
/// depend on the instruction set, not even in the last bit.
using Step = void (*)(const Range& range, double h);

/// The steps by scheme and load, compiled for one instruction set.
struct Kernels {
  using Row = std::array<Step, 3>;
  std::array<Row, 2> steps;
};

/// Null if the program holds none for that set or this machine does not have it.
const Kernels* kernels(InstructionSet set);

inline Step find_step(const Kernels& kernels, Scheme scheme, Load load) {
  return kernels.steps[static_cast<std::size_t>(scheme)][static_cast<std::size_t>(load)];
}

// One object file each; null where it was not compiled for the set it is named after.
const Kernels* baseline_kernels();
const Kernels* avx2_kernels();
const Kernels* avx512_kernels();

}  // namespace gnomon::ensemble
