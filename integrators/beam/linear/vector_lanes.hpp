#pragma once
// Lanes of the processor's vector registers. Compiled once for each instruction set, see lane_step.hpp.

#include <experimental/simd>

namespace gnomon::beam::linear {
namespace {

namespace stdx = std::experimental;
template <int lanes>
using Lanes = stdx::simd<double, stdx::simd_abi::deduce_t<double, lanes>>;

}  // namespace
}  // namespace gnomon::beam::linear
