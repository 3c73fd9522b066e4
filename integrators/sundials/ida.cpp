#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "integrators/sundials/index.hpp"
#include "integrators/sundials/schemes.hpp"
#include "integrators/sundials/session.hpp"

namespace gnomon::sundials {
namespace {

class Ida final : public Session {
 public:
  Ida(const DaeSystem& system, const RunSpec& spec, bool check_index)
      : Session(system, spec), system_(system), rate_(make_vector()), memory_(IDACreate(context_), IDAFree) {
    system.start(N_VGetArrayPointer(y_.get()));
    if (check_index && index_exceeds_one(system)) too_high_index_ = true;
    if (!memory_) throw std::runtime_error("IDACreate failed");
    keep_ida_messages(memory_, &messages_);
    check(IDAInit(memory_, residual, 0.0, y_.get(), rate_.get()), "IDAInit");
    check(IDASetUserData(memory_, this), "IDASetUserData");
    check(IDASVtolerances(memory_, rtol_, atol_.get()), "IDASVtolerances");
    const std::vector<int> algebraic = system.algebraic();
    std::vector<double> id(algebraic.size());
    for (std::size_t k = 0; k < id.size(); ++k) id[k] = algebraic[k] ? 0.0 : 1.0;
    id_ = make_vector(id);
    check(IDASetId(memory_, id_.get()), "IDASetId");
    linear_ = make_linear(system, y_.get(), context_);
    check(IDASetLinearSolver(memory_, linear_.solver.get(), linear_.matrix.get()), "IDASetLinearSolver");
    check(IDASetJacFn(memory_, jacobian), "IDASetJacFn");
  }

  Status advance(double t_stop, bool one_step) override {
    if (too_high_index_) {
      message_ =
          "the DAE form has index 2 or more at its start: Newton's matrix becomes singular as the step tends "
          "to 0, so IDA's error test does not control what the algebraic variables do";
      return Status::solver_failed;
    }
    if (behind_break_ && !go_on()) {
      message_ = fmt::format("IDA at t = {:.6g} s: the values just behind it are not finite", t_);
      return Status::solver_failed;
    }
    if (stop_ != t_stop) IDASetStopTime(memory_, stop_ = t_stop);
    IDASetMaxNumSteps(memory_, call_limit(steps()));
    const int flag =
        IDASolve(memory_, t_stop, &t_, y_.get(), rate_.get(), one_step ? IDA_ONE_STEP : IDA_NORMAL);
    return finish(flag, IDAGetReturnFlagName, "IDA");
  }
  void restart() override {
    past_ = cost();
    enter_segment();
    residuals_ = 0;
    behind_break_ = true;
  }
  Cost cost() const override {
    Cost cost = past_;
    long steps = 0, failures = 0, convergence = 0, iterations = 0, jacobians = 0, setups = 0;
    IDAGetNumSteps(memory_, &steps);
    IDAGetNumErrTestFails(memory_, &failures);
    IDAGetNumNonlinSolvConvFails(memory_, &convergence);
    IDAGetNumNonlinSolvIters(memory_, &iterations);
    IDAGetNumJacEvals(memory_, &jacobians);
    IDAGetNumLinSolvSetups(memory_, &setups);
    cost.steps += steps;
    cost.rejected += failures + convergence;
    cost.rhs += residuals_;
    cost.jacobians += jacobians;
    cost.factorizations += setups;
    cost.newton_iterations += iterations;
    return cost;
  }

 private:
  /// Until the first step behind a break, or behind the start, y is the limit from the left.
  bool go_on() {
    std::vector<double> y(this->y(), this->y() + size_), rate(y.size());
    system_.resume(t_, y.data(), rate.data());
    if (!all_finite(y) || !all_finite(rate)) return false;
    std::copy(y.begin(), y.end(), N_VGetArrayPointer(y_.get()));
    std::copy(rate.begin(), rate.end(), N_VGetArrayPointer(rate_.get()));
    check(IDAReInit(memory_, t_, y_.get(), rate_.get()), "IDAReInit");
    behind_break_ = false;
    return true;
  }
  long steps() const {
    long steps = 0;
    IDAGetNumSteps(memory_, &steps);
    return past_.steps + steps;
  }
  static int residual(sunrealtype t, N_Vector y, N_Vector rate, N_Vector value, void* user) {
    auto* self = static_cast<Ida*>(user);
    return self->guarded([&] {
      ++self->residuals_;
      double* out = N_VGetArrayPointer(value);
      self->system_.residual(self->one_sided(t), N_VGetArrayPointer(y), N_VGetArrayPointer(rate), out);
      require_finite(out, self->size_);
    });
  }
  static int jacobian(sunrealtype t, sunrealtype cj, N_Vector y, N_Vector rate, N_Vector, SUNMatrix J,
                      void* user, N_Vector, N_Vector, N_Vector) {
    auto* self = static_cast<Ida*>(user);
    return self->guarded([&] {
      self->system_.jacobian(self->one_sided(t), cj, N_VGetArrayPointer(y), N_VGetArrayPointer(rate),
                             matrix_values(J, self->pattern_));
    });
  }

  const DaeSystem& system_;
  Vector rate_;
  Vector id_;
  Memory memory_;
  bool behind_break_ = true;
  bool too_high_index_ = false;
  long residuals_ = 0;
  Cost past_;
};

}  // namespace

std::unique_ptr<AdaptiveSolver> make_ida(const DaeSystem& system, const RunSpec& spec, bool check_index) {
  return std::make_unique<Ida>(system, spec, check_index);
}

}  // namespace gnomon::sundials
