#include "integrators/rotation/lanes/kernels.hpp"

#include <algorithm>

namespace gnomon::rotation::lanes {

const Kernels* kernels(InstructionSet set) {
  const auto& sets = instruction_sets();
  if (std::find(sets.begin(), sets.end(), set) == sets.end()) return nullptr;
  switch (set) {
    case InstructionSet::baseline:
      return baseline_kernels();
    case InstructionSet::avx2:
      return avx2_kernels();
    case InstructionSet::avx512:
      return avx512_kernels();
  }
  return nullptr;
}

const Kernels& widest_kernels() {
  for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2})
    if (const Kernels* found = kernels(set)) return *found;
  return *baseline_kernels();
}

}  // namespace gnomon::rotation::lanes
