#include "tests/support/eigenvalues.hpp"

#include <stdexcept>

extern "C" void dgeev_(const char* jobvl, const char* jobvr, const int* n, double* a, const int* lda,
                       double* wr, double* wi, double* vl, const int* ldvl, double* vr, const int* ldvr,
                       double* work, const int* lwork, int* info);

std::vector<std::complex<double>> gnomon::test::eigenvalues(Eigen::MatrixXd matrix) {
  const int n = static_cast<int>(matrix.rows()), one = 1, words = 8 * n;
  std::vector<double> real(n), imaginary(n), work(words);
  int info = 0;
  dgeev_("N", "N", &n, matrix.data(), &n, real.data(), imaginary.data(), nullptr, &one, nullptr, &one,
         work.data(), &words, &info);
  if (info != 0) throw std::runtime_error("dgeev did not converge");
  std::vector<std::complex<double>> values(n);
  for (int i = 0; i < n; ++i) values[i] = {real[i], imaginary[i]};
  return values;
}
