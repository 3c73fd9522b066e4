#include "integrators/sundials/schemes.hpp"
#include "integrators/sundials/session.hpp"

namespace gnomon::sundials {
namespace {

class Ida final : public Session {
 public:
  Ida(const DaeSystem& system, const RunSpec& spec)
      : Session(system, spec), system_(system), rate_(make_vector()) {
    system.start(N_VGetArrayPointer(y_.get()), N_VGetArrayPointer(rate_.get()));
    memory_ = IDACreate(context_);
    if (!memory_) throw std::runtime_error("IDACreate failed");
    keep_ida_messages(memory_, &messages_);
    check(IDAInit(memory_, residual, 0.0, y_.get(), rate_.get()), "IDAInit");
    check(IDASetUserData(memory_, this), "IDASetUserData");
    check(IDASVtolerances(memory_, rtol_, atol_.get()), "IDASVtolerances");
    check(IDASetMaxNumSteps(memory_, max_steps_), "IDASetMaxNumSteps");
    const std::vector<int> algebraic = system.algebraic();
    std::vector<double> id(algebraic.size());
    for (std::size_t k = 0; k < id.size(); ++k) id[k] = algebraic[k] ? 0.0 : 1.0;
    id_ = make_vector(id);
    check(IDASetId(memory_, id_.get()), "IDASetId");
    linear_ = make_linear(system, y_.get(), context_);
    check(IDASetLinearSolver(memory_, linear_.solver.get(), linear_.matrix.get()), "IDASetLinearSolver");
    check(IDASetJacFn(memory_, jacobian), "IDASetJacFn");
  }
  ~Ida() override { IDAFree(&memory_); }
  Ida(const Ida&) = delete;
  Ida& operator=(const Ida&) = delete;

  Status advance(double t_stop, bool one_step) override {
    if (stop_ != t_stop) IDASetStopTime(memory_, stop_ = t_stop);
    const int flag =
        IDASolve(memory_, t_stop, &t_, y_.get(), rate_.get(), one_step ? IDA_ONE_STEP : IDA_NORMAL);
    return finish(flag, IDAGetReturnFlagName, "IDA");
  }
  void restart() override {
    past_ = cost();
    enter_segment();
    residuals_ = 0;
    check(IDAReInit(memory_, t_, y_.get(), rate_.get()), "IDAReInit");
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
  void* memory_ = nullptr;
  long residuals_ = 0;
  Cost past_;
};

}  // namespace

std::unique_ptr<AdaptiveSolver> make_ida(const DaeSystem& system, const RunSpec& spec) {
  return std::make_unique<Ida>(system, spec);
}

}  // namespace gnomon::sundials
