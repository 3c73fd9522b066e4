#pragma once
#include <Eigen/Core>
#include <Eigen/LU>
#include <utility>
#include <vector>

#include "models/planar_beam/block_tridiagonal.hpp"

namespace gnomon::planar_beam {

/// The linear system of a chain of elements of order p with three unknowns a node. The inner nodes of each
/// element are eliminated within it (static condensation), the end nodes remain as a block tridiagonal
/// system: the cost is linear in the number of elements. No function but the constructor allocates.
template <int p>
class ElementChain {
 public:
  static constexpr int inner = 3 * (p - 1);
  using Matrix = Eigen::Matrix<double, 3 * (p + 1), 3 * (p + 1)>;

  /// `held` are unknowns of the first and last node that stay 0.
  ElementChain(int elements, std::vector<int> held)
      : ends_(elements + 1), inside_(p > 1 ? elements : 0), held_(std::move(held)) {}

  /// Adds the matrix of element e, its unknowns node by node. Before `factorise` once for each element, from
  /// the first to the last.
  void add(int e, const Matrix& K) {
    if constexpr (p == 1) {
      add_ends(e, K);
    } else {
      Inside& in = inside_[e];
      in.lu.compute(K.template block<inner, inner>(3, 3));
      in.from_inner.template topRows<3>() = K.template block<3, inner>(0, 3);
      in.from_inner.template bottomRows<3>() = K.template block<3, inner>(3 * p, 3);
      Eigen::Matrix<double, inner, 6> to_inner;
      to_inner.template leftCols<3>() = K.template block<inner, 3>(3, 0);
      to_inner.template rightCols<3>() = K.template block<inner, 3>(3, 3 * p);
      in.follow = in.lu.solve(to_inner);
      const Eigen::Matrix<double, 6, 6> gone = in.from_inner * in.follow;
      Eigen::Matrix<double, 6, 6> ends;
      ends << K.template topLeftCorner<3, 3>(), K.template topRightCorner<3, 3>(),
          K.template bottomLeftCorner<3, 3>(), K.template bottomRightCorner<3, 3>();
      add_ends(e, ends - gone);
    }
  }

  void factorise() {
    for (int i : held_) ends_.hold(i / (3 * p), i % 3);
    ends_.factorise();
  }

  /// Solves in place for all nodal values.
  void solve(double* values) const {
    if constexpr (p == 1) {
      for (int i : held_) values[i] = 0.0;
      ends_.solve(values, 3);
    } else {
      using Inner = Eigen::Matrix<double, inner, 1>;
      using Ends = Eigen::Matrix<double, 6, 1>;
      const int count = static_cast<int>(inside_.size());
      for (int e = 0; e < count; ++e) {
        Eigen::Map<Inner> middle(values + 3 * p * e + 3);
        middle = Inner(inside_[e].lu.solve(middle));
        const Ends moved = inside_[e].from_inner * middle;
        for (int k = 0; k < 3; ++k) {
          values[3 * p * e + k] -= moved[k];
          values[3 * p * (e + 1) + k] -= moved[3 + k];
        }
      }
      for (int i : held_) values[i] = 0.0;
      ends_.solve(values, 3 * p);
      for (int e = 0; e < count; ++e) {
        Ends ends;
        for (int k = 0; k < 3; ++k) {
          ends[k] = values[3 * p * e + k];
          ends[3 + k] = values[3 * p * (e + 1) + k];
        }
        Eigen::Map<Inner> middle(values + 3 * p * e + 3);
        middle -= inside_[e].follow * ends;
      }
    }
  }

 private:
  void add_ends(int e, const Eigen::Matrix<double, 6, 6>& K) {
    BlockTridiagonal::Row &here = ends_.rows[e], &next = ends_.rows[e + 1];
    if (e == 0)
      here.diagonal = K.template topLeftCorner<3, 3>();
    else
      here.diagonal += K.template topLeftCorner<3, 3>();
    here.upper = K.template topRightCorner<3, 3>();
    next.lower = K.template bottomLeftCorner<3, 3>();
    next.diagonal = K.template bottomRightCorner<3, 3>();
  }
  struct Inside {
    Eigen::PartialPivLU<Eigen::Matrix<double, (inner > 0 ? inner : 1), (inner > 0 ? inner : 1)>> lu;
    Eigen::Matrix<double, 6, (inner > 0 ? inner : 1)> from_inner;
    Eigen::Matrix<double, (inner > 0 ? inner : 1), 6> follow;
  };
  BlockTridiagonal ends_;
  std::vector<Inside> inside_;
  std::vector<int> held_;
};

}  // namespace gnomon::planar_beam
