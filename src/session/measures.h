/* measures.h - .meas and .four while a run goes on, and what they gave in the report. */
#ifndef DALCS_MEASURES_H
#define DALCS_MEASURES_H

#include "audit_measures.h"
#include "edges_ahead.h"
#include "impulses.h"
#include "measuring.h"
#include "rows.h"
#include "session_internal.h"

/* Zero-initialise; without a start nothing is measured and nothing costs anything. */
struct dalcs_measures {
    bool wanted;
    struct dalcs_measuring measuring;
    const struct dalcs_network *network;
    struct dalcs_rows rows; /* of radau: the measured signals */
    bool *reads;            /* [n_systems] components that measured signals come from */
    int n_stimuli;
    const struct dalcs_stimulus **stimulus; /* [n_stimuli] those that drive them and vary */
    struct dalcs_edges_ahead edges;         /* theirs */
    struct dalcs_stimulus_term *term;       /* work */
    double t;                               /* s, measured so far */
    double begin;                           /* s, before which nothing is; INFINITY without .meas */
    double next_edge;                       /* s, of the stimuli; INFINITY without .meas */
    struct dalcs_losses_run *losses;        /* NULL: not asked for */
    struct dalcs_impulses *impulses;        /* borrowed */
    double *before, *now; /* [n_measured] of euler, at the ends of a step; or of a row */
    struct dalcs_audit_measures audit;
    struct dalcs_side_means sides; /* of radau */
};

/* Before the first segment of a transient, and after its start: radau is NULL with implicit Euler. */
enum dalcs_status dalcs_measures_prepare(struct dalcs_measures *measures, struct dalcs_run *r,
                                         struct dalcs_radau *radau) DALCS_MUST_CHECK;
enum dalcs_status dalcs_measures_start(struct dalcs_measures *measures, struct dalcs_run *r,
                                       const struct dalcs_euler *e, struct dalcs_radau *radau,
                                       struct dalcs_audit_run *audit) DALCS_MUST_CHECK;
void dalcs_measures_finish(struct dalcs_measures *measures);

/* Up to t, before the segments that end there are passed; `near`: s, times that are the same. */
enum dalcs_status dalcs_measures_reach(struct dalcs_measures *measures,
                                       const struct dalcs_radau *radau, double t,
                                       double near) DALCS_MUST_CHECK;

/* A stretch ends at t, though no source says so: gates may write what it is from there on. */
void dalcs_measures_end_at(struct dalcs_measures *measures, double t);

/* Sources may be others from t on, which was reached. */
void dalcs_measures_renew(struct dalcs_measures *measures, double t);

/* What lies before t, which is before `begin`, is passed over. */
void dalcs_measures_skip(struct dalcs_measures *measures, double t);

/* After a step of implicit Euler, and after it crossed a discontinuity. */
void dalcs_measures_step(struct dalcs_measures *measures, const struct dalcs_euler *e);
void dalcs_measures_cross(struct dalcs_measures *measures, const struct dalcs_euler *e);

/* The results into the report; warnings about what could not be measured. status: of the run. */
enum dalcs_status dalcs_measures_report(struct dalcs_measures *measures, struct dalcs_run *r,
                                        enum dalcs_status status) DALCS_MUST_CHECK;

/* For an analysis that has rows: the measured signals among the outputs `value`. */
enum dalcs_status dalcs_measures_start_rows(struct dalcs_measures *measures, struct dalcs_run *r,
                                            enum dalcs_measured_analysis analysis, double start,
                                            double stop) DALCS_MUST_CHECK;
void dalcs_measures_row(struct dalcs_measures *measures, double at,
                        const double *value /* [n_outputs] */);
void dalcs_measures_complex_row(struct dalcs_measures *measures, double at,
                                const double *value /* [n_outputs] pairs of real and imaginary */);

/* ---- measures_impulses.c -------------------------------------------------------------------------- */

/* Those at t, into measures->measuring; false: there are none. */
bool dalcs_measures_find_impulses(struct dalcs_measures *measures, double t);

/* Of the last step of implicit Euler, which holds an impulse as a value, whose straight lines to others have another area: it
 * is not known. */
bool dalcs_measures_find_blurred(struct dalcs_measures *measures);

/* ---- fourier_report.c ----------------------------------------------------------------------------- */

/* The same for all formulas of a card. */
const struct dalcs_measure_card *dalcs_measures_failed_source(const struct dalcs_circuit *c,
                                                              const struct dalcs_measure_card *card,
                                                              const double *results);

enum dalcs_status dalcs_measures_tell_harmonics(struct dalcs_measures *measures,
                                                struct dalcs_run *r);

#endif
