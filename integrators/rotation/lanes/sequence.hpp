#pragma once
#include <array>

#include "integrators/rotation/lanes/kernels.hpp"

namespace gnomon::rotation::lanes {

/// The sequence of the given step counts, ascending, > 0 and < most_steps, with its weights: the value at h =
/// 0 of the polynomial in h^2 through all points h = H/n, by Lagrange (the limit of the Aitken-Neville
/// table).
constexpr Sequence sequence_of(const std::array<int, count>& steps) {
  Sequence sequence{};
  const auto weight = [&](int j, int rows) {
    double product = 1.0;
    for (int i = 0; i < rows; ++i)
      if (i != j) {
        const double a = steps[static_cast<std::size_t>(j)], b = steps[static_cast<std::size_t>(i)];
        product *= a * a / (a * a - b * b);
      }
    return product;
  };
  for (int j = 0; j < count; ++j) {
    sequence.steps[j] = steps[static_cast<std::size_t>(j)];
    sequence.inverse[j] = 1.0 / sequence.steps[j];
    for (int k = 0; k < most_steps; ++k) sequence.active[k][j] = k < sequence.steps[j] ? 1.0 : 0.0;
    sequence.weight[j] = weight(j, count);
    sequence.defect_weight[j] = sequence.weight[j] - (j < count - 1 ? weight(j, count - 1) : 0.0);
  }
  sequence.first = steps.front();
  sequence.last = steps.back();
  return sequence;
}

/// Evaluations of the rates that one step of all lanes makes.
constexpr long evaluations(const Sequence& sequence) {
  double sum = 0.0;
  for (double steps : sequence.steps) sum += steps;
  return static_cast<long>(sum);
}

}  // namespace gnomon::rotation::lanes
