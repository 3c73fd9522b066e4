#include "integrators/beam/rk4.hpp"

#include <numbers>
#include <utility>

namespace gnomon::beam {

Rk4Motion::Rk4Motion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
                     const SchemeOptions& options)
    : nodal(std::move(beam), std::move(u), std::move(v), options),
      start_u_(nodal.u),
      start_v_(nodal.v),
      sum_u_(nodal.u),
      sum_v_(nodal.v) {}

std::string Rk4Motion::caution(double h) const {
  return stability_caution(nodal, Mass::consistent, 2.0 * std::numbers::sqrt2, h);
}

void Rk4Motion::stage(double t, double h, double part) {
  Eigen::VectorXd &u = nodal.u, &v = nodal.v, &a = nodal.a;
  const double at = t + part * h;
  u = start_u_ + part * h * v;
  v = start_v_ + part * h * a;
  nodal.drive(at, h, u, v, a);
  nodal.accelerate(at, h);
  a -= nodal.beam->damping() * v;
  nodal.drive(at, h, u, v, a);
}

Status Rk4Motion::step(double t, double h) {
  // The accelerations at the start are those at the end of the last step, unless the data jump.
  nodal.begin(t, h);
  Eigen::VectorXd &u = nodal.u, &v = nodal.v, &a = nodal.a;
  start_u_ = u;
  start_v_ = v;
  sum_u_ = v;
  sum_v_ = a;
  for (const double part : {0.5, 0.5}) {
    stage(t, h, part);
    sum_u_ += 2.0 * v;
    sum_v_ += 2.0 * a;
  }
  stage(t, h, 1.0);
  // The end: the sums instead of slopes.
  v = (sum_u_ + v) / 6.0;
  a = (sum_v_ + a) / 6.0;
  stage(t, h, 1.0);
  return nodal.torn() ? Status::diverged : Status::ok;
}

}  // namespace gnomon::beam
