#pragma once
#include "src/catalogue.hpp"

namespace gnomon::rigid_body {

/// Reads `[body]` and `[load]` of a scene.
ParsedModel read(Section& root, double t_end);

inline constexpr ModelEntry entry{
    .name = "rigid_body",
    .summary =
        "rotation of a rigid body about its centre of mass or a pivot; loads: none, gravity, space_moment, "
        "body_moment",
    .citation =
        "L. Euler 1765; notation of A. Munjiza, The Combined Finite-Discrete Element Method, Wiley 2004, "
        "section 5.6",
    .read = read,
};

}  // namespace gnomon::rigid_body
