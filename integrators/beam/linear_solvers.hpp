#pragma once
#include <vector>

#include "src/catalogue.hpp"

namespace gnomon::beam {

/// One factorisation and solution of the system of an implicit step of a free beam of linear elements, by
/// every solver and for three numbers of elements.
std::vector<PartTask> linear_solver_tasks();

}  // namespace gnomon::beam
