#include "integrators/rotation/lanes/lane_steps.hpp"

namespace gnomon::rotation::lanes {

const Kernels* baseline_kernels() { return &compiled_kernels; }

}  // namespace gnomon::rotation::lanes
