#pragma once
#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "models/planar_beam/block_tridiagonal.hpp"
#include "models/planar_beam/numbering.hpp"

namespace gnomon::planar_beam {

/// The linear system of a chain of elements of order p with three unknowns a node. The inner nodes of each
/// element are eliminated within it (static condensation), and so is the last rotation of an element that
/// ends at a hinge. The end nodes remain as a block tridiagonal system: the cost is linear in the number of
/// elements. No function but the constructor allocates. Compiled once, in element_chain.cpp.
template <int p>
class ElementChain {
 public:
  static constexpr int inner = 3 * (p - 1);
  using Matrix = Eigen::Matrix<double, 3 * (p + 1), 3 * (p + 1)>;

  /// `held` are unknowns of the first and last node that stay 0; `hinged` are the elements that begin at a
  /// hinge. Unknowns are numbered as in Numbering.
  ElementChain(int elements, std::vector<int> held, std::vector<int> hinged = {});

  /// Sets the derivatives of the moment of hinge k, positive on its right side, by the rotations on its left
  /// and on its right. They stay; 0 at first. Before `add`.
  void set_spring(int k, double by_left, double by_right);
  /// Adds the matrix of element e, its unknowns node by node. Before `factorise` once for each element, from
  /// the first to the last.
  void add(int e, const Matrix& K);
  void factorise();
  /// Solves in place for all nodal values. Forces on tied displacements count as in Numbering::join.
  void solve(double* values) const;

 private:
  using Ends = Eigen::Matrix<double, 6, 1>;
  using EndMatrix = Eigen::Matrix<double, 6, 6>;
  struct Inside {
    Eigen::PartialPivLU<Eigen::Matrix<double, (inner > 0 ? inner : 1), (inner > 0 ? inner : 1)>> lu;
    Eigen::Matrix<double, 6, (inner > 0 ? inner : 1)> from_inner;
    Eigen::Matrix<double, (inner > 0 ? inner : 1), 6> follow;
  };
  /// What is left of the rotation on the left of a hinge: its equation without the diagonal, and what it
  /// does to the others, those of the nodes on the left of the element before and on the right of the hinge.
  struct Hinge {
    double by_left = 0.0, by_right = 0.0;
    double inverse = 0.0;  ///< of the diagonal
    Ends row, column;
  };
  void add_ends(int e, const EndMatrix& K);
  void place(int e, const EndMatrix& K);
  EndMatrix released(Hinge& hinge, const EndMatrix& K) const;
  void reduce_inner(double* values) const;
  void recover_inner(double* values) const;
  void solve_hinged(double* values) const;

  Numbering numbering_;
  BlockTridiagonal ends_;
  std::vector<Inside> inside_;
  std::vector<int> held_;
  std::vector<Hinge> hinges_;
  std::vector<int> hinge_after_;  ///< of each element, -1 where there is none; empty without hinges
};

extern template class ElementChain<1>;
extern template class ElementChain<2>;
extern template class ElementChain<3>;
extern template class ElementChain<4>;

}  // namespace gnomon::planar_beam
