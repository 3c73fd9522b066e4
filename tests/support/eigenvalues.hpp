#pragma once
#include <Eigen/Core>
#include <complex>
#include <vector>

namespace gnomon::test {

/// The eigenvalues of a square matrix, by LAPACK: Eigen's solver takes long to compile.
std::vector<std::complex<double>> eigenvalues(Eigen::MatrixXd matrix);

}  // namespace gnomon::test
