#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <vector>

namespace gnomon::planar_beam {

/// A block tridiagonal matrix of 3 x 3 blocks, at least two of them in a row, and its elimination from both
/// ends to the middle without exchanges between blocks: two chains of operations that do not wait for each
/// other. No function but the constructor allocates.
class BlockTridiagonal {
 public:
  /// One row of blocks.
  struct Row {
    Eigen::Matrix3d lower, diagonal, upper;
  };

  explicit BlockTridiagonal(int size) : rows(size), reduced_(size), middle_(size / 2) {}

  int size() const { return static_cast<int>(rows.size()); }
  /// Takes unknown k of block i, the first or the last, out of the system.
  void hold(int i, int k) {
    rows[i].diagonal.row(k).setZero();
    rows[i].diagonal.col(k).setZero();
    rows[i].diagonal(k, k) = 1.0;
    if (i + 1 < size()) {
      rows[i].upper.row(k).setZero();
      rows[i + 1].lower.col(k).setZero();
    }
    if (i > 0) {
      rows[i].lower.row(k).setZero();
      rows[i - 1].upper.col(k).setZero();
    }
  }
  void factorise() {
    const int last = size() - 1;
    reduced_[0].inverse = inverse_of(rows[0].diagonal);
    if (last > middle_) reduced_[last].inverse = inverse_of(rows[last].diagonal);
    for (int i = 1; i < middle_; ++i) {
      eliminate(i, rows[i].lower, i - 1, rows[i - 1].upper);
      if (const int j = last - i; j > middle_) eliminate(j, rows[j].upper, j + 1, rows[j + 1].lower);
    }
    Reduced& meeting = reduced_[middle_];
    meeting.factor = rows[middle_].lower * reduced_[middle_ - 1].inverse;
    Eigen::Matrix3d rest = rows[middle_].diagonal - meeting.factor * rows[middle_ - 1].upper;
    if (last > middle_) {
      other_factor_ = rows[middle_].upper * reduced_[middle_ + 1].inverse;
      rest -= other_factor_ * rows[middle_ + 1].lower;
    }
    meeting.inverse = inverse_of(rest);
  }
  /// Solves in place; block i begins at values[stride * i].
  void solve(double* values, int stride) const {
    solve_at(values, [stride](int i) { return stride * i; });
  }
  /// The same with block i beginning at values[first(i)].
  template <class First>
  void solve_at(double* values, First&& first) const {
    using Vector = Eigen::Vector3d;
    const auto at = [&](int i) { return Eigen::Map<Vector>(values + first(i)); };
    const int last = size() - 1;
    Vector x = at(0), y = at(last);
    for (int i = 1; i < middle_; ++i) {
      x = at(i) - reduced_[i].factor * x;
      at(i) = x;
      if (const int j = last - i; j > middle_) {
        y = at(j) - reduced_[j].factor * y;
        at(j) = y;
      }
    }
    Vector rest = at(middle_) - reduced_[middle_].factor * x;
    if (last > middle_) rest -= other_factor_ * y;
    x.noalias() = reduced_[middle_].inverse * rest;
    at(middle_) = x;
    y = x;
    for (int i = middle_ - 1, j = middle_ + 1; i >= 0; --i, ++j) {
      const Vector f = at(i) - rows[i].upper * x;
      x.noalias() = reduced_[i].inverse * f;
      at(i) = x;
      if (j <= last) {
        const Vector g = at(j) - rows[j].lower * y;
        y.noalias() = reduced_[j].inverse * g;
        at(j) = y;
      }
    }
  }

  std::vector<Row> rows;

 private:
  struct Reduced {
    Eigen::Matrix3d inverse;  ///< of the diagonal block that is left
    Eigen::Matrix3d factor;   ///< of the neighbour's row that was taken off
  };
  static Eigen::Matrix3d inverse_of(const Eigen::Matrix3d& a) {
    const Eigen::Vector3d x = a.col(0), y = a.col(1), z = a.col(2);
    Eigen::Matrix3d inverse;
    inverse.row(0) = y.cross(z);
    inverse.row(1) = z.cross(x);
    inverse.row(2) = x.cross(y);
    return inverse * (1.0 / inverse.row(0).dot(x));
  }
  void eliminate(int i, const Eigen::Matrix3d& to_neighbour, int neighbour,
                 const Eigen::Matrix3d& from_neighbour) {
    reduced_[i].factor.noalias() = to_neighbour * reduced_[neighbour].inverse;
    Eigen::Matrix3d rest = rows[i].diagonal;
    rest.noalias() -= reduced_[i].factor * from_neighbour;
    reduced_[i].inverse = inverse_of(rest);
  }
  std::vector<Reduced> reduced_;
  Eigen::Matrix3d other_factor_;  ///< that of the middle row for its other neighbour
  int middle_;
};

}  // namespace gnomon::planar_beam
