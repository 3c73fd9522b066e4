// Compiled with options of its own, see CMakeLists.txt.
#ifdef __AVX512F__
#include "integrators/beam/linear/vector_lanes.hpp"

#include "integrators/beam/linear/lane_step.hpp"
#else
#include "integrators/beam/linear/kernels.hpp"
#endif

namespace gnomon::beam::linear {

#ifdef __AVX512F__
const Kernels* avx512_kernels() {
  static constexpr Kernels kernels{8, step<8, false>, step<8, true>};
  return &kernels;
}
#else
const Kernels* avx512_kernels() { return nullptr; }
#endif

}  // namespace gnomon::beam::linear
