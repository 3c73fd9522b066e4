#pragma once
#include <algorithm>
#include <vector>

#include "models/planar_beam/element.hpp"

namespace gnomon::planar_beam {

/// The consistent mass matrix of one unknown a node for unit density, int P_i P_j dx, as a band with its
/// Cholesky factor. Nodes that a support holds are taken out: their rows are those of the unit matrix.
template <int p>
class MassBand {
 public:
  MassBand() = default;
  MassBand(const Element<p>& element, int elements, bool first_held, bool last_held)
      : size_(elements * p + 1), lower_(static_cast<std::size_t>(size_) * width, 0.0) {
    for (int e = 0; e < elements; ++e)
      for (int a = 0; a <= p; ++a)
        for (int b = 0; b <= a; ++b) entry(e * p + a, e * p + b) += element.mass[a][b];
    if (first_held) hold(0);
    if (last_held) hold(size_ - 1);
    for (int i = 0; i < size_; ++i)
      for (int j = std::max(0, i - p); j <= i; ++j) {
        double sum = entry(i, j);
        for (int k = std::max(0, i - p); k < j; ++k) sum -= entry(i, k) * entry(j, k);
        entry(i, j) = i == j ? std::sqrt(sum) : sum / entry(j, j);
      }
  }

  /// Solves in place for values[0], values[3], values[6], ..
  void solve(double* values) const {
    for (int i = 0; i < size_; ++i) {
      double sum = values[3 * i];
      for (int k = std::max(0, i - p); k < i; ++k) sum -= entry(i, k) * values[3 * k];
      values[3 * i] = sum / entry(i, i);
    }
    for (int i = size_ - 1; i >= 0; --i) {
      double sum = values[3 * i];
      for (int k = i + 1; k <= std::min(size_ - 1, i + p); ++k) sum -= entry(k, i) * values[3 * k];
      values[3 * i] = sum / entry(i, i);
    }
  }

 private:
  static constexpr int width = p + 1;
  double& entry(int i, int j) { return lower_[static_cast<std::size_t>(i) * width + (i - j)]; }
  double entry(int i, int j) const { return lower_[static_cast<std::size_t>(i) * width + (i - j)]; }
  void hold(int i) {
    for (int k = std::max(0, i - p); k <= i; ++k) entry(i, k) = 0.0;
    for (int k = i + 1; k <= std::min(size_ - 1, i + p); ++k) entry(k, i) = 0.0;
    entry(i, i) = 1.0;
  }
  int size_ = 0;
  std::vector<double> lower_;
};

}  // namespace gnomon::planar_beam
