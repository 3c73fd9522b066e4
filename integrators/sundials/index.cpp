#include "integrators/sundials/index.hpp"

#include <klu.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace gnomon::sundials {
namespace {

SparsePattern pattern_of(const DaeSystem& system) {
  if (auto pattern = system.sparsity()) return std::move(*pattern);
  const long n = system.size();
  SparsePattern full;
  for (long j = 0; j <= n; ++j) full.column_start.push_back(j * n);
  for (long k = 0; k < n * n; ++k) full.row.push_back(k % n);
  return full;
}

/// Divides the rows, then the columns by their largest entries; false where one vanishes.
bool equilibrate(const SparsePattern& pattern, std::vector<double>& values) {
  const std::size_t n = pattern.column_start.size() - 1;
  std::vector<double> row(n, 0.0);
  for (std::size_t k = 0; k < values.size(); ++k)
    row[pattern.row[k]] = std::max(row[pattern.row[k]], std::abs(values[k]));
  for (double largest : row)
    if (!(largest > 0.0)) return false;
  for (std::size_t k = 0; k < values.size(); ++k) values[k] /= row[pattern.row[k]];
  for (std::size_t j = 0; j < n; ++j) {
    double largest = 0.0;
    for (long k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k)
      largest = std::max(largest, std::abs(values[k]));
    if (!(largest > 0.0)) return false;
    for (long k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) values[k] /= largest;
  }
  return true;
}

/// Whether the condition number in the 1-norm exceeds 1e12.
bool is_singular(SparsePattern& pattern, std::vector<double>& values) {
  const auto n = static_cast<SuiteSparse_long>(pattern.column_start.size() - 1);
  std::vector<SuiteSparse_long> start(pattern.column_start.begin(), pattern.column_start.end());
  std::vector<SuiteSparse_long> row(pattern.row.begin(), pattern.row.end());
  klu_l_common common;
  klu_l_defaults(&common);
  klu_l_symbolic* symbolic = klu_l_analyze(n, start.data(), row.data(), &common);
  klu_l_numeric* numeric =
      symbolic ? klu_l_factor(start.data(), row.data(), values.data(), symbolic, &common) : nullptr;
  const bool regular = numeric && klu_l_condest(start.data(), values.data(), symbolic, numeric, &common) &&
                       common.condest <= 1e12;
  klu_l_free_numeric(&numeric, &common);
  klu_l_free_symbolic(&symbolic, &common);
  return !regular;
}

}  // namespace

bool index_exceeds_one(const DaeSystem& system) {
  const std::size_t n = static_cast<std::size_t>(system.size());
  std::vector<double> y(n), rate(n);
  system.start(y.data());
  system.resume(0.0, y.data(), rate.data());
  SparsePattern pattern = pattern_of(system);
  // The entries are linear in cj. So large a value leaves dF/dy' with all its digits.
  constexpr double cj = 0x1p100;
  std::vector<double> by_y(pattern.row.size()), values(pattern.row.size());
  system.jacobian(0.0, 0.0, y.data(), rate.data(), by_y.data());
  system.jacobian(0.0, cj, y.data(), rate.data(), values.data());
  std::vector<char> differential(n, 0);
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = (values[k] - by_y[k]) / cj;
    if (values[k] != 0.0) differential[pattern.row[k]] = 1;
  }
  const std::vector<double> scales = system.scales();
  for (std::size_t j = 0; j < n; ++j)
    for (long k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k)
      values[k] = scales[j] * (differential[pattern.row[k]] ? values[k] : by_y[k]);
  // Values that are not finite say nothing of the index; the integration ends with them as its reason.
  for (double value : values)
    if (!std::isfinite(value)) return false;
  return !equilibrate(pattern, values) || is_singular(pattern, values);
}

}  // namespace gnomon::sundials
