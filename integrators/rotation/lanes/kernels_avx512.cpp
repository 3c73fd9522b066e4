// Compiled with options of its own, see CMakeLists.txt.
#ifdef __AVX512F__
#include "integrators/rotation/lanes/lane_steps.hpp"
#else
#include "integrators/rotation/lanes/kernels.hpp"
#endif

namespace gnomon::rotation::lanes {

#ifdef __AVX512F__
const Kernels* avx512_kernels() { return &compiled_kernels; }
#else
const Kernels* avx512_kernels() { return nullptr; }
#endif

}  // namespace gnomon::rotation::lanes
