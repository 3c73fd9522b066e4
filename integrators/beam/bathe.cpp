#include "integrators/beam/bathe.hpp"

#include <numbers>
#include <utility>

namespace gnomon::beam {

BatheMotion::BatheMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
                         const SchemeOptions& options)
    : nodal(std::move(beam), std::move(u), std::move(v), options) {
  for (Eigen::VectorXd* vector :
       {&start_, &known_, &force_, &middle_u_, &middle_v_, &next_u_, &next_v_, &next_a_})
    vector->setZero(nodal.u.size());
}

bool BatheMotion::stage(double from, double t, double h, double kappa) {
  nodal.force_before(t, h, known_);
  const Stage equation{1.0, 1.0, kappa, nodal.size_of(known_)};
  known_ = -known_;
  nodal.drive(from, t, h, next_u_, next_v_, next_a_);
  for (int i : nodal.beam->held()) start_[i] = next_u_[i] - kappa * next_a_[i];
  return nodal.solve(equation, start_, known_, next_a_, next_u_, force_);
}

Status BatheMotion::step(double t, double h) {
  constexpr double split = 2.0 - std::numbers::sqrt2;
  nodal.begin(t, h);
  const Eigen::VectorXd &u = nodal.u, &v = nodal.v, &a = nodal.a;
  const double first = split * h;
  next_u_ = u;
  next_v_ = v;
  next_a_ = a;

  start_ = u + first * v + 0.25 * first * first * a;
  if (!stage(t, t + first, h, 0.25 * first * first)) return Status::newton_failed;
  middle_u_ = next_u_;
  middle_v_ = v + 0.5 * first * (a + next_a_);
  nodal.drive(t, t + first, h, middle_u_, middle_v_, next_a_);

  // x'_{n+1} = c1 x_n + c2 x_m + c3 x_{n+1} with c1 + c2 + c3 = 0, solved for x_{n+1} - x_m
  constexpr double past = (1.0 - split) * (1.0 - split) / (split * (2.0 - split));  // c1/c3
  const double time = (1.0 - split) * h / (2.0 - split);                            // 1/c3
  next_v_ = middle_v_ + past * (middle_v_ - v);                                     // without time a
  start_ = middle_u_ + past * (middle_u_ - u) + time * next_v_;
  middle_v_ = next_v_;
  if (!stage(t, t + h, h, time * time)) return Status::newton_failed;
  next_v_ = middle_v_ + time * next_a_;
  nodal.drive(t, t + h, h, next_u_, next_v_, next_a_);
  nodal.u.swap(next_u_);
  nodal.v.swap(next_v_);
  nodal.a.swap(next_a_);
  nodal.internal.swap(force_);
  return Status::ok;
}

}  // namespace gnomon::beam
