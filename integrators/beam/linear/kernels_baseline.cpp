#include "integrators/beam/linear/vector_lanes.hpp"

#include "integrators/beam/linear/lane_step.hpp"

namespace gnomon::beam::linear {

const Kernels& paired_kernels() {
  static constexpr Kernels kernels{2, step<2, false>, step<2, true>};
  return kernels;
}
// Substructures need more arithmetic, which lanes of two numbers do not save.
const Kernels* baseline_kernels() { return nullptr; }

}  // namespace gnomon::beam::linear
