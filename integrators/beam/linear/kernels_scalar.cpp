// Compiled with options of its own, see CMakeLists.txt.
#include "integrators/beam/linear/scalar_lanes.hpp"

#include "integrators/beam/linear/lane_step.hpp"

namespace gnomon::beam::linear {

const Kernels& scalar_kernels() {
  static constexpr Kernels kernels{2, step<2, false>, step<2, true>};
  return kernels;
}

}  // namespace gnomon::beam::linear
