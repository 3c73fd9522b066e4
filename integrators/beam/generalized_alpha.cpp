#include "integrators/beam/generalized_alpha.hpp"

#include <utility>

namespace gnomon::beam {
namespace {

constexpr double default_radius = 0.8;

}  // namespace

AlphaParameters trapezoidal_parameters() { return {0.0, 0.0, 0.25, 0.5}; }

AlphaParameters chung_hulbert_parameters(double spectral_radius) {
  const double alpha_m = (2.0 * spectral_radius - 1.0) / (spectral_radius + 1.0);
  const double alpha_f = spectral_radius / (spectral_radius + 1.0);
  const double shift = 1.0 - alpha_m + alpha_f;
  return {alpha_m, alpha_f, 0.25 * shift * shift, 0.5 - alpha_m + alpha_f};
}

AlphaParameters hht_parameters(double spectral_radius) {
  const double alpha_f = (1.0 - spectral_radius) / (1.0 + spectral_radius), shift = 1.0 + alpha_f;
  return {0.0, alpha_f, 0.25 * shift * shift, 0.5 + alpha_f};
}

GeneralizedAlphaMotion::GeneralizedAlphaMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u,
                                               Eigen::VectorXd v, const SchemeOptions& options,
                                               const AlphaParameters& parameters)
    : nodal(std::move(beam), std::move(u), std::move(v), options), parameters_(parameters) {
  for (Eigen::VectorXd* vector :
       {&start_u_, &start_v_, &known_, &external_, &force_, &next_u_, &next_v_, &next_a_})
    vector->setZero(nodal.u.size());
}

Status GeneralizedAlphaMotion::step(double t, double h) {
  const auto& [alpha_m, alpha_f, beta, gamma] = parameters_;
  nodal.begin(t, h);
  const Eigen::VectorXd &u = nodal.u, &v = nodal.v, &a = nodal.a;

  // known_ = M (alpha_m a_n + alpha_f damping v_n) + alpha_f f_n - F, F averaged as f is
  nodal.force_before(t + h, h, external_);
  external_ *= 1.0 - alpha_f;
  if (alpha_f != 0.0) {
    nodal.force_after(t, h, force_);
    external_ += alpha_f * force_;
  }
  known_ = alpha_f * nodal.internal - external_;
  if (alpha_m != 0.0 || alpha_f != 0.0) {
    start_u_ = alpha_m * a + alpha_f * nodal.beam->damping() * v;
    nodal.beam->momentum(start_u_.data(), force_.data());
    known_ += force_;
  }
  const double size = nodal.size_of(external_);
  const Stage stage{1.0 - alpha_m, 1.0 - alpha_f, beta * h * h, gamma * h, t + h, h, size};
  start_u_ = u + h * v + h * h * (0.5 - beta) * a;
  start_v_ = v + h * (1.0 - gamma) * a;
  next_a_ = a;
  if (!nodal.solve(stage, start_u_, start_v_, known_, next_u_, next_v_, next_a_, force_))
    return Status::newton_failed;
  nodal.u.swap(next_u_);
  nodal.v.swap(next_v_);
  nodal.a.swap(next_a_);
  nodal.internal.swap(force_);
  return Status::ok;
}

TrapezoidalMotion::TrapezoidalMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
                                     const SchemeOptions& options)
    : GeneralizedAlphaMotion(std::move(beam), std::move(u), std::move(v), options, trapezoidal_parameters()) {
}
ChungHulbertMotion::ChungHulbertMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
                                       const SchemeOptions& options)
    : GeneralizedAlphaMotion(std::move(beam), std::move(u), std::move(v), options,
                             chung_hulbert_parameters(options.spectral_radius.value_or(default_radius))) {}
HhtMotion::HhtMotion(std::unique_ptr<NodalBeam> beam, Eigen::VectorXd u, Eigen::VectorXd v,
                     const SchemeOptions& options)
    : GeneralizedAlphaMotion(std::move(beam), std::move(u), std::move(v), options,
                             hht_parameters(options.spectral_radius.value_or(default_radius))) {}

}  // namespace gnomon::beam
