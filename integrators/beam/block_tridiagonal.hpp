#pragma once
#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

namespace gnomon::beam {

/// A block tridiagonal matrix of 3 x 3 blocks and its elimination from one end to the other without
/// exchanges between blocks. No function but the constructor allocates.
class BlockTridiagonal {
 public:
  explicit BlockTridiagonal(int size)
      : diagonal(size), upper(size), lower(size), inverse_(size), left_(size) {}

  int size() const { return static_cast<int>(diagonal.size()); }
  void clear() {
    for (int i = 0; i < size(); ++i) {
      diagonal[i].setZero();
      upper[i].setZero();
      lower[i].setZero();
    }
  }
  /// Takes unknown k of block i, the first or the last, out of the system.
  void hold(int i, int k) {
    diagonal[i].row(k).setZero();
    diagonal[i].col(k).setZero();
    diagonal[i](k, k) = 1.0;
    if (i + 1 < size()) {
      upper[i].row(k).setZero();
      lower[i + 1].col(k).setZero();
    }
    if (i > 0) {
      lower[i].row(k).setZero();
      upper[i - 1].col(k).setZero();
    }
  }
  void factorise() {
    inverse_[0] = diagonal[0].inverse();
    for (int i = 1; i < size(); ++i) {
      left_[i].noalias() = lower[i] * inverse_[i - 1];
      Eigen::Matrix3d reduced = diagonal[i];
      reduced.noalias() -= left_[i] * upper[i - 1];
      inverse_[i] = reduced.inverse();
    }
  }
  /// Solves in place; block i begins at values[stride * i].
  void solve(double* values, int stride) const {
    const auto at = [&](int i) { return Eigen::Map<Eigen::Vector3d>(values + stride * i); };
    const int last = size() - 1;
    Eigen::Vector3d x = at(0);
    for (int i = 1; i <= last; ++i) {
      x = at(i) - left_[i] * x;
      at(i) = x;
    }
    x = inverse_[last] * x;
    at(last) = x;
    for (int i = last - 1; i >= 0; --i) {
      const Eigen::Vector3d y = at(i) - upper[i] * x;
      x.noalias() = inverse_[i] * y;
      at(i) = x;
    }
  }

  std::vector<Eigen::Matrix3d> diagonal;
  std::vector<Eigen::Matrix3d> upper;  ///< [i]: row i, column i + 1
  std::vector<Eigen::Matrix3d> lower;  ///< [i]: row i, column i - 1

 private:
  std::vector<Eigen::Matrix3d> inverse_, left_;
};

}  // namespace gnomon::beam
