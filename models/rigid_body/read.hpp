#pragma once
#include <array>

#include "src/catalogue.hpp"

namespace gnomon::rigid_body {

/// Reads `[body]` and `[load]` of a scene.
ParsedModel read(Section& root, double t_end);

/// The kinds of `[load]` that the reader takes.
inline constexpr std::array<std::string_view, 5> load_kinds{"none", "gravity", "space_moment", "body_moment",
                                                            "attitude_potential"};

inline constexpr ModelEntry entry{
    .name = "rigid_body",
    .summary = "rotation of a rigid body about its centre of mass or a pivot",
    .citation =
        "L. Euler 1765; notation of A. Munjiza, The Combined Finite-Discrete Element Method, Wiley 2004, "
        "section 5.6",
    .read = read,
    .loads = load_kinds,
};

}  // namespace gnomon::rigid_body
