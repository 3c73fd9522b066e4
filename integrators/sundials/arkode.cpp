#include "integrators/sundials/schemes.hpp"
#include "integrators/sundials/session.hpp"

namespace gnomon::sundials {
namespace {

class Arkode final : public Session {
 public:
  Arkode(const OdeSystem& system, const RunSpec& spec, bool implicit, const char* table)
      : Session(system, spec),
        system_(system),
        erk_(!implicit),
        memory_((system.start(N_VGetArrayPointer(y_.get())), erk_)
                    ? ERKStepCreate(rhs, 0.0, y_.get(), context_)
                    : ARKStepCreate(nullptr, rhs, 0.0, y_.get(), context_),
                arkode_free(erk_)) {
    if (!memory_) throw std::runtime_error("ERKStepCreate or ARKStepCreate failed");
    keep_arkode_messages(erk_, memory_, &messages_);
    check(arkode_set_user_data(erk_)(memory_, this), "ARKodeSetUserData");
    check(arkode_set_tolerances(erk_)(memory_, rtol_, atol_.get()), "ARKodeSVtolerances");
    check(arkode_set_max_hnil(erk_)(memory_, -1), "ARKodeSetMaxHnilWarns");
    if (erk_) {
      check(ERKStepSetTableName(memory_, table), "ERKStepSetTableName");
    } else {
      check(ARKStepSetTableName(memory_, table, "ARKODE_ERK_NONE"), "ARKStepSetTableName");
      linear_ = make_linear(system, y_.get(), context_);
      check(arkode_set_linear_solver(memory_, linear_.solver.get(), linear_.matrix.get()),
            "ARKodeSetLinearSolver");
      check(arkode_set_jacobian(memory_, jacobian), "ARKodeSetJacFn");
      // A matrix of an old step is never good enough: where Newton has converged at once before, as on linear
      // problems, ARKODE takes its first iterate for granted, and by default the step may have changed by 20
      // % since.
      check(arkode_set_delta_gamma_max(memory_, 1e-12), "ARKodeSetDeltaGammaMax");
    }
  }

  Status advance(double t_stop, bool one_step) override {
    if (stop_ != t_stop) arkode_set_stop_time(erk_)(memory_, stop_ = t_stop);
    arkode_set_max_steps(erk_)(memory_, call_limit(steps()));
    const int flag =
        arkode_evolve(erk_)(memory_, t_stop, y_.get(), &t_, one_step ? ARK_ONE_STEP : ARK_NORMAL);
    return finish(flag, arkode_flag_name(erk_), "ARKODE");
  }
  void restart(double) override {
    past_ = cost();
    enter_segment();
    rhs_ = 0;
    if (erk_)
      check(ERKStepReInit(memory_, rhs, t_, y_.get()), "ERKStepReInit");
    else
      check(ARKStepReInit(memory_, nullptr, rhs, t_, y_.get()), "ARKStepReInit");
  }
  Cost cost() const override {
    Cost cost = past_;
    long steps = 0, attempts = 0;
    arkode_get_steps(erk_)(memory_, &steps);
    arkode_get_attempts(erk_)(memory_, &attempts);
    cost.steps += steps;
    cost.rejected += attempts - steps;
    cost.rhs += rhs_;
    if (!erk_) {
      long iterations = 0, jacobians = 0, setups = 0;
      arkode_get_iterations(memory_, &iterations);
      arkode_get_jacobians(memory_, &jacobians);
      arkode_get_setups(memory_, &setups);
      cost.newton_iterations += iterations;
      cost.jacobians += jacobians;
      cost.factorizations += setups;
    }
    return cost;
  }

 private:
  long steps() const {
    long steps = 0;
    arkode_get_steps(erk_)(memory_, &steps);
    return past_.steps + steps;
  }
  static int rhs(sunrealtype t, N_Vector y, N_Vector rate, void* user) {
    auto* self = static_cast<Arkode*>(user);
    return self->guarded([&] {
      ++self->rhs_;
      double* out = N_VGetArrayPointer(rate);
      self->system_.rhs(self->one_sided(t), N_VGetArrayPointer(y), out);
      require_finite(out, self->size_);
    });
  }
  static int jacobian(sunrealtype t, N_Vector y, N_Vector, SUNMatrix J, void* user, N_Vector, N_Vector,
                      N_Vector) {
    auto* self = static_cast<Arkode*>(user);
    return self->guarded([&] {
      self->system_.jacobian(self->one_sided(t), N_VGetArrayPointer(y), matrix_values(J, self->pattern_));
    });
  }

  const OdeSystem& system_;
  bool erk_;
  Memory memory_;
  Cost past_;
};

}  // namespace

std::unique_ptr<AdaptiveSolver> make_arkode(const OdeSystem& system, const RunSpec& spec, bool implicit,
                                            const char* table) {
  return std::make_unique<Arkode>(system, spec, implicit, table);
}

}  // namespace gnomon::sundials
