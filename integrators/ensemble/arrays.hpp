#pragma once
#include <vector>

#include "integrators/ensemble/bodies.hpp"

namespace gnomon::ensemble {

/// The structure of arrays of some bodies. The last block is filled up with bodies at rest.
class Arrays {
 public:
  explicit Arrays(std::size_t bodies)
      : padded_((bodies + block - 1) / block * block),
        stride_(next_stride(padded_)),
        lines_(field_count * stride_ / line) {
    for (std::size_t i = 0; i < padded_; ++i)
      for (const std::size_t f : {0, 4, 8, 12, 13, 14}) at(static_cast<Field>(f), i) = 1.0;
  }

  double& at(std::size_t field, std::size_t body) { return values()[field * stride_ + body]; }
  double at(std::size_t field, std::size_t body) const {
    return lines_.data()->values[field * stride_ + body];
  }

  /// Part `part` of `parts` of nearly equal size.
  Range range(int part, int parts) {
    const std::size_t blocks = padded_ / block, n = static_cast<std::size_t>(parts);
    const auto bound = [&](int k) { return blocks * static_cast<std::size_t>(k) / n * block; };
    return {values(), stride_, bound(part), bound(part + 1)};
  }

 private:
  static constexpr std::size_t line = 8;
  struct alignas(64) Line {
    double values[line];
  };
  // Not a multiple of 4096 bytes: one body's numbers would compete for the same few places of the cache.
  static std::size_t next_stride(std::size_t padded) {
    constexpr std::size_t page = 512, shift = 48;
    return (padded + page - 1) / page * page + shift;
  }
  double* values() { return lines_.data()->values; }

  std::size_t padded_, stride_;
  std::vector<Line> lines_;
};

}  // namespace gnomon::ensemble
