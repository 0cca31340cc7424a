/* sensitivity.h - what the measurements of a periodic steady state change by with a value of the netlist.
 *
 * Differences of four circuits whose values are p + d, at d = h, -h, 2h and -2h, give derivatives to the fourth order of
 * h. What is measured is a period along the tangent of the orbit (sensitivity_tangent.c), or, where that cannot be, the
 * orbit of the other circuit, which Newton's method finds from this one. The variation of the orbit itself would need, of
 * each kind of measurement, a derivative of its own: of extremes, crossings, products, quotients. Here whatever can be
 * measured is differentiated by the measurement. */
#ifndef DALCS_SENSITIVITY_H
#define DALCS_SENSITIVITY_H

#include "steady.h"

enum dalcs_near_asked {
    DALCS_NEAR_ORBIT,  /* the orbit that Newton's method finds from the point */
    DALCS_NEAR_IMAGE,  /* a period from the point */
    DALCS_NEAR_MEASURE /* what that measures, as if it were an orbit */
};

/* A circuit with values that differ by little, and its results. */
struct dalcs_steady_near {
    enum dalcs_near_asked asked;
    struct dalcs_orbit_point point; /* of the other's orbit, or beside it */
    int n_x, n_pairs;
    double period;      /* s, of it */
    uint64_t signature; /* out: of the modes that follow each other */
    struct dalcs_steady
        *orbit; /* out, unless NULL: where it is, with its M, as if it were this one's last pass */
    double *image; /* [n_x] out: where a period leads to */
};

/* st->at becomes the orbit that Newton's method finds from there. DALCS_NOT_CONVERGED, without a message: none. */
enum dalcs_status dalcs_steady_from_near(struct dalcs_steady *st, bool is_free,
                                         struct dalcs_steady_near *near) DALCS_MUST_CHECK;

/* The others of what is asked: a period from the point, and st->found of it. */
enum dalcs_status dalcs_steady_at_near(struct dalcs_steady *st, bool is_free,
                                       struct dalcs_steady_near *near) DALCS_MUST_CHECK;

/* Is there more to measure than averages and rms values, for which a period has to be run with rows? */
bool dalcs_steady_near_measures(const struct dalcs_circuit *circuit);

/* All of .sens around the orbit through st->at, into the report. */
enum dalcs_status dalcs_sensitivities_run(struct dalcs_steady *st) DALCS_MUST_CHECK;

/* ---- sensitivity_report.c ---------------------------------------------------------------------- */

/* The number of results of a report of a steady state, and each of them with its value. */
size_t dalcs_sensitivity_count(const struct dalcs_report *report);
struct dalcs_sensitivity_result dalcs_sensitivity_get(const struct dalcs_report *report, size_t k);

/* What the errors of the k-th of all[n] results are measured by: of an average, the rms. */
double dalcs_sensitivity_scale(const struct dalcs_sensitivity_result *all, size_t n, size_t k);

#endif
