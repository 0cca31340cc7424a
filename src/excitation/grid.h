/* grid.h - the times a fixed-step run visits: multiples of h, and every edge of a source.
 *
 * Times are counted, t = k h, never accumulated. A step that is cut short by an edge gets a length
 * rounded to the resolution of the run, a few ulp of its stop time, so that the pieces of a PWM
 * pattern recur with the very same length and find their factors in the cache. */
#ifndef DALCS_GRID_H
#define DALCS_GRID_H

#include "stimulus.h"

struct dalcs_grid {
    double h, stop; /* s */
    double resolution;
    long k; /* multiples of h passed */
    double t;
    double next_edge;
    int n_stimuli;
    const struct dalcs_stimulus *stimulus; /* borrowed */
};

void dalcs_grid_init(struct dalcs_grid *grid, double h, double stop, int n_stimuli,
                     const struct dalcs_stimulus *stimulus);

/* Advances grid->t to the next time and returns the step's length; *jumps: a source jumps there. */
double dalcs_grid_advance(struct dalcs_grid *grid, bool *jumps);

/* Stimuli have changed: their edges from grid->t on, and one at `due` (s). */
void dalcs_grid_disturb(struct dalcs_grid *grid, double due);

static inline bool dalcs_grid_at_end(const struct dalcs_grid *grid) {
    return grid->t >= grid->stop;
}

#endif
