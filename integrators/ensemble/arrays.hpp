#pragma once
#include <vector>

#include "integrators/ensemble/bodies.hpp"

namespace gnomon::ensemble {

/// The numbers of some bodies. The last block is filled up with bodies at rest.
class Arrays {
 public:
  explicit Arrays(std::size_t bodies)
      : blocks_((bodies + block - 1) / block), lines_(blocks_ * block_values / line) {
    for (std::size_t i = 0; i < blocks_ * block; ++i)
      for (const std::size_t f : {0, 4, 8, 12, 13, 14}) at(f, i) = 1.0;
  }

  double& at(std::size_t field, std::size_t body) { return values()[place(field, body)]; }
  double at(std::size_t field, std::size_t body) const { return lines_.data()->values[place(field, body)]; }

  /// Part `part` of `parts` of nearly equal size.
  Range range(int part, int parts) {
    const std::size_t n = static_cast<std::size_t>(parts);
    const auto bound = [&](int k) { return blocks_ * static_cast<std::size_t>(k) / n * block; };
    return {values(), bound(part), bound(part + 1)};
  }

 private:
  static constexpr std::size_t line = 8;
  struct alignas(64) Line {
    double values[line];
  };
  double* values() { return lines_.data()->values; }

  std::size_t blocks_;
  std::vector<Line> lines_;
};

}  // namespace gnomon::ensemble
