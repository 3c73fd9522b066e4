#ifndef GNOMON_MODELS_RIGID_BODY_PLAIN_CVODE_H
#define GNOMON_MODELS_RIGID_BODY_PLAIN_CVODE_H

#ifdef __cplusplus
extern "C" {
#endif

/* The free rigid body by a plain C call of CVODE Adams with Newton and a dense Jacobian, as its manual shows
   it: the yardstick for what gnomon's wrapper costs. inertia [kg m^2]; y = (q, m) of 7 components at t = 0,
   at t_end on return; atol per component. Returns the thread CPU time of the integration [s], negative on
   failure; *evaluations counts the right-hand sides. */
double gnomon_plain_cvode(const double inertia[3], double y[7], double t_end, double rtol,
                          const double atol[7], long* evaluations);

#ifdef __cplusplus
}
#endif

#endif
