// Compiled with options of its own, see CMakeLists.txt.
#include "models/rigid_body/peers/odeint.hpp"
#ifdef __AVX512F__
#include "models/rigid_body/peers/odeint_runs.hpp"
#endif

namespace gnomon::rigid_body {

const OdeintRuns* odeint_avx512() {
#ifdef __AVX512F__
  return &odeint_runs;
#else
  return nullptr;
#endif
}

}  // namespace gnomon::rigid_body
