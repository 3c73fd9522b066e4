#include "integrators/ensemble/kernels.hpp"

#include <algorithm>

namespace gnomon::ensemble {

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

}  // namespace gnomon::ensemble
