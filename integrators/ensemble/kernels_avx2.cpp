// Compiled with options of its own, see CMakeLists.txt.
#ifdef __AVX2__
#include "integrators/ensemble/step.hpp"
#else
#include "integrators/ensemble/kernels.hpp"
#endif

namespace gnomon::ensemble {

#ifdef __AVX2__
const Kernels* avx2_kernels() { return &compiled_kernels; }
#else
const Kernels* avx2_kernels() { return nullptr; }
#endif

}  // namespace gnomon::ensemble
