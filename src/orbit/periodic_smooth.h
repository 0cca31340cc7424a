/* periodic_smooth.h - what smooth sources make of a small perturbation in a piece of a period.
 *
 * A source f(x) of what it reads answers dx by f'(x) dx, x along the orbit: the coefficients of the linear circuit depend
 * on time. Within a piece the answer is the polynomial through its values at the nodes, as in a step of a run
 * (smooth_step.h), so that with S the derivatives of all dx by these values, (1 - f' S) d phi = f' dx. */
#ifndef DALCS_PERIODIC_SMOOTH_H
#define DALCS_PERIODIC_SMOOTH_H

#include "periodic_flow.h"
#include "smooth_newton.h"

struct dalcs_flow_smooth {
    struct dalcs_smooth_newton newton;
    int first;       /* excitation function of theirs: s + 1 Legendre polynomials of each */
    double *unit;    /* [newton.n][size of an answer] by the value of a source at a node alone */
    double (*dx)[2]; /* [newton.n] */
};

/* flow->smooth, behind its stages. */
enum dalcs_status dalcs_flow_smooth_setup(struct dalcs_periodic_flow *flow,
                                          int first) DALCS_MUST_CHECK;

/* For the piece of length h from t on, in the span. */
enum dalcs_status dalcs_flow_smooth_begin(struct dalcs_periodic_flow *flow,
                                          struct dalcs_stage_entry *entry,
                                          const struct dalcs_orbit_span *span, double t,
                                          double h) DALCS_MUST_CHECK;

/* out: of a piece without them, then with them. */
void dalcs_flow_smooth_vary(struct dalcs_periodic_flow *flow, double *out);

#endif
