/* shadow_run.h - a run without output, for the currents of exponential diodes. Private to this folder. */
#ifndef DALCS_SHADOW_RUN_H
#define DALCS_SHADOW_RUN_H

#include "dalcs.h"

struct dalcs_circuit;
struct dalcs_exponential;

/* Forward and backward, over all of the run and over the part that counts. */
struct dalcs_charge {
    double of_all[2], of_part[2];               /* C */
    double square_of_all[2], square_of_part[2]; /* A^2 s */
};

struct dalcs_charge_collector {
    const struct dalcs_sink *to;         /* asked whether to go on */
    const struct dalcs_session *session; /* likewise */
    int n;
    struct dalcs_charge *charge; /* [n] */
    double *last;                /* [n] */
    double last_time, from;      /* s */
    bool is_transient, has_row;
};

/* Of a diode that is one; else NULL. */
const struct dalcs_exponential *dalcs_exponential_of(const struct dalcs_circuit *c, int device);

/* A; 0: nothing passes. What passes must be more than the run's errors in all that does, and so must what passes in
 * the part that counts. */
double dalcs_charge_mean(const struct dalcs_charge *c, int side, double tolerance);

/* Runs the circuit once and puts the diodes' currents into *c. */
enum dalcs_status dalcs_shadow_run(struct dalcs_session *s, const struct dalcs_run_options *given,
                                   double tolerance, struct dalcs_charge_collector *c);

#endif
