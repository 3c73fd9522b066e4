#include "integrators/beam/bathe.hpp"

#include <numbers>
#include <utility>

namespace gnomon::beam {

BatheMotion::BatheMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
                         const SchemeOptions& options)
    : nodal(std::move(beam), std::move(u), std::move(v), options) {
  for (Eigen::VectorXd* vector : {&start_u_, &start_v_, &known_, &force_, &next_u_, &next_v_, &next_a_})
    vector->setZero(nodal.u.size());
}

bool BatheMotion::solve(double t, double h, double rate) {
  nodal.force_before(t, h, known_);
  const Stage stage{1.0, 1.0, rate * rate, rate, t, h, nodal.size_of(known_)};
  known_ = -known_;
  return nodal.solve(stage, start_u_, start_v_, known_, next_u_, next_v_, next_a_, force_);
}

Status BatheMotion::step(double t, double h) {
  constexpr double split = 2.0 - std::numbers::sqrt2;
  nodal.begin(t, h);
  const Eigen::VectorXd &u = nodal.u, &v = nodal.v, &a = nodal.a;

  const double half = 0.5 * split * h;
  start_u_ = u + 2.0 * half * v + half * half * a;
  start_v_ = v + half * a;
  next_a_ = a;
  if (!solve(t + split * h, h, half)) return Status::newton_failed;

  // x'_{n+1} = c1 x_n + c2 x_m + c3 x_{n+1} with c1 + c2 + c3 = 0, solved for x_{n+1} - x_m
  constexpr double past = (1.0 - split) * (1.0 - split) / (split * (2.0 - split));  // c1/c3
  const double rate = (1.0 - split) * h / (2.0 - split);                            // 1/c3
  start_v_ = next_v_ + past * (next_v_ - v);
  start_u_ = next_u_ + past * (next_u_ - u) + rate * start_v_;
  if (!solve(t + h, h, rate)) return Status::newton_failed;
  nodal.u.swap(next_u_);
  nodal.v.swap(next_v_);
  nodal.a.swap(next_a_);
  nodal.internal.swap(force_);
  return Status::ok;
}

}  // namespace gnomon::beam
