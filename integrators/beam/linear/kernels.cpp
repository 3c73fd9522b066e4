#include "integrators/beam/linear/kernels.hpp"

namespace gnomon::beam::linear {

const Kernels* kernels(InstructionSet set) {
  return compiled_for<Kernels>(set, baseline_kernels, avx2_kernels, avx512_kernels);
}

const Kernels* kernels_named(std::string_view name) {
  if (name == "scalar") return &scalar_kernels();
  if (name == to_string(InstructionSet::baseline)) return &paired_kernels();
  for (const InstructionSet set : instruction_sets())
    if (name == to_string(set)) return kernels(set);
  return nullptr;
}

const Kernels* fitting_kernels(int elements) {
  for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2})
    if (const Kernels* found = kernels(set); found && elements >= (found->lanes > 4 ? 1 : 3) * found->lanes)
      return found;
  return elements >= 2 ? &paired_kernels() : nullptr;
}

}  // namespace gnomon::beam::linear
