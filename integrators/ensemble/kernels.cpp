#include "integrators/ensemble/kernels.hpp"

namespace gnomon::ensemble {

const Kernels* kernels(InstructionSet set) {
  return compiled_for<Kernels>(set, baseline_kernels, avx2_kernels, avx512_kernels);
}

}  // namespace gnomon::ensemble
