#include "models/rigid_body/peers/odeint_runs.hpp"

namespace gnomon::rigid_body {

const OdeintRuns* odeint_baseline() { return &odeint_runs; }

}  // namespace gnomon::rigid_body
