/* steady_near.c - a steady state from that of a circuit that differs by little. */
#include "sensitivity.h"

#include <string.h>

/* What a residual of 1e-11 leaves is 1e-11 / (1 - the largest multiplier): one more step squares that. */
static enum dalcs_status polish(struct dalcs_steady *st) {
    const enum dalcs_status status = dalcs_steady_next_step(st);
    for (int x = 0; x < st->layout.n_x && status == DALCS_OK; x++) {
        st->at.x[x] += st->step[x];
    }
    st->period += status == DALCS_OK ? st->longer : 0.0;
    DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
    return dalcs_steady_pass(st, 1, DALCS_STEADY_M);
}

enum dalcs_status dalcs_steady_from_near(struct dalcs_steady *st, bool is_free,
                                         struct dalcs_steady_near *near) {
    struct dalcs_orbit_point best;
    bool found = false;
    if (st->layout.n_x != near->n_x || st->layout.n_pairs != near->n_pairs) {
        return DALCS_NOT_CONVERGED;
    }
    if (!dalcs_steady_make_point(st, &best)) {
        return DALCS_E_NOMEM;
    }
    memcpy(st->at.x, near->point.x, (size_t)near->n_x * sizeof(double));
    memcpy(st->at.closed, near->point.closed, (size_t)near->n_pairs * sizeof(bool));
    st->has_point = true;
    st->is_free = is_free;
    st->period = is_free ? near->period : st->period;
    DALCS_TRY(dalcs_steady_burst(st, &found));
    if (!found) {
        return DALCS_NOT_CONVERGED;
    }
    DALCS_TRY(dalcs_steady_refine(st, &best));
    near->signature = st->signature;
    return polish(st);
}
