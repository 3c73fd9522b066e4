#pragma once
#include <vector>

#include "src/catalogue.hpp"

namespace gnomon::beam {

/// One run of CVODE's BDF on the flying beam with many linear elements, Newton's systems solved by
/// elimination of the chain's blocks or by GMRES preconditioned with it.
std::vector<PartTask> large_mesh_tasks();

}  // namespace gnomon::beam
