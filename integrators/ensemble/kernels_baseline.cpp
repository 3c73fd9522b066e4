#include "integrators/ensemble/step.hpp"

namespace gnomon::ensemble {

const Kernels* baseline_kernels() { return &compiled_kernels; }

}  // namespace gnomon::ensemble
