#pragma once
#include <cstddef>

namespace gnomon::ensemble {

/// The numbers of a body. Each is an array over the bodies of a block.
enum Field : std::size_t {
  attitude = 0,          ///< A (body -> space) row by row, 9 fields
  momentum = 9,          ///< y = A^T H, the angular momentum in the body triad [kg m^2/s], 3 fields
  inverse_inertia = 12,  ///< principal, in the body triad [1/(kg m^2)], 3 fields
  load = 15,             ///< what the load needs to know of a body, 3 fields
  field_count = 18
};

/// The number of bodies comes in multiples of this, whatever the instruction set, so that no set of lanes is
/// broken and no two threads write to one cache line.
inline constexpr std::size_t block = 16;
inline constexpr std::size_t block_values = field_count * block;

/// Where the number of a body is: the fields of a block of bodies one after the other, then the next block.
/// A sweep over the bodies so reads memory from its beginning to its end. With one array of all bodies a
/// field, the 18 arrays compete for places in the cache, and where their pages lie decides the speed.
constexpr std::size_t place(std::size_t field, std::size_t body) {
  return body / block * block_values + field * block + body % block;
}

/// Some of the bodies of a structure of arrays. `values` is aligned to 64 bytes; begin and end are multiples
/// of the block.
struct Range {
  double* values;
  std::size_t begin, end;
};

}  // namespace gnomon::ensemble
