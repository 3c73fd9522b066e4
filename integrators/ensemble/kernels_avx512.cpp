// Compiled with options of its own, see CMakeLists.txt.
#ifdef __AVX512F__
#include "integrators/ensemble/step.hpp"
#else
#include "integrators/ensemble/kernels.hpp"
#endif

namespace gnomon::ensemble {

#ifdef __AVX512F__
const Kernels* avx512_kernels() { return &compiled_kernels; }
#else
const Kernels* avx512_kernels() { return nullptr; }
#endif

}  // namespace gnomon::ensemble
