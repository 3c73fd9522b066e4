#pragma once
#include <algorithm>
#include <optional>
#include <vector>

#include "models/planar_beam/free_unknowns.hpp"
#include "models/planar_beam/sparse.hpp"

namespace gnomon::planar_beam {

/// u' = v, M w' = f_ext(t, u) - f_int(u) - alpha M w on the free unknowns: no inverse of M, so that all
/// matrices are sparse.
template <class Beam>
class MassForm : public FreeUnknowns<Beam> {
 public:
  explicit MassForm(const Beam& beam)
      : FreeUnknowns<Beam>(beam),
        layout_(this->size()),
        matrices_(beam, places(beam), this->count(), this->count()) {
    const int n = this->count();
    for (int j = 0; j < n; ++j) {
      layout_.add(j, j);
      layout_.add(j, n + j);
    }
    matrices_.add_to(layout_);
    layout_.finish();
    matrices_.find(layout_);
  }
  std::optional<SparsePattern> sparsity() const { return layout_.pattern(); }

  void rhs(double t, const double* y, double* value) const {
    const int n = this->count();
    this->velocities(t, y, value);
    this->forces(t, y);
    this->damp(y);
    for (int i = 0; i < n; ++i) value[n + i] = this->f_[this->beam_->free()[i]];
  }
  void jacobian(double t, const double* y, double* values) const { combine(t, y, 0.0, 1.0, values); }
  void mass(double* values) const { combine(0.0, nullptr, 1.0, 0.0, values); }

 protected:
  /// a M + b J, M the whole mass matrix of the form. Where b is 0, y is not needed.
  void combine(double t, const double* y, double a, double b, double* values) const {
    const int n = this->count();
    std::fill(values, values + layout_.count(), 0.0);
    for (int j = 0; j < n; ++j) {
      values[layout_.pattern().column_start[j]] = a;  // row j is the first of columns j and n + j
      values[layout_.pattern().column_start[n + j]] = b;
    }
    matrices_.add_mass(a - b * this->beam_->damping(), values);
    if (b != 0.0) matrices_.add_stiffness(t, this->displacements(t, y), -b, values);
  }

 private:
  static std::vector<int> places(const Beam& beam) {
    std::vector<int> place(beam.unknowns(), -1);
    for (std::size_t i = 0; i < beam.free().size(); ++i) place[beam.free()[i]] = static_cast<int>(i);
    for (int i : beam.numbering().tied()) place[i] = place[i + 3];
    return place;
  }
  SparseLayout layout_;
  ChainMatrices<Beam> matrices_;
};

}  // namespace gnomon::planar_beam
