#pragma once
#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "models/planar_beam/ode.hpp"

namespace gnomon::planar_beam {

/// The implicit form 0 = u' - v, 0 = M v' + f_int(u) - f_ext(t) on the free unknowns: an ODE (index 0) that
/// needs no inverse of M, so that its Jacobian is sparse.
template <class Beam>
class DaeForm : public FreeUnknowns<Beam> {
 public:
  explicit DaeForm(const Beam& beam) : FreeUnknowns<Beam>(beam), inner_(beam.unknowns()) {
    const int n = this->count(), all = beam.unknowns();
    place_.assign(all, -1);
    for (int i = 0; i < n; ++i) place_[beam.free()[i]] = i;
    // Unknowns interact with those of the same element.
    std::vector<std::set<int>> neighbours(n);
    for (int e = 0; e < beam.elements(); ++e)
      for (int i = 0; i < size_; ++i)
        for (int j = 0; j < size_; ++j)
          if (at(e, i) >= 0 && at(e, j) >= 0) neighbours[at(e, j)].insert(at(e, i));
    pattern_.column_start.push_back(0);
    for (int j = 0; j < 2 * n; ++j) {
      pattern_.row.push_back(j % n);
      for (int i : neighbours[j % n]) pattern_.row.push_back(n + i);
      pattern_.column_start.push_back(static_cast<long>(pattern_.row.size()));
    }
  }
  int size() const { return 2 * this->count(); }
  std::optional<SparsePattern> sparsity() const { return pattern_; }
  std::vector<int> algebraic() const { return std::vector<int>(size(), 0); }

  void pack(const State& state, double* y, double* rate) const {
    FreeUnknowns<Beam>::pack(state, y);
    this->beam_->ode().rhs(0.0, y, rate);
  }
  void residual(double t, const double* y, const double* rate, double* value) const {
    const Beam& beam = *this->beam_;
    const int n = this->count();
    Eigen::VectorXd& f = this->f_;
    beam.internal_force(this->spread(y), f.data());
    beam.external_force(t, inner_.data());
    f -= inner_;
    this->spread(rate + n);  // accelerations of the free unknowns; the others stay 0
    beam.momentum(this->u_.data(), inner_.data());
    f += inner_;
    for (int i = 0; i < n; ++i) {
      value[i] = rate[i] - y[n + i];
      value[n + i] = f[beam.free()[i]];
    }
  }
  /// Columns of u: cj in the kinematic rows, the stiffness below; columns of v: -1 and cj M.
  void jacobian(double, double cj, const double* y, const double*, double* values) const {
    const Beam& beam = *this->beam_;
    const int n = this->count();
    std::fill(values, values + pattern_.row.size(), 0.0);
    for (int j = 0; j < n; ++j) {
      values[pattern_.column_start[j]] = cj;
      values[pattern_.column_start[n + j]] = -1.0;
    }
    const double* u = this->spread(y);
    for (int e = 0; e < beam.elements(); ++e) {
      const auto K = beam.element_tangent(u, e);
      for (int j = 0; j < size_; ++j)
        for (int i = 0; i < size_; ++i) {
          const int row = at(e, i), column = at(e, j);
          if (row < 0 || column < 0) continue;
          values[entry(n + row, column)] += K(i, j);
          if (i % 3 == j % 3)
            values[entry(n + row, n + column)] +=
                cj * beam.density(i % 3) * beam.element().mass[i / 3][j / 3];
        }
    }
  }

 private:
  static constexpr int p = Beam::order, size_ = Element<p>::unknowns;
  int at(int e, int i) const { return place_[3 * p * e + i]; }
  long entry(long row, int column) const {
    const auto begin = pattern_.row.begin() + pattern_.column_start[column];
    const auto end = pattern_.row.begin() + pattern_.column_start[column + 1];
    return std::lower_bound(begin, end, row) - pattern_.row.begin();
  }
  std::vector<int> place_;
  SparsePattern pattern_;
  mutable Eigen::VectorXd inner_;
};

}  // namespace gnomon::planar_beam
