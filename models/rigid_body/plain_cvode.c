#define _POSIX_C_SOURCE 200809L
#include "models/rigid_body/plain_cvode.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sundials/sundials_config.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
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

static int jacobian(sunrealtype t, N_Vector state, N_Vector rate, SUNMatrix matrix, void* user, N_Vector a,
                    N_Vector b, N_Vector c) {
  const double* y = N_VGetArrayPointer(state);
  const double* I = ((const Body*)user)->inertia;
  double* J = SUNDenseMatrix_Data(matrix); /* column by column */
  const double r0 = 1.0 / I[0], r1 = 1.0 / I[1], r2 = 1.0 / I[2];
  const double w0 = y[4] * r0, w1 = y[5] * r1, w2 = y[6] * r2;
  (void)t, (void)rate, (void)a, (void)b, (void)c;
  memset(J, 0, 49 * sizeof(double));
  J[7] = -0.5 * w0, J[14] = -0.5 * w1, J[21] = -0.5 * w2;
  J[1] = 0.5 * w0, J[15] = 0.5 * w2, J[22] = -0.5 * w1;
  J[2] = 0.5 * w1, J[9] = -0.5 * w2, J[23] = 0.5 * w0;
  J[3] = 0.5 * w2, J[10] = 0.5 * w1, J[17] = -0.5 * w0;
  J[28] = -0.5 * y[1] * r0, J[35] = -0.5 * y[2] * r1, J[42] = -0.5 * y[3] * r2;
  J[29] = 0.5 * y[0] * r0, J[36] = -0.5 * y[3] * r1, J[43] = 0.5 * y[2] * r2;
  J[30] = 0.5 * y[3] * r0, J[37] = 0.5 * y[0] * r1, J[44] = -0.5 * y[1] * r2;
  J[31] = -0.5 * y[2] * r0, J[38] = 0.5 * y[1] * r1, J[45] = 0.5 * y[0] * r2;
  J[39] = y[6] * (r2 - r1), J[46] = y[5] * (r2 - r1);
  J[47] = y[4] * (r0 - r2), J[33] = y[6] * (r0 - r2);
  J[34] = y[5] * (r1 - r0), J[41] = y[4] * (r1 - r0);
  return 0;
}

static double thread_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double gnomon_plain_cvode(const double inertia[3], double y[7], double t_end, double rtol,
                          const double atol[7], long* evaluations) {
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
  SUNMatrix matrix = SUNDenseMatrix(7, 7, context);
  SUNLinearSolver solver = SUNLinSol_Dense(state, matrix, context);
  double seconds = -1.0;
  if (memory && solver && CVodeInit(memory, rates, 0.0, state) == CV_SUCCESS &&
      CVodeSetUserData(memory, &body) == CV_SUCCESS &&
      CVodeSVtolerances(memory, rtol, absolute) == CV_SUCCESS &&
      CVodeSetMaxNumSteps(memory, 100000000) == CV_SUCCESS &&
      CVodeSetLinearSolver(memory, solver, matrix) == CV_SUCCESS &&
      CVodeSetJacFn(memory, jacobian) == CV_SUCCESS && CVodeSetStopTime(memory, t_end) == CV_SUCCESS) {
    sunrealtype t = 0.0;
    const double begin = thread_seconds();
    const int flag = CVode(memory, t_end, state, &t, CV_NORMAL);
    const double end = thread_seconds();
    if (flag >= 0) seconds = end - begin;
    CVodeGetNumRhsEvals(memory, evaluations);
    for (int k = 0; k < 7; ++k) y[k] = N_VGetArrayPointer(state)[k];
  }
  CVodeFree(&memory);
  SUNLinSolFree(solver);
  SUNMatDestroy(matrix);
  N_VDestroy(state);
  N_VDestroy(absolute);
  SUNContext_Free(&context);
  return seconds;
}
