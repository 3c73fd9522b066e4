#pragma once
#include "src/catalogue.hpp"

namespace gnomon::rotation {

/// The documented scheme on a free body written by hand, without vectors, matrices or models: what the step
/// of `munjiza` is held against.
extern const Yardstick munjiza_kernel_yardstick;

}  // namespace gnomon::rotation
