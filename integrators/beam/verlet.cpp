#include "integrators/beam/verlet.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

namespace gnomon::beam {

double stable_step(const NodalBeam& beam, const double* u, Mass mass) {
  Eigen::MatrixXd inertia = beam.element_mass();
  if (mass == Mass::lumped) inertia = Eigen::MatrixXd(inertia.rowwise().sum().asDiagonal());
  // K x = w^2 M x with M = L L^T: the eigenvalues of L^-1 K L^-T.
  const Eigen::MatrixXd lower = inertia.llt().matrixL();
  const Eigen::MatrixXd inverse =
      lower.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(lower.rows(), lower.cols()));
  double highest = 0.0;
  for (int e = 0; e < beam.elements(); ++e) {
    const Eigen::MatrixXd scaled = inverse * beam.element_stiffness(u, e) * inverse.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled, Eigen::EigenvaluesOnly);
    highest = std::max(highest, solver.eigenvalues().maxCoeff());
  }
  return 2.0 / std::sqrt(highest);
}

VerletMotion::VerletMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
                           const SchemeOptions& options, Mass mass)
    : nodal(std::move(beam), std::move(u), std::move(v), options),
      stable_(stable_step(*nodal.beam, nodal.u.data(), mass)) {
  if (mass == Mass::lumped) nodal.lumped = nodal.beam->lumped_mass();
}

std::string VerletMotion::caution(double h) const {
  if (h <= stable_) return "";
  return fmt::format("the step is above 2/omega_max = {:.3g} s, to which the scheme is stable", stable_);
}

Status VerletMotion::step(double t, double h) {
  nodal.begin(t, h);
  Eigen::VectorXd &u = nodal.u, &v = nodal.v, &a = nodal.a;
  v += 0.5 * h * a;
  u += h * v;
  nodal.drive(t, t + h, h, u, v, a);
  nodal.accelerate(t + h, h);
  v += 0.5 * h * a;
  nodal.drive(t, t + h, h, u, v, a);
  return Status::ok;
}

LumpedVerletMotion::LumpedVerletMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
                                       const SchemeOptions& options)
    : VerletMotion(std::move(beam), std::move(u), std::move(v), options, Mass::lumped) {}
ConsistentVerletMotion::ConsistentVerletMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u,
                                               Eigen::VectorXd v, const SchemeOptions& options)
    : VerletMotion(std::move(beam), std::move(u), std::move(v), options, Mass::consistent) {}

}  // namespace gnomon::beam
