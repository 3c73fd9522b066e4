#pragma once
// All differences between SUNDIALS 6.4 and 7 that gnomon meets stand here.
#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_logger.h>

#include <string>

namespace gnomon::sundials {

/// Where a context or a solver leaves its last error message instead of printing it.
struct Messages {
  std::string last;
};

#if SUNDIALS_VERSION_MAJOR >= 7

inline void keep_message(int, const char*, const char*, const char* text, SUNErrCode, void* data,
                         SUNContext) {
  static_cast<Messages*>(data)->last = text ? text : "";
}
inline int create_context(SUNContext* context, Messages* messages) {
  if (const int error = SUNContext_Create(SUN_COMM_NULL, context)) return error;
  SUNContext_ClearErrHandlers(*context);
  SUNContext_PushErrHandler(*context, keep_message, messages);
  SUNLogger logger = nullptr;
  if (SUNContext_GetLogger(*context, &logger) == 0 && logger) {
    SUNLogger_SetErrorFilename(logger, "/dev/null");
    SUNLogger_SetWarningFilename(logger, "/dev/null");
  }
  return 0;
}
inline void keep_cvode_messages(void*, Messages*) {}
inline void keep_ida_messages(void*, Messages*) {}
inline void keep_arkode_messages(bool, void*, Messages*) {}

#define GNOMON_ARKODE(NAME) return ARKode##NAME

#else

inline void keep_message(int code, const char*, const char*, char* text, void* data) {
  if (code < 0) static_cast<Messages*>(data)->last = text ? text : "";
}
inline int create_context(SUNContext* context, Messages*) { return SUNContext_Create(nullptr, context); }
inline void keep_cvode_messages(void* memory, Messages* messages) {
  CVodeSetErrHandlerFn(memory, keep_message, messages);
}
inline void keep_ida_messages(void* memory, Messages* messages) {
  IDASetErrHandlerFn(memory, keep_message, messages);
}
inline void keep_arkode_messages(bool erk, void* memory, Messages* messages) {
  if (erk)
    ERKStepSetErrHandlerFn(memory, keep_message, messages);
  else
    ARKStepSetErrHandlerFn(memory, keep_message, messages);
}

#define GNOMON_ARKODE(NAME) return erk ? ERKStep##NAME : ARKStep##NAME

#endif

// ARKODE's functions: 7 has one set for its two steppers, 6.4 has one for ERKStep (erk) and one for ARKStep.
inline auto arkode_evolve([[maybe_unused]] bool erk) { GNOMON_ARKODE(Evolve); }
inline auto arkode_set_tolerances([[maybe_unused]] bool erk) { GNOMON_ARKODE(SVtolerances); }
inline auto arkode_set_user_data([[maybe_unused]] bool erk) { GNOMON_ARKODE(SetUserData); }
inline auto arkode_set_max_steps([[maybe_unused]] bool erk) { GNOMON_ARKODE(SetMaxNumSteps); }
inline auto arkode_set_max_hnil([[maybe_unused]] bool erk) { GNOMON_ARKODE(SetMaxHnilWarns); }
inline auto arkode_set_stop_time([[maybe_unused]] bool erk) { GNOMON_ARKODE(SetStopTime); }
inline auto arkode_get_steps([[maybe_unused]] bool erk) { GNOMON_ARKODE(GetNumSteps); }
inline auto arkode_get_attempts([[maybe_unused]] bool erk) { GNOMON_ARKODE(GetNumStepAttempts); }
inline auto arkode_free([[maybe_unused]] bool erk) { GNOMON_ARKODE(Free); }
inline auto arkode_flag_name([[maybe_unused]] bool erk) { GNOMON_ARKODE(GetReturnFlagName); }

#undef GNOMON_ARKODE

#if SUNDIALS_VERSION_MAJOR >= 7
inline constexpr auto arkode_set_linear_solver = ARKodeSetLinearSolver;
inline constexpr auto arkode_set_jacobian = ARKodeSetJacFn;
inline constexpr auto arkode_set_delta_gamma_max = ARKodeSetDeltaGammaMax;
inline constexpr auto arkode_set_predictor = ARKodeSetPredictorMethod;
inline constexpr auto arkode_set_mass_solver = ARKodeSetMassLinearSolver;
inline constexpr auto arkode_set_mass = ARKodeSetMassFn;
inline constexpr auto arkode_set_linear_system = ARKodeSetLinSysFn;
inline constexpr auto arkode_get_jacobians = ARKodeGetNumJacEvals;
inline constexpr auto arkode_get_setups = ARKodeGetNumLinSolvSetups;
inline constexpr auto arkode_get_iterations = ARKodeGetNumNonlinSolvIters;
#else
inline constexpr auto arkode_set_linear_solver = ARKStepSetLinearSolver;
inline constexpr auto arkode_set_jacobian = ARKStepSetJacFn;
inline constexpr auto arkode_set_delta_gamma_max = ARKStepSetDeltaGammaMax;
inline constexpr auto arkode_set_predictor = ARKStepSetPredictorMethod;
inline constexpr auto arkode_set_mass_solver = ARKStepSetMassLinearSolver;
inline constexpr auto arkode_set_mass = ARKStepSetMassFn;
inline constexpr auto arkode_set_linear_system = ARKStepSetLinSysFn;
inline constexpr auto arkode_get_jacobians = ARKStepGetNumJacEvals;
inline constexpr auto arkode_get_setups = ARKStepGetNumLinSolvSetups;
inline constexpr auto arkode_get_iterations = ARKStepGetNumNonlinSolvIters;
#endif

}  // namespace gnomon::sundials
