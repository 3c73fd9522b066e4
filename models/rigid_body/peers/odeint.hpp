#pragma once

namespace gnomon::rigid_body {

/// A rigid body as a user of Boost.odeint would write it down.
struct PlainBody {
  double inverse_inertia[3];   ///< of the principal moments, 1/(kg m^2)
  double weight_times_arm[3];  ///< weight times its point in the body, N m; 0 for a free body
  bool heavy;
};

/// Integrates y = (q, m), q (w, x, y, z) the orientation, m the body angular momentum, from 0 to t_end with
/// the tolerance both relative and absolute. Returns thread CPU seconds of the integration, negative if it
/// failed.
using PlainRun = double (*)(const PlainBody& body, double* y, double t_end, double tol, long& evaluations);

/// The controlled steppers of Boost.odeint compiled for one instruction set, fused multiply-add included
/// where it has it, as its users would compile them.
struct OdeintRuns {
  PlainRun bulirsch_stoer;
  PlainRun fehlberg78;
};

// One object file each; null where it was not compiled for the set it is named after.
const OdeintRuns* odeint_baseline();
const OdeintRuns* odeint_avx2();
const OdeintRuns* odeint_avx512();

}  // namespace gnomon::rigid_body
