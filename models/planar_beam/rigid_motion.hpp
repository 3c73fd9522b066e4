#pragma once
#include <array>
#include <vector>

#include "models/planar_beam/data.hpp"
#include "models/planar_beam/numbering.hpp"

namespace gnomon::planar_beam {

/// Whether supports, hinges and springs hinder every infinitesimal rigid motion of the pieces between hinges.
/// `positions` of the nodes at rest and the `centre` of mass, m.
bool is_held_rigidly(const Data& data, const Numbering& numbering, const std::vector<double>& positions,
                     const std::array<double, 2>& centre);

}  // namespace gnomon::planar_beam
