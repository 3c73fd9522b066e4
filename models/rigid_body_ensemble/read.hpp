#pragma once
#include <array>

#include "src/catalogue.hpp"

namespace gnomon::rigid_body_ensemble {

/// Reads `[ensemble]`, `[load]` and `[execution]` of a scene.
ParsedModel read(Section& root, double t_end);

/// The kinds of `[load]` that the reader takes.
inline constexpr std::array<std::string_view, 3> load_kinds{"none", "space_moment", "gravity"};

inline constexpr ModelEntry entry{
    .name = "rigid_body_ensemble",
    .summary =
        "rotation of many rigid bodies, drawn at random, that do not act on one another, as a "
        "discrete-element code has them",
    .citation =
        "L. Euler 1765; random numbers after D. Blackman, S. Vigna, ACM Trans. Math. Softw. 47 (2021) 36",
    .read = read,
    .loads = load_kinds,
};

}  // namespace gnomon::rigid_body_ensemble
