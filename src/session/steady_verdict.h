/* steady_verdict.h - what an orbit is worth, and what a run comes to that leaves it. Private to this folder. */
#ifndef DALCS_STEADY_VERDICT_H
#define DALCS_STEADY_VERDICT_H

#include "steady.h"

/* ---- steady_report.c --------------------------------------------------------------------------- */

/* Multipliers, verdict and messages into the report. */
enum dalcs_status dalcs_steady_report(struct dalcs_steady *st) DALCS_MUST_CHECK;

/* Does a small difference grow? What no period changes does not. */
bool dalcs_steady_is_unstable(const struct dalcs_report *report);

/* Averages and rms values of the last pass with means, alone. */
enum dalcs_status dalcs_steady_report_signals(struct dalcs_steady *st) DALCS_MUST_CHECK;

/* st->at is on an orbit of two periods `one`: its multipliers and the verdict into the report of that of one. */
enum dalcs_status dalcs_steady_report_double(struct dalcs_steady *st, double one) DALCS_MUST_CHECK;

/* What a run comes to beside the orbit of the report, which is unstable: into its verdict. st->at is on it, if it is an
 * orbit. */
enum dalcs_status
dalcs_steady_report_attractor(struct dalcs_steady *st, double one,
                              const struct dalcs_steady_attractor *a) DALCS_MUST_CHECK;

/* ---- steady_doubling.c ------------------------------------------------------------------------- */

/* st has an orbit of n periods `one`. If it is one of fewer, and unstable, one of n takes its place where a run finds it. */
enum dalcs_status dalcs_steady_replace(struct dalcs_steady *st, double one, int n) DALCS_MUST_CHECK;

/* st has an orbit that two periods differ on: whether a run goes to one of two periods, into the report. st->at is
 * somewhere then. */
enum dalcs_status dalcs_steady_look_for_double(struct dalcs_steady *st) DALCS_MUST_CHECK;

/* st->at by a hundredth of the scales away, each state by another part. */
void dalcs_steady_step_aside(struct dalcs_steady *st);

/* After how many of n periods `one` does the orbit through st->at come back? */
enum dalcs_status dalcs_steady_find_repeat(struct dalcs_steady *st, double one, int n,
                                           int *first) DALCS_MUST_CHECK;

/* To an orbit of that period, with its last pass. */
enum dalcs_status dalcs_steady_go_back(struct dalcs_steady *st,
                                       const struct dalcs_orbit_point *orbit,
                                       double period) DALCS_MUST_CHECK;

/* ---- steady_attractor.c ------------------------------------------------------------------------ */

/* What a run comes to. */
struct dalcs_steady_attractor {
    enum {
        DALCS_STEADY_UNKNOWN,
        DALCS_STEADY_ORBIT,    /* stable, of n periods */
        DALCS_STEADY_SETTLING, /* differences fade, and no orbit was found */
        DALCS_STEADY_TORUS,
        DALCS_STEADY_CHAOS
    } kind;

    int n;
    double growth; /* of a small difference in each period; of an orbit its largest multiplier */
};

/* The run from st->at on, which leaves an orbit beside which differences grow by that; 0: it leaves none. Behind an orbit
 * st->at and st->period are its own, and the last pass is with M; else st->period stays. */
enum dalcs_status dalcs_steady_find_attractor(struct dalcs_steady *st, double growth,
                                              struct dalcs_steady_attractor *a) DALCS_MUST_CHECK;

/* ---- steady_beside.c --------------------------------------------------------------------------- */

/* st has an unstable orbit: what a run comes to that leaves it, into the report. st stays. */
enum dalcs_status dalcs_steady_look_beside(struct dalcs_steady *st) DALCS_MUST_CHECK;

/* No orbit was found, and st->at is where a run has come to: *found: it comes to one of n periods. */
enum dalcs_status dalcs_steady_look_ahead(struct dalcs_steady *st, bool *found,
                                          struct dalcs_steady_attractor *a) DALCS_MUST_CHECK;

/* ---- steady_from_rest.c ------------------------------------------------------------------------ */

/* A few periods of a search from the operating point, and as many of one from IC= and 0, unless any run starts there. If not
 * *found and not *endless st is as before. */
enum dalcs_status dalcs_steady_search_early(struct dalcs_steady *st, bool *found,
                                            bool *endless) DALCS_MUST_CHECK;

/* The search from the operating point has found nothing, and a run from there comes to that, or st->kept.drift goes on without
 * end: a search from IC= and 0, unless that was its start, or the run is chaotic. If not *found st is where it was. */
enum dalcs_status dalcs_steady_search_from_rest(struct dalcs_steady *st,
                                                const struct dalcs_steady_attractor *a,
                                                bool *found) DALCS_MUST_CHECK;

#endif
