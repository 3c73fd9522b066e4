// Compiled with options of its own, see CMakeLists.txt.
#ifdef __AVX2__
#include "integrators/beam/linear/vector_lanes.hpp"

#include "integrators/beam/linear/lane_step.hpp"
#else
#include "integrators/beam/linear/kernels.hpp"
#endif

namespace gnomon::beam::linear {

#ifdef __AVX2__
const Kernels* avx2_kernels() {
  static constexpr Kernels kernels{4, step<4, false>, step<4, true>};
  return &kernels;
}
#else
const Kernels* avx2_kernels() { return nullptr; }
#endif

}  // namespace gnomon::beam::linear
