#pragma once
// Compiled once for each instruction set. What runs is all inlined into functions with internal linkage, so
// that the linker has nothing of Boost to take from one set for another.

#include <array>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/bulirsch_stoer.hpp>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <exception>

#include "models/rigid_body/peers/odeint.hpp"
#include "src/measure/timing.hpp"

namespace gnomon::rigid_body {
namespace {

namespace odeint = boost::numeric::odeint;
using PlainState = std::array<double, 7>;

struct PlainEquations {
  PlainBody body;
  long* evaluations;

  void operator()(const PlainState& y, PlainState& rate, double) const {
    ++*evaluations;
    const double w0 = y[4] * body.inverse_inertia[0], w1 = y[5] * body.inverse_inertia[1],
                 w2 = y[6] * body.inverse_inertia[2];
    rate[0] = 0.5 * (-y[1] * w0 - y[2] * w1 - y[3] * w2);
    rate[1] = 0.5 * (y[0] * w0 + y[2] * w2 - y[3] * w1);
    rate[2] = 0.5 * (y[0] * w1 + y[3] * w0 - y[1] * w2);
    rate[3] = 0.5 * (y[0] * w2 + y[1] * w1 - y[2] * w0);
    rate[4] = y[5] * w2 - y[6] * w1;
    rate[5] = y[6] * w0 - y[4] * w2;
    rate[6] = y[4] * w1 - y[5] * w0;
    if (body.heavy) {
      const double* c = body.weight_times_arm;
      const double g0 = 2.0 * (y[1] * y[3] - y[0] * y[2]), g1 = 2.0 * (y[2] * y[3] + y[0] * y[1]),
                   g2 = y[0] * y[0] - y[1] * y[1] - y[2] * y[2] + y[3] * y[3];
      rate[4] -= c[1] * g2 - c[2] * g1;
      rate[5] -= c[2] * g0 - c[0] * g2;
      rate[6] -= c[0] * g1 - c[1] * g0;
    }
  }
};

template <class Stepper>
double integrate_plainly(const Stepper& stepper, const PlainBody& body, double* y, double t_end,
                         long& evaluations) {
  PlainState state;
  for (std::size_t k = 0; k < 7; ++k) state[k] = y[k];
  const double first_step = 0.01;
  evaluations = 0;
  try {
    const double begin = thread_cpu_seconds();
    odeint::integrate_adaptive(stepper, PlainEquations{body, &evaluations}, state, 0.0, t_end, first_step);
    const double seconds = thread_cpu_seconds() - begin;
    for (std::size_t k = 0; k < 7; ++k) y[k] = state[k];
    return seconds;
  } catch (const std::exception&) {
    return -1.0;
  }
}

[[gnu::flatten]] double run_bulirsch_stoer(const PlainBody& body, double* y, double t_end, double tol,
                                           long& evaluations) {
  return integrate_plainly(odeint::bulirsch_stoer<PlainState>(tol, tol), body, y, t_end, evaluations);
}

[[gnu::flatten]] double run_fehlberg78(const PlainBody& body, double* y, double t_end, double tol,
                                       long& evaluations) {
  return integrate_plainly(odeint::make_controlled<odeint::runge_kutta_fehlberg78<PlainState>>(tol, tol),
                           body, y, t_end, evaluations);
}

inline constexpr OdeintRuns odeint_runs{run_bulirsch_stoer, run_fehlberg78};

}  // namespace
}  // namespace gnomon::rigid_body
