/* stroboscope.h - a run looked at once in each period, for one value of .step after the other: a bifurcation diagram. */
#ifndef DALCS_STROBOSCOPE_H
#define DALCS_STROBOSCOPE_H

#include "steady.h"

/* Where the run with the value before has come to, and its orbit of one period: where the next ones begin. Zero-initialise. */
struct dalcs_stroboscope {
    int n_x, n_pairs;
    bool has_run, has_orbit;
    struct dalcs_orbit_point run, orbit;
    struct dalcs_arena arena;
};

/* Rows of the states at multiples of the period, beside them the orbit of one period and its largest multiplier. */
enum dalcs_status dalcs_stroboscope_run(struct dalcs_run *r) DALCS_MUST_CHECK;

void dalcs_stroboscope_finish(struct dalcs_stroboscope *stroboscope);

/* ---- steady_run.c ------------------------------------------------------------------------------ */

/* Calls `look` with the circuit and the run as they are while periods of it are run. */
enum dalcs_status
dalcs_steady_look(struct dalcs_run *r,
                  enum dalcs_status (*look)(struct dalcs_steady *st)) DALCS_MUST_CHECK;

#endif
