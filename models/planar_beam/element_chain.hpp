#pragma once
#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "models/planar_beam/block_tridiagonal.hpp"

namespace gnomon::planar_beam {

/// The linear system of a chain of elements of order p with three unknowns a node. The inner nodes of each
/// element are eliminated within it (static condensation), the end nodes remain as a block tridiagonal
/// system: the cost is linear in the number of elements. No function but the constructor allocates. Compiled
/// once, in element_chain.cpp.
template <int p>
class ElementChain {
 public:
  static constexpr int inner = 3 * (p - 1);
  using Matrix = Eigen::Matrix<double, 3 * (p + 1), 3 * (p + 1)>;

  /// `held` are unknowns of the first and last node that stay 0.
  ElementChain(int elements, std::vector<int> held);

  /// Adds the matrix of element e, its unknowns node by node. Before `factorise` once for each element, from
  /// the first to the last.
  void add(int e, const Matrix& K);
  void factorise();
  /// Solves in place for all nodal values.
  void solve(double* values) const;

 private:
  void add_ends(int e, const Eigen::Matrix<double, 6, 6>& K);
  struct Inside {
    Eigen::PartialPivLU<Eigen::Matrix<double, (inner > 0 ? inner : 1), (inner > 0 ? inner : 1)>> lu;
    Eigen::Matrix<double, 6, (inner > 0 ? inner : 1)> from_inner;
    Eigen::Matrix<double, (inner > 0 ? inner : 1), 6> follow;
  };
  BlockTridiagonal ends_;
  std::vector<Inside> inside_;
  std::vector<int> held_;
};

extern template class ElementChain<1>;
extern template class ElementChain<2>;
extern template class ElementChain<3>;
extern template class ElementChain<4>;

}  // namespace gnomon::planar_beam
