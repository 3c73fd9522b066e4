#pragma once
#include "models/rigid_body/plain_cvode.h"
#include "models/rigid_body/rigid_body.hpp"
#include "src/catalogue.hpp"

namespace gnomon::rigid_body {

inline double run_plain_cvode(const void* model, double t_end, double tol, std::vector<double>& state,
                              long& evaluations) {
  const auto& body = *static_cast<const RigidBody<Free>*>(model);
  const auto form = body.ode();
  std::vector<double> atol = form.scales();
  for (double& value : atol) value *= tol;
  double y[7];
  form.pack(0.0, body.initial(), y);
  const double seconds = gnomon_plain_cvode(body.inertia().data(), y, t_end, tol, atol.data(), &evaluations);
  state = body.flatten(form.unpack(t_end, y));
  return seconds;
}

inline constexpr Yardstick plain_cvode_yardstick{
    .name = "cvode-adams in plain C",
    .summary = "the same equations and settings in a C function that calls CVODE itself",
    .scene = "asymmetric-free-top",
    .integrator = "cvode-adams",
    .tol = 1e-8,
    .run = run_plain_cvode,
};

}  // namespace gnomon::rigid_body
