#define _POSIX_C_SOURCE 200809L
#include "models/rigid_body/plain_cvode.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#include <time.h>

typedef struct {
  double inertia[3];
} Body;

static int rates(sunrealtype t, N_Vector state, N_Vector rate, void* user) {
  const double* y = N_VGetArrayPointer(state);
  const double* I = ((const Body*)user)->inertia;
  double* f = N_VGetArrayPointer(rate);
  const double w0 = y[4] / I[0], w1 = y[5] / I[1], w2 = y[6] / I[2];
  (void)t;
  f[0] = 0.5 * (-y[1] * w0 - y[2] * w1 - y[3] * w2);
  f[1] = 0.5 * (y[0] * w0 + y[2] * w2 - y[3] * w1);
  f[2] = 0.5 * (y[0] * w1 + y[3] * w0 - y[1] * w2);
  f[3] = 0.5 * (y[0] * w2 + y[1] * w1 - y[2] * w0);
  f[4] = y[5] * w2 - y[6] * w1;
  f[5] = y[6] * w0 - y[4] * w2;
  f[6] = y[4] * w1 - y[5] * w0;
  return 0;
}

static double thread_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double gnomon_plain_cvode(const double inertia[3], double y[7], double t_end, double rtol, const double atol[7],
                          long* evaluations) {
  Body body = {{inertia[0], inertia[1], inertia[2]}};
  SUNContext context = NULL;
#if SUNDIALS_VERSION_MAJOR >= 7
  if (SUNContext_Create(SUN_COMM_NULL, &context) != 0) return -1.0;
#else
  if (SUNContext_Create(NULL, &context) != 0) return -1.0;
#endif
  N_Vector state = N_VNew_Serial(7, context), absolute = N_VNew_Serial(7, context);
  for (int k = 0; k < 7; ++k) {
    N_VGetArrayPointer(state)[k] = y[k];
    N_VGetArrayPointer(absolute)[k] = atol[k];
  }
  void* memory = CVodeCreate(CV_ADAMS, context);
  SUNNonlinearSolver solver = SUNNonlinSol_FixedPoint(state, 0, context);
  double seconds = -1.0;
  if (memory && solver && CVodeInit(memory, rates, 0.0, state) == CV_SUCCESS &&
      CVodeSetUserData(memory, &body) == CV_SUCCESS && CVodeSVtolerances(memory, rtol, absolute) == CV_SUCCESS &&
      CVodeSetMaxNumSteps(memory, 100000000) == CV_SUCCESS &&
      CVodeSetNonlinearSolver(memory, solver) == CV_SUCCESS && CVodeSetStopTime(memory, t_end) == CV_SUCCESS) {
    sunrealtype t = 0.0;
    const double begin = thread_seconds();
    const int flag = CVode(memory, t_end, state, &t, CV_NORMAL);
    const double end = thread_seconds();
    if (flag >= 0) seconds = end - begin;
    CVodeGetNumRhsEvals(memory, evaluations);
    for (int k = 0; k < 7; ++k) y[k] = N_VGetArrayPointer(state)[k];
  }
  CVodeFree(&memory);
  SUNNonlinSolFree(solver);
  N_VDestroy(state);
  N_VDestroy(absolute);
  SUNContext_Free(&context);
  return seconds;
}
