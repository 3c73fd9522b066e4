#pragma once
#include <array>
#include <string_view>

#include "src/catalogue.hpp"

namespace gnomon::planar_beam {

/// Reads `[beam]`, `[initial]`, `[supports]` and `[[loads]]` of a scene.
ParsedModel read(Section& root, double t_end);

inline constexpr std::array<std::string_view, 1> mesh_keys{"beam.elements"};

inline constexpr ModelEntry entry{
    .name = "planar_beam",
    .summary =
        "planar geometrically exact beam: elements of order 1 to 4, bends, hinges, supports, loads, statics",
    .citation =
        "E. Reissner, ZAMP 23 (1972) 795-804; J.C. Simo, L. Vu-Quoc, J. Appl. Mech. 53 (1986) 849-863; "
        "notation "
        "of E. and D. Zupan, Nonlinear Dynamics 95 (2019) 1379-1394",
    .read = read,
    .mesh = mesh_keys,
};

}  // namespace gnomon::planar_beam
