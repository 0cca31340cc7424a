/* small_signal_part.h - one system for small sinusoids around an operating point (small_signal.c). */
#ifndef DALCS_SMALL_SIGNAL_PART_H
#define DALCS_SMALL_SIGNAL_PART_H

#include "euler.h"
#include "lu.h"

/* One system's matrix by columns: re + j omega im, and what drives it. */
struct dalcs_small_signal_part {
    const struct dalcs_component *component;
    int n;                            /* rows and columns */
    int *p, *i;                       /* [n + 1], [p[n]] */
    double *re;                       /* [p[n]] */
    double *im;                       /* [p[n]] of 1/omega */
    double *x;                        /* [2 p[n]] scaled, at the present frequency */
    double *row_scale, *column_scale; /* [n] powers of 2 */
    double *right;                    /* [2 n] */
    double *residual;                 /* [2 n] */
    double *y[2];                     /* [n] re and im of the answer */
    double *s[2];                     /* [n_inputs] re and im of the sources */
    klu_common common;
    klu_symbolic *symbolic;
};

/* At the operating point of the component. DALCS_SINGULAR: it has no unique response at any frequency. */
enum dalcs_status dalcs_small_signal_part_setup(struct dalcs_small_signal_part *part,
                                                const struct dalcs_component *c) DALCS_MUST_CHECK;
void dalcs_small_signal_part_finish(struct dalcs_small_signal_part *part);

/* part->y. DALCS_SINGULAR: it is not unique at this frequency. */
enum dalcs_status dalcs_small_signal_part_solve(struct dalcs_small_signal_part *part,
                                                double frequency,
                                                double rcond_min) DALCS_MUST_CHECK;

/* How large an unknown at 0 Hz may be by rounding alone, where it is 0: the error of the equations that it is in. */
double dalcs_small_signal_part_rounding(const struct dalcs_small_signal_part *part, int column);

#endif
