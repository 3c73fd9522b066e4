#include "integrators/sundials/schemes.hpp"
#include "integrators/sundials/session.hpp"

namespace gnomon::sundials {
namespace {

class Cvode final : public Session {
 public:
  Cvode(const OdeSystem& system, const RunSpec& spec, bool adams, bool krylov)
      : Session(system, spec),
        system_(system),
        memory_(CVodeCreate(adams ? CV_ADAMS : CV_BDF, context_), CVodeFree) {
    system.start(N_VGetArrayPointer(y_.get()));
    if (!memory_) throw std::runtime_error("CVodeCreate failed");
    keep_cvode_messages(memory_, &messages_);
    check(CVodeInit(memory_, rhs, 0.0, y_.get()), "CVodeInit");
    check(CVodeSetUserData(memory_, this), "CVodeSetUserData");
    check(CVodeSVtolerances(memory_, rtol_, atol_.get()), "CVodeSVtolerances");
    check(CVodeSetMaxHnilWarns(memory_, -1), "CVodeSetMaxHnilWarns");
    // Newton also for Adams: on fast tops it takes half the steps of the fixed-point iteration at tight
    // tolerances.
    newton_ = system.newton_solver();
    if (krylov && !newton_) throw std::logic_error("GMRES without a preconditioner");
    linear_ = krylov    ? make_krylov(y_.get(), context_)
              : newton_ ? make_linear(*newton_, context_)
                        : make_linear(system, y_.get(), context_);
    check(CVodeSetLinearSolver(memory_, linear_.solver.get(), linear_.matrix.get()), "CVodeSetLinearSolver");
    if (krylov)
      check(CVodeSetPreconditioner(memory_, set_up, precondition), "CVodeSetPreconditioner");
    else if (newton_)
      check(CVodeSetLinSysFn(memory_, linear_system), "CVodeSetLinSysFn");
    else
      check(CVodeSetJacFn(memory_, jacobian), "CVodeSetJacFn");
  }

  Status advance(double t_stop, bool one_step) override {
    if (stop_ != t_stop) CVodeSetStopTime(memory_, stop_ = t_stop);
    CVodeSetMaxNumSteps(memory_, call_limit(steps()));
    const int flag = CVode(memory_, t_stop, y_.get(), &t_, one_step ? CV_ONE_STEP : CV_NORMAL);
    return finish(flag, CVodeGetReturnFlagName, "CVODE");
  }
  void restart() override {
    past_ = cost();
    enter_segment();
    rhs_ = 0;
    check(CVodeReInit(memory_, t_, y_.get()), "CVodeReInit");
  }
  Cost cost() const override {
    Cost cost = past_;
    long steps = 0, failures = 0, convergence = 0, iterations = 0, jacobians = 0, setups = 0;
    CVodeGetNumSteps(memory_, &steps);
    CVodeGetNumErrTestFails(memory_, &failures);
    CVodeGetNumNonlinSolvConvFails(memory_, &convergence);
    CVodeGetNumNonlinSolvIters(memory_, &iterations);
    if (linear_.matrix)
      CVodeGetNumJacEvals(memory_, &jacobians);
    else
      CVodeGetNumPrecEvals(memory_, &jacobians);
    CVodeGetNumLinSolvSetups(memory_, &setups);
    cost.steps += steps;
    cost.rejected += failures + convergence;
    cost.rhs += rhs_;
    cost.jacobians += jacobians;
    cost.factorizations += setups;
    cost.newton_iterations += iterations;
    return cost;
  }

 private:
  long steps() const {
    long steps = 0;
    CVodeGetNumSteps(memory_, &steps);
    return past_.steps + steps;
  }
  static int rhs(sunrealtype t, N_Vector y, N_Vector rate, void* user) {
    auto* self = static_cast<Cvode*>(user);
    return self->guarded([&] {
      ++self->rhs_;
      double* out = N_VGetArrayPointer(rate);
      self->system_.rhs(self->one_sided(t), N_VGetArrayPointer(y), out);
      require_finite(out, self->size_);
    });
  }
  static int jacobian(sunrealtype t, N_Vector y, N_Vector, SUNMatrix J, void* user, N_Vector, N_Vector,
                      N_Vector) {
    auto* self = static_cast<Cvode*>(user);
    return self->guarded([&] {
      self->system_.jacobian(self->one_sided(t), N_VGetArrayPointer(y), matrix_values(J, self->pattern_));
    });
  }

  /// 1 - gamma J by the system's own solver. CVODE says when J of an earlier step will do (jok).
  static int linear_system(sunrealtype t, N_Vector y, N_Vector, SUNMatrix, int jok, int* current,
                           sunrealtype gamma, void* user, N_Vector, N_Vector, N_Vector) {
    auto* self = static_cast<Cvode*>(user);
    return self->guarded([&] {
      if (!jok) self->newton_->linearise(self->one_sided(t), N_VGetArrayPointer(y));
      *current = !jok;
      self->newton_->factorise(gamma);
    });
  }

  /// The preconditioner, an elimination with the tangent and gamma of the last set-up.
  static int set_up(sunrealtype t, N_Vector y, N_Vector, int jok, int* current, sunrealtype gamma,
                    void* user) {
    return linear_system(t, y, nullptr, nullptr, jok, current, gamma, user, nullptr, nullptr, nullptr);
  }
  static int precondition(sunrealtype, N_Vector, N_Vector, N_Vector r, N_Vector z, sunrealtype, sunrealtype,
                          int, void* user) {
    auto* self = static_cast<Cvode*>(user);
    return self->guarded([&] {
      double* values = N_VGetArrayPointer(z);
      std::copy_n(N_VGetArrayPointer(r), self->size_, values);
      self->newton_->solve(values);
      require_finite(values, self->size_);
    });
  }

  const OdeSystem& system_;
  std::unique_ptr<NewtonSolver> newton_;
  Memory memory_;
  Cost past_;
};

}  // namespace

std::unique_ptr<AdaptiveSolver> make_cvode(const OdeSystem& system, const RunSpec& spec, bool adams,
                                           bool krylov) {
  return std::make_unique<Cvode>(system, spec, adams, krylov);
}

}  // namespace gnomon::sundials
