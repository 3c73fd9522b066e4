#pragma once
#include <algorithm>
#include <vector>

#include "models/planar_beam/element.hpp"
#include "models/planar_beam/numbering.hpp"
#include "src/ode.hpp"

namespace gnomon::planar_beam {

/// The places of a sparse matrix while its pattern is made, and where each of them is stored then.
class SparseLayout {
 public:
  explicit SparseLayout(int size) : rows_(size) {}
  void add(int row, int column) { rows_[column].push_back(row); }
  void finish() {
    for (std::vector<long>& rows : rows_) {
      std::sort(rows.begin(), rows.end());
      rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
      pattern_.column_start.push_back(static_cast<long>(pattern_.row.size()));
      pattern_.row.insert(pattern_.row.end(), rows.begin(), rows.end());
    }
    pattern_.column_start.push_back(static_cast<long>(pattern_.row.size()));
    rows_.clear();
  }
  const SparsePattern& pattern() const { return pattern_; }
  long count() const { return static_cast<long>(pattern_.row.size()); }
  long slot(int row, int column) const {
    const auto begin = pattern_.row.begin() + pattern_.column_start[column];
    const auto end = pattern_.row.begin() + pattern_.column_start[column + 1];
    return std::lower_bound(begin, end, row) - pattern_.row.begin();
  }

 private:
  std::vector<std::vector<long>> rows_;
  SparsePattern pattern_;
};

/// The stiffness and mass matrices of a beam as two blocks of rows of one sparse matrix: rows from `row` on,
/// the stiffness in the columns from 0 on, the mass in those from `column` on. `place[i]` is that of unknown
/// i within a block, -1 where it has none.
template <class Beam>
class ChainMatrices {
 public:
  ChainMatrices(const Beam& beam, std::vector<int> place, int row, int column)
      : beam_(&beam), place_(std::move(place)), row_(row), column_(column) {}

  void add_to(SparseLayout& layout) const {
    for_each([&](int, int i, int j, int to_row, int to_column) {
      layout.add(row_ + to_row, to_column);
      if (i % 3 == j % 3) layout.add(row_ + to_row, column_ + to_column);
    });
    for_each_spring([&](double, int to_row, int to_column) { layout.add(row_ + to_row, to_column); });
  }
  void find(const SparseLayout& layout) {
    for_each([&](int e, int i, int j, int to_row, int to_column) {
      stiffness_.push_back({e, i, j, layout.slot(row_ + to_row, to_column)});
      if (i % 3 == j % 3) mass_.push_back({e, i, j, layout.slot(row_ + to_row, column_ + to_column)});
    });
    for_each_spring([&](double stiffness, int to_row, int to_column) {
      springs_.push_back({stiffness, layout.slot(row_ + to_row, to_column)});
    });
  }
  void add_stiffness(double t, const double* u, double factor, double* values) const {
    typename Element<p>::Matrix K;
    int e = -1;
    for (const Entry& at : stiffness_) {
      if (at.e != e) K = beam_->element_tangent(t, u, e = at.e);
      values[at.slot] += factor * K(at.i, at.j);
    }
    for (const SpringEntry& at : springs_) values[at.slot] += factor * at.stiffness;
  }
  void add_mass(double factor, double* values) const {
    for (const Entry& at : mass_)
      values[at.slot] += factor * beam_->density(at.i % 3) * beam_->element().mass[at.i / 3][at.j / 3];
  }

 private:
  static constexpr int p = Beam::order;
  struct Entry {
    int e, i, j;
    long slot;
  };
  template <class Body>
  void for_each(Body&& body) const {
    for (int e = 0; e < beam_->elements(); ++e)
      for (int j = 0; j < Element<p>::unknowns; ++j)
        for (int i = 0; i < Element<p>::unknowns; ++i) {
          const int to_row = place_[beam_->numbering().first(e) + i],
                    to_column = place_[beam_->numbering().first(e) + j];
          if (to_row >= 0 && to_column >= 0) body(e, i, j, to_row, to_column);
        }
  }
  struct SpringEntry {
    double stiffness;
    long slot;
  };
  template <class Body>
  void for_each_spring(Body&& body) const {
    const Numbering& numbering = beam_->numbering();
    beam_->for_hinge_springs([&](int k, double stiffness) {
      const int sides[2] = {place_[numbering.left_rotation(k)], place_[numbering.right_rotation(k)]};
      for (int to_row : sides)
        for (int to_column : sides) body(to_row == to_column ? stiffness : -stiffness, to_row, to_column);
    });
  }
  const Beam* beam_;
  std::vector<int> place_;
  int row_, column_;
  std::vector<Entry> stiffness_, mass_;
  std::vector<SpringEntry> springs_;
};

}  // namespace gnomon::planar_beam
