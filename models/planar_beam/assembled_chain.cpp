#include "models/planar_beam/assembled_chain.hpp"

#include <klu.h>

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "models/planar_beam/sparse.hpp"

extern "C" {
// LAPACK by its Fortran names; SuiteSparse needs it too.
void dgbtrf_(const int* rows, const int* columns, const int* lower, const int* upper, double* band,
             const int* width, int* pivots, int* info);
void dgbtrs_(const char* which, const int* size, const int* lower, const int* upper, const int* sides,
             const double* band, const int* width, const int* pivots, double* right, const int* right_size,
             int* info, std::size_t which_length);
}

namespace gnomon::planar_beam {
namespace {

using Starts = std::vector<long>;

/// LU factors of a band matrix with exchanges of rows, column by column, as LAPACK's dgbtrf stores them: an
/// entry (i, j) at row `upper + lower + i - j` of column j.
class Band : public Factorisation {
 public:
  Band(const Starts& start, const std::vector<long>& row)
      : start_(start), row_(row), size_(static_cast<int>(start.size()) - 1) {
    for (int j = 0; j < size_; ++j)
      for (long k = start[j]; k < start[j + 1]; ++k)
        lower_ = std::max(lower_, std::abs(static_cast<int>(row[k]) - j));
    width_ = 3 * lower_ + 1;
    band_.resize(static_cast<std::size_t>(width_) * size_);
    pivot_.resize(size_);
  }
  bool factorise(const std::vector<double>& values) override {
    fill(values);
    for (int j = 0; j < size_; ++j) {
      const int last = std::min(size_ - 1, j + lower_);
      int pivot = j;
      for (int i = j + 1; i <= last; ++i)
        if (std::abs(at(i, j)) > std::abs(at(pivot, j))) pivot = i;
      pivot_[j] = pivot;
      if (!(std::abs(at(pivot, j)) > 0.0)) return false;
      const int right = std::min(size_ - 1, j + 2 * lower_);
      if (pivot != j)
        for (int k = j; k <= right; ++k) std::swap(at(j, k), at(pivot, k));
      const double inverse = 1.0 / at(j, j);
      for (int i = j + 1; i <= last; ++i) at(i, j) *= inverse;
      for (int k = j + 1; k <= right; ++k) {
        const double factor = at(j, k);
        if (factor == 0.0) continue;
        for (int i = j + 1; i <= last; ++i) at(i, k) -= at(i, j) * factor;
      }
    }
    return true;
  }
  void solve(double* x) override {
    for (int j = 0; j < size_; ++j) {
      std::swap(x[j], x[pivot_[j]]);
      for (int i = j + 1; i <= std::min(size_ - 1, j + lower_); ++i) x[i] -= at(i, j) * x[j];
    }
    for (int j = size_ - 1; j >= 0; --j) {
      x[j] /= at(j, j);
      for (int i = std::max(0, j - 2 * lower_); i < j; ++i) x[i] -= at(i, j) * x[j];
    }
  }

 protected:
  void fill(const std::vector<double>& values) {
    std::fill(band_.begin(), band_.end(), 0.0);
    for (int j = 0; j < size_; ++j)
      for (long k = start_[j]; k < start_[j + 1]; ++k) at(static_cast<int>(row_[k]), j) = values[k];
  }
  double& at(int i, int j) {
    return band_[static_cast<std::size_t>(width_) * j + static_cast<std::size_t>(2 * lower_ + i - j)];
  }
  Starts start_;
  std::vector<long> row_;
  int size_, lower_ = 0, width_ = 0;
  std::vector<double> band_;
  std::vector<int> pivot_;
};

/// The same by LAPACK, whichever is installed.
class Lapack final : public Band {
 public:
  using Band::Band;
  bool factorise(const std::vector<double>& values) override {
    fill(values);
    int info = 0;
    dgbtrf_(&size_, &size_, &lower_, &lower_, band_.data(), &width_, pivot_.data(), &info);
    return info == 0;
  }
  void solve(double* x) override {
    const int one = 1;
    int info = 0;
    dgbtrs_("N", &size_, &lower_, &lower_, &one, band_.data(), &width_, pivot_.data(), x, &size_, &info, 1);
  }
};

/// SuiteSparse KLU. The pattern is analysed once and the first pivots are kept while they serve (T.A. Davis,
/// E. Palamadai Natarajan, ACM Trans. Math. Softw. 37 (2010) 36).
class Klu final : public Factorisation {
 public:
  Klu(const Starts& start, const std::vector<long>& row) : start_(start), row_(row) {
    klu_l_defaults(&common_);
    symbolic_ = klu_l_analyze(size(), start_.data(), row_.data(), &common_);
    if (!symbolic_) throw std::runtime_error("KLU: no analysis of the pattern");
  }
  Klu(const Klu&) = delete;
  Klu& operator=(const Klu&) = delete;
  ~Klu() override {
    klu_l_free_numeric(&numeric_, &common_);
    klu_l_free_symbolic(&symbolic_, &common_);
  }
  bool factorise(const std::vector<double>& values) override {
    double* entries = const_cast<double*>(values.data());  // KLU does not change them
    if (numeric_ && klu_l_refactor(start_.data(), row_.data(), entries, symbolic_, numeric_, &common_) &&
        klu_l_rgrowth(start_.data(), row_.data(), entries, symbolic_, numeric_, &common_) &&
        common_.rgrowth > 1e-6)
      return true;
    klu_l_free_numeric(&numeric_, &common_);
    numeric_ = klu_l_factor(start_.data(), row_.data(), entries, symbolic_, &common_);
    return numeric_ != nullptr;
  }
  void solve(double* x) override { klu_l_solve(symbolic_, numeric_, size(), 1, x, &common_); }

 private:
  long size() const { return static_cast<long>(start_.size()) - 1; }
  Starts start_;
  std::vector<long> row_;
  klu_l_common common_{};
  klu_l_symbolic* symbolic_ = nullptr;
  klu_l_numeric* numeric_ = nullptr;
};

/// Eigen's SparseLU; it allocates in each factorisation.
class SparseLu final : public Factorisation {
 public:
  SparseLu(const Starts& start, const std::vector<long>& row)
      : matrix_(static_cast<int>(start.size()) - 1, static_cast<int>(start.size()) - 1) {
    matrix_.resizeNonZeros(static_cast<int>(row.size()));
    for (std::size_t j = 0; j < start.size(); ++j) matrix_.outerIndexPtr()[j] = static_cast<int>(start[j]);
    for (std::size_t k = 0; k < row.size(); ++k) matrix_.innerIndexPtr()[k] = static_cast<int>(row[k]);
    std::fill(matrix_.valuePtr(), matrix_.valuePtr() + row.size(), 1.0);
    lu_.analyzePattern(matrix_);
  }
  bool factorise(const std::vector<double>& values) override {
    std::copy(values.begin(), values.end(), matrix_.valuePtr());
    lu_.factorize(matrix_);
    return lu_.info() == Eigen::Success;
  }
  void solve(double* x) override {
    Eigen::Map<Eigen::VectorXd> right(x, matrix_.rows());
    right = Eigen::VectorXd(lu_.solve(right));
  }

 private:
  Eigen::SparseMatrix<double> matrix_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::COLAMDOrdering<int>> lu_;
};

}  // namespace

AssembledChain::AssembledChain(LinearSolver solver, int order, int elements, std::vector<int> held,
                               std::vector<int> hinged)
    : kind_(solver),
      order_(order),
      numbering_(order, elements, std::move(hinged)),
      held_(std::move(held)),
      springs_(numbering_.hinged().size()) {
  const int size = numbering_.unknowns(), width = 3 * (order + 1);
  // The equation of each unknown: none where it is held, that of what it is tied to where it is tied.
  std::vector<int> equation(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) equation[i] = i;
  for (int i : numbering_.tied()) equation[i] = i + 3;
  for (int i : held_) equation[i] = -1;
  const auto for_entries = [&](auto&& body) {
    for (int e = 0; e < elements; ++e)
      for (int j = 0; j < width; ++j)
        for (int i = 0; i < width; ++i)
          body(equation[numbering_.first(e) + i], equation[numbering_.first(e) + j]);
  };
  SparseLayout layout(size);
  for (int i = 0; i < size; ++i) layout.add(i, i);
  for_entries([&](int row, int column) {
    if (row >= 0 && column >= 0) layout.add(row, column);
  });
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const int sides[2] = {numbering_.left_rotation(static_cast<int>(k)),
                          numbering_.right_rotation(static_cast<int>(k))};
    for (int row : sides)
      for (int column : sides) layout.add(row, column);
  }
  layout.finish();
  for_entries([&](int row, int column) {
    slot_.push_back(row >= 0 && column >= 0 ? static_cast<int>(layout.slot(row, column)) : -1);
  });
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const int sides[2] = {numbering_.left_rotation(static_cast<int>(k)),
                          numbering_.right_rotation(static_cast<int>(k))};
    for (int row = 0; row < 2; ++row)
      for (int column = 0; column < 2; ++column)
        springs_[k].slot[row][column] = layout.slot(sides[row], sides[column]);
  }
  column_start_ = layout.pattern().column_start;
  row_ = layout.pattern().row;
  values_.resize(row_.size());
  make_solver();
}
AssembledChain::AssembledChain(const AssembledChain& other)
    : kind_(other.kind_),
      order_(other.order_),
      numbering_(other.numbering_),
      held_(other.held_),
      springs_(other.springs_),
      column_start_(other.column_start_),
      row_(other.row_),
      slot_(other.slot_),
      values_(other.values_) {
  make_solver();
  if (other.regular_) factorise();
}
AssembledChain& AssembledChain::operator=(const AssembledChain& other) {
  if (this != &other) *this = AssembledChain(other);
  return *this;
}

void AssembledChain::make_solver() {
  switch (kind_) {
    case LinearSolver::lapack:
      solver_ = std::make_unique<Lapack>(column_start_, row_);
      return;
    case LinearSolver::klu:
      solver_ = std::make_unique<Klu>(column_start_, row_);
      return;
    case LinearSolver::sparselu:
      solver_ = std::make_unique<SparseLu>(column_start_, row_);
      return;
    default:
      solver_ = std::make_unique<Band>(column_start_, row_);
  }
}

void AssembledChain::set_spring(int k, double by_left, double by_right) {
  springs_[k].slope = {by_left, by_right};
}

void AssembledChain::add(int e, const double* matrix) {
  if (e == 0) {
    std::fill(values_.begin(), values_.end(), 0.0);
    for (int i : held_) values_[column_start_[i]] = 1.0;
    for (int i : numbering_.tied()) values_[column_start_[i]] = 1.0;
    for (const Spring& spring : springs_)
      for (int side = 0; side < 2; ++side) {
        values_[spring.slot[0][side]] -= spring.slope[side];
        values_[spring.slot[1][side]] += spring.slope[side];
      }
  }
  const int count = 9 * (order_ + 1) * (order_ + 1);
  const int* slot = slot_.data() + static_cast<std::ptrdiff_t>(e) * count;
  for (int k = 0; k < count; ++k)
    if (slot[k] >= 0) values_[slot[k]] += matrix[k];
}
void AssembledChain::factorise() { regular_ = solver_->factorise(values_); }
void AssembledChain::solve(double* values) const {
  numbering_.join(values);
  for (int i : held_) values[i] = 0.0;
  if (regular_)
    solver_->solve(values);
  else
    std::fill(values, values + column_start_.size() - 1, std::numeric_limits<double>::quiet_NaN());
  numbering_.spread(values);
}

}  // namespace gnomon::planar_beam
