#pragma once
#include <string_view>
#include <vector>

namespace gnomon {

/// The vector instructions that a function was compiled for.
enum class InstructionSet {
  baseline,  ///< what the whole program is compiled for; SSE2 on x86-64 unless it is told otherwise
  avx2,      ///< AVX2, with FMA at hand though results do not use it
  avx512     ///< AVX-512 F, DQ, VL and BW
};

constexpr std::string_view to_string(InstructionSet set) {
  switch (set) {
    case InstructionSet::baseline:
      return "baseline";
    case InstructionSet::avx2:
      return "avx2";
    case InstructionSet::avx512:
      return "avx512";
  }
  return "";
}

/// The sets that this machine has, the widest last.
const std::vector<InstructionSet>& instruction_sets();
bool has_instructions(InstructionSet set);

/// What was compiled for a set: `baseline`, `avx2` or `avx512`, functions that give a pointer; null if this
/// machine does not have it.
template <class Compiled>
const Compiled* compiled_for(InstructionSet set, const Compiled* (*baseline)(), const Compiled* (*avx2)(),
                             const Compiled* (*avx512)()) {
  if (!has_instructions(set)) return nullptr;
  switch (set) {
    case InstructionSet::baseline:
      return baseline();
    case InstructionSet::avx2:
      return avx2();
    case InstructionSet::avx512:
      return avx512();
  }
  return nullptr;
}

}  // namespace gnomon
