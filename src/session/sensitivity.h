/* sensitivity.h - what the measurements of a periodic steady state change by with a value of the netlist.
 *
 * The orbit of a circuit with a value p + d p is found by Newton's method from the orbit at p, with the M of its own, and
 * measured as that is. Differences of four such orbits, at d = h, -h, 2h and -2h, give derivatives to the fourth order
 * of h. The variation of the orbit itself would need, of each kind of measurement, a derivative of its own: of extremes,
 * crossings, products, quotients. Here whatever can be measured is differentiated by the measurement. The price is a
 * few periods for each value, where the adjoint takes one backward period for each measurement. */
#ifndef DALCS_SENSITIVITY_H
#define DALCS_SENSITIVITY_H

#include "steady.h"

/* Where the search for the orbit of another circuit begins, and what the orbit found is like. */
struct dalcs_steady_near {
    struct dalcs_orbit_point point;
    int n_x, n_pairs;
    double period;      /* s, of it */
    uint64_t signature; /* out: of the modes that follow each other */
};

/* st->at becomes the orbit that Newton's method finds from there. DALCS_NOT_CONVERGED, without a message: none. */
enum dalcs_status dalcs_steady_from_near(struct dalcs_steady *st, bool is_free,
                                         struct dalcs_steady_near *near) DALCS_MUST_CHECK;

/* All of .sens around the orbit through st->at, into the report. */
enum dalcs_status dalcs_sensitivities_run(struct dalcs_steady *st) DALCS_MUST_CHECK;

/* ---- sensitivity_report.c ---------------------------------------------------------------------- */

/* How many results a report of a steady state has, and each of them with its value. */
size_t dalcs_sensitivity_count(const struct dalcs_report *report);
struct dalcs_sensitivity_result dalcs_sensitivity_get(const struct dalcs_report *report, size_t k);

/* What the errors of the k-th of all[n] results are measured by: of an average, the rms. */
double dalcs_sensitivity_scale(const struct dalcs_sensitivity_result *all, size_t n, size_t k);

#endif
