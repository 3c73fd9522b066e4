#pragma once
#include <algorithm>
#include <vector>

#include "models/planar_beam/element.hpp"
#include "models/planar_beam/numbering.hpp"

namespace gnomon::planar_beam {

/// The consistent mass matrix of one unknown a node for unit density, int P_i P_j dx, as a band with its
/// Cholesky factor. Nodes that a support holds are taken out: their rows are those of the unit matrix.
/// `joined`: the two nodes of a hinge are one, as they are for displacements.
template <int p>
class MassBand {
 public:
  MassBand() = default;
  MassBand(const Element<p>& element, const Numbering& numbering, bool joined, bool first_held,
           bool last_held)
      : size_(joined ? numbering.elements() * p + 1 : numbering.unknowns() / 3),
        lower_(static_cast<std::size_t>(size_) * width, 0.0) {
    for (int e = 0; e < numbering.elements(); ++e) {
      const int first = joined ? e * p : numbering.first(e) / 3;
      for (int a = 0; a <= p; ++a)
        for (int b = 0; b <= a; ++b) entry(first + a, first + b) += element.mass[a][b];
    }
    if (first_held) hold(0);
    if (last_held) hold(size_ - 1);
    for (int i = 0; i < size_; ++i)
      for (int j = std::max(0, i - p); j <= i; ++j) {
        double sum = entry(i, j);
        for (int k = std::max(0, i - p); k < j; ++k) sum -= entry(i, k) * entry(j, k);
        // The diagonal is kept as its reciprocal.
        entry(i, j) = i == j ? 1.0 / std::sqrt(sum) : sum * entry(j, j);
      }
  }

  /// Solves for one right-hand side, x at values[index[0]], values[index[1]], ...
  void solve(const std::vector<int>& index, double* values) const {
    for (int i = 0; i < size_; ++i) {
      double sum = values[index[i]];
      for (int k = std::max(0, i - p); k < i; ++k) sum -= entry(i, k) * values[index[k]];
      values[index[i]] = sum * entry(i, i);
    }
    for (int i = size_ - 1; i >= 0; --i) {
      double sum = values[index[i]];
      for (int k = i + 1; k <= std::min(size_ - 1, i + p); ++k) sum -= entry(k, i) * values[index[k]];
      values[index[i]] = sum * entry(i, i);
    }
  }

  /// Without hinges. Solves for three right-hand sides at once, x, z and rotation of one node after the
  /// other, each with a factor of its own, which may be the same: they do not wait for each other.
  static void solve(const MassBand& first, const MassBand& second, const MassBand& third, double* values) {
    const int n = first.size_;
    const double *K = first.lower_.data(), *L = second.lower_.data(), *M = third.lower_.data();
    for (int i = 0; i < n; ++i) {
      double* x = values + 3 * i;
      const std::size_t at = static_cast<std::size_t>(i) * width;
      for (int d = std::min(i, p); d >= 1; --d) {
        const double k = K[at + d], l = L[at + d], m = M[at + d];
        const double* other = x - 3 * d;
        x[0] -= k * other[0];
        x[1] -= l * other[1];
        x[2] -= m * other[2];
      }
      x[0] *= K[at];
      x[1] *= L[at];
      x[2] *= M[at];
    }
    for (int i = n - 1; i >= 0; --i) {
      double* x = values + 3 * i;
      for (int d = 1; d <= std::min(n - 1 - i, p); ++d) {
        const std::size_t at = static_cast<std::size_t>(i + d) * width + d;
        const double k = K[at], l = L[at], m = M[at];
        const double* other = x + 3 * d;
        x[0] -= k * other[0];
        x[1] -= l * other[1];
        x[2] -= m * other[2];
      }
      const std::size_t at = static_cast<std::size_t>(i) * width;
      x[0] *= K[at];
      x[1] *= L[at];
      x[2] *= M[at];
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
