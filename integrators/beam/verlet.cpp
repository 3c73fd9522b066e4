#include "integrators/beam/verlet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gnomon::beam {

namespace {

/// A^-1 B by elimination without exchanges, A symmetric and positive definite.
Eigen::MatrixXd quotient(Eigen::MatrixXd A, Eigen::MatrixXd B) {
  const int n = static_cast<int>(A.rows());
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = A(i, k) / A(k, k);
      for (int j = 0; j < n; ++j) {
        A(i, j) -= factor * A(k, j);
        B(i, j) -= factor * B(k, j);
      }
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) B(i, j) /= A(i, i);
  return B;
}

/// A bound of the moduli of the eigenvalues, which are real, by the trace of the power 2^10: too large by at
/// most n^(1/1024), 0.3 % for n = 15.
double highest_eigenvalue(Eigen::MatrixXd A) {
  const int n = static_cast<int>(A.rows());
  Eigen::MatrixXd square(n, n);
  double bound = 1.0, root = 1.0;
  for (int power = 0; power < 10; ++power) {
    double most = 0.0;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) most = std::max(most, std::abs(A(i, j)));
    bound *= std::pow(most, root);
    root *= 0.5;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        double sum = 0.0;
        for (int k = 0; k < n; ++k) sum += A(i, k) * A(k, j);
        square(i, j) = sum / (most * most);
      }
    A.swap(square);
  }
  double trace = 0.0;
  for (int i = 0; i < n; ++i) trace += A(i, i);
  return bound * std::pow(trace, root);
}

}  // namespace

double stable_step(const NodalBeam& beam, const double* u, Mass mass) {
  Eigen::MatrixXd inertia = beam.element_mass();
  if (mass == Mass::lumped)
    for (int i = 0; i < inertia.rows(); ++i) {
      double sum = 0.0;
      for (int j = 0; j < inertia.cols(); ++j) {
        sum += inertia(i, j);
        inertia(i, j) = 0.0;
      }
      inertia(i, i) = sum;
    }
  double highest = 0.0;
  for (int e = 0; e < beam.elements(); ++e)
    highest = std::max(highest, highest_eigenvalue(quotient(inertia, beam.element_stiffness(u, e))));
  return 2.0 / std::sqrt(highest);
}

std::string stability_caution(const NodalMotion& motion, Mass mass, double reach, double h) {
  const double stable = 0.5 * reach * stable_step(*motion.beam, motion.u.data(), mass);
  // Not finite where the motion is not, which ends the run anyway.
  if (!(h > stable)) return "";
  return fmt::format("the step is above {}/omega_max = {:.3g} s, up to which small motions are stable",
                     reach == 2.0 ? "2" : "2 sqrt(2)", stable);
}

VerletMotion::VerletMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
                           const SchemeOptions& options, Mass mass)
    : nodal(std::move(beam), std::move(u), std::move(v), options), half_(nodal.u), mass_(mass) {
  if (mass == Mass::lumped) nodal.lumped = nodal.beam->lumped_mass();
}

Status VerletMotion::step(double t, double h) {
  nodal.begin(t, h);
  Eigen::VectorXd &u = nodal.u, &v = nodal.v, &a = nodal.a;
  const double damping = nodal.beam->damping();
  v += 0.5 * h * a;
  u += h * v;
  half_ = v;
  nodal.drive(t + h, h, u, v, a);
  nodal.accelerate(t + h, h);
  // The rate at the end of the step is part of the damping there.
  v = (half_ + 0.5 * h * a) / (1.0 + 0.5 * damping * h);
  a -= damping * v;
  nodal.drive(t + h, h, u, v, a);
  return nodal.torn() ? Status::diverged : Status::ok;
}

LumpedVerletMotion::LumpedVerletMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
                                       const SchemeOptions& options)
    : VerletMotion(std::move(beam), std::move(u), std::move(v), options, Mass::lumped) {}
ConsistentVerletMotion::ConsistentVerletMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u,
                                               Eigen::VectorXd v, const SchemeOptions& options)
    : VerletMotion(std::move(beam), std::move(u), std::move(v), options, Mass::consistent) {}

}  // namespace gnomon::beam
