// Compiled with options of its own, see CMakeLists.txt.
#ifdef __AVX2__
#include "integrators/rotation/lanes/lane_steps.hpp"
#else
#include "integrators/rotation/lanes/kernels.hpp"
#endif

namespace gnomon::rotation::lanes {

#ifdef __AVX2__
const Kernels* avx2_kernels() { return &compiled_kernels; }
#else
const Kernels* avx2_kernels() { return nullptr; }
#endif

}  // namespace gnomon::rotation::lanes
