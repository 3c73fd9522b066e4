#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "integrators/sundials/schemes.hpp"
#include "integrators/sundials/session.hpp"
#include "integrators/sundials/tables.hpp"

namespace gnomon::sundials {
namespace {

class Arkode final : public Session {
 public:
  Arkode(const RateSystem& system, const MassSystem* mass, const RunSpec& spec, int table)
      : Session(system, spec),
        system_(system),
        erk_(is_explicit(table)),
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
      const Table explicit_one = explicit_table(static_cast<ARKODE_ERKTableID>(table));
      if (!explicit_one) throw std::runtime_error("ARKODE has no explicit table of that number");
      check(ERKStepSetTable(memory_, explicit_one.get()), "ERKStepSetTable");
    } else {
      check(ARKStepSetTableNum(memory_, static_cast<ARKODE_DIRKTableID>(table), ARKODE_ERK_NONE),
            "ARKStepSetTableNum");
      linear_ = make_linear(system, y_.get(), context_);
      check(arkode_set_linear_solver(memory_, linear_.solver.get(), linear_.matrix.get()),
            "ARKodeSetLinearSolver");
      if (!mass) check(arkode_set_jacobian(memory_, jacobian), "ARKodeSetJacFn");
      // A matrix of an old step is never good enough: where Newton has converged at once before, as on linear
      // problems, ARKODE takes its first iterate for granted, and by default the step may have changed by 20
      // % since.
      check(arkode_set_delta_gamma_max(memory_, 1e-12), "ARKodeSetDeltaGammaMax");
      // Stages are predicted by the interpolant of the last step, of an order that falls with the stage's
      // distance. By default it is the last state, which on nonlinear problems costs Newton's iteration
      // twice as much and makes it fail.
      check(arkode_set_predictor(memory_, 2), "ARKodeSetPredictorMethod");
      if (mass) {
        mass_linear_ = make_linear(system, y_.get(), context_);
        check(arkode_set_mass_solver(memory_, mass_linear_.solver.get(), mass_linear_.matrix.get(), 0),
              "ARKodeSetMassLinearSolver");
        check(arkode_set_mass(memory_, mass_matrix), "ARKodeSetMassFn");
        check(arkode_set_linear_system(memory_, linear_system), "ARKodeSetLinSysFn");
        const std::size_t n = static_cast<std::size_t>(size_);
        mass_values_.resize(pattern_ ? pattern_->row.size() : n * n);
        jacobian_values_.resize(mass_values_.size());
        mass->mass(mass_values_.data());
      }
    }
  }

  Status advance(double t_stop, bool one_step) override {
    if (stop_ != t_stop) arkode_set_stop_time(erk_)(memory_, stop_ = t_stop);
    arkode_set_max_steps(erk_)(memory_, call_limit(steps()));
    const int flag =
        arkode_evolve(erk_)(memory_, t_stop, y_.get(), &t_, one_step ? ARK_ONE_STEP : ARK_NORMAL);
    return finish(flag, arkode_flag_name(erk_), "ARKODE");
  }
  void restart() override {
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
  /// The numbers of SUNDIALS' explicit and implicit tables do not overlap.
  static bool is_explicit(int table) {
    if (table >= ARKODE_MIN_ERK_NUM && table <= ARKODE_MAX_ERK_NUM) return true;
    if (table >= ARKODE_MIN_DIRK_NUM && table <= ARKODE_MAX_DIRK_NUM) return false;
    throw std::runtime_error(fmt::format("ARKODE has no Butcher table with the number {}", table));
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

  static int mass_matrix(sunrealtype, SUNMatrix M, void* user, N_Vector, N_Vector, N_Vector) {
    auto* self = static_cast<Arkode*>(user);
    return self->guarded([&] {
      std::copy(self->mass_values_.begin(), self->mass_values_.end(), matrix_values(M, self->pattern_));
    });
  }
  /// M - gamma J, entry by entry. SUNDIALS' own sum of sparse matrices costs the square of their size.
  static int linear_system(sunrealtype t, N_Vector y, N_Vector, SUNMatrix A, SUNMatrix, int jok, int* current,
                           sunrealtype gamma, void* user, N_Vector, N_Vector, N_Vector) {
    auto* self = static_cast<Arkode*>(user);
    return self->guarded([&] {
      if (!jok)
        self->system_.jacobian(self->one_sided(t), N_VGetArrayPointer(y), self->jacobian_values_.data());
      *current = !jok;
      double* values = matrix_values(A, self->pattern_);
      for (std::size_t k = 0; k < self->mass_values_.size(); ++k)
        values[k] = self->mass_values_[k] - gamma * self->jacobian_values_[k];
    });
  }

  const RateSystem& system_;
  std::vector<double> mass_values_, jacobian_values_;  ///< where there is a mass matrix
  Linear mass_linear_;
  bool erk_;
  Memory memory_;
  Cost past_;
};

}  // namespace

std::unique_ptr<AdaptiveSolver> make_arkode(const OdeSystem& system, const RunSpec& spec, int table) {
  return std::make_unique<Arkode>(system, nullptr, spec, table);
}
std::unique_ptr<AdaptiveSolver> make_arkode(const MassSystem& system, const RunSpec& spec, int table) {
  return std::make_unique<Arkode>(system, &system, spec, table);
}

}  // namespace gnomon::sundials
