#pragma once
#include "src/catalogue.hpp"

namespace gnomon::rigid_body_ensemble {

/// Reads `[ensemble]`, `[load]` and `[execution]` of a scene.
ParsedModel read(Section& root, double t_end);

inline constexpr ModelEntry entry{
    .name = "rigid_body_ensemble",
    .summary =
        "rotation of many rigid bodies, drawn at random, that do not act on one another, as a "
        "discrete-element "
        "code has them; loads: none, space_moment, gravity",
    .citation =
        "L. Euler 1765; random numbers after D. Blackman, S. Vigna, ACM Trans. Math. Softw. 47 (2021) 36",
    .read = read,
};

}  // namespace gnomon::rigid_body_ensemble
