/* scales.h - what residuals and wrong signs of an answer are measured against.
 *
 * Each row against its own terms: the answer is then one of equations whose coefficients are off by the tolerance, each
 * in proportion to itself (Oettli and Prager, Numer. Math. 6, 1964), whatever the units, and however large other
 * voltages are. Where terms are as small as rounding of the whole can make them they say nothing, and the row's norm
 * times the largest voltage and current is added (Arioli, Demmel and Duff, SIAM J. Matrix Anal. Appl. 10, 1989).
 * These vouch for each other through a thousandth of the typical conductance and resistance, so that a part without
 * current is not asked for more digits than its voltages have. Private to src/osnsp. */
#ifndef DALCS_SCALES_H
#define DALCS_SCALES_H

#include "osnsp_internal.h"

struct dalcs_scales {
    double volt, ampere;
};

/* The largest voltage and current that sources, thresholds and states put in. */
struct dalcs_scales dalcs_scales_driving(const struct dalcs_osnsp *p, const double *u);

/* And those of the answer, see above. */
struct dalcs_scales dalcs_scales_physical(const struct dalcs_osnsp *p, struct dalcs_scales drive,
                                          const double *y);

/* The magnitude that row r can have at these voltages and currents: its norm times theirs. */
static inline double dalcs_scales_norm(const struct dalcs_step_form *f, struct dalcs_scales scale,
                                       int r) {
    return f->checks.volts[r] * scale.volt + f->checks.amperes[r] * scale.ampere;
}

/* What the terms of row i of `check` add up to; y is the answer. */
double dalcs_scales_row_terms(const struct dalcs_osnsp *p, const double *u, const double *y, int i);

/* The same of row r of the system, without what is stored. */
double dalcs_scales_terms(const struct dalcs_system *s, const double *u, const double *y, int r);

/* Of the equations that hold the current of a pair; of its voltage. */
double dalcs_scales_current_terms(const struct dalcs_osnsp *p, const double *u, const double *y,
                                  int pair);
double dalcs_scales_pair_terms(const struct dalcs_osnsp *p, const double *u, const double *y,
                               int pair);

/* The same of the equations that hold what is in series with a closed pair, too: the currents of closed pairs and of V sources
 * are known no better than the KCL where they end. An ammeter beside a diode changes nothing. */
double dalcs_scales_series_terms(struct dalcs_osnsp *p, const double *u, const double *y, int pair);

/* The largest norm of the rows in A, or V: what they give is known no better where it should be 0. */
double dalcs_scales_of_rows(const struct dalcs_osnsp *p, struct dalcs_scales scale,
                            bool is_current);

/* The norm of a pair's current: it is known no better than the KCL that it enters. */
double dalcs_scales_current_norm(const struct dalcs_osnsp *p, int pair, struct dalcs_scales scale);

/* The scale of a row with these terms and this norm. */
double dalcs_scales_own(const struct dalcs_osnsp *p, double terms, double norm);

#endif
