#include "integrators/rotation/lanes/kernels.hpp"

namespace gnomon::rotation::lanes {

const Kernels* kernels(InstructionSet set) {
  return compiled_for<Kernels>(set, baseline_kernels, avx2_kernels, avx512_kernels);
}

const Kernels& widest_kernels() {
  for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2})
    if (const Kernels* found = kernels(set)) return *found;
  return *baseline_kernels();
}

}  // namespace gnomon::rotation::lanes
