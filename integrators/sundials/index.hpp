#pragma once
#include "src/ode.hpp"

namespace gnomon::sundials {

/// Whether F(t, y, y') = 0 has an index of 2 or more at its start, judged by the limit of Newton's matrix
/// dF/dy + cj dF/dy' as the step tends to 0 (cj to infinity), its rows of differential equations divided by
/// cj: that has the rows of dF/dy' and, where these vanish, those of dF/dy. It is regular where the index is
/// 0 or 1, and singular where it is higher or where constraints do not stand as equations of their own
/// (E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, sections VI.1 and VII.1). The cost is
/// that of a sparse factorisation.
bool index_exceeds_one(const DaeSystem& system);

}  // namespace gnomon::sundials
