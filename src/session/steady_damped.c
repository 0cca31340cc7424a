/* steady_damped.c - half a step of Newton's method, where whole ones go in a circle.
 *
 * As events come and go with the states, pieces of the map follow each other, and a whole step may lead from each of two
 * pieces into the other one, for ever. So it is in a bridge whose switches have diodes in parallel: a current has half the
 * resistance in one direction, and what that resistance alone wears down, such as the current of a large coil, is sent
 * to and fro. It shows where a step ends in a piece where one has ended before. A half of such a step
 * ends where the next one leads on. On a straight piece it takes half of the residual away; it helps if it takes a
 * quarter, as a whole step does that takes half. */
#include "steady.h"

#include <math.h>

void dalcs_steady_note_defect(struct dalcs_steady *st) {
    st->damped.residual = st->pass.residual;
    for (int x = 0; x < st->layout.n_x; x++) {
        st->damped.defect[x] = fabs(st->then.x[x] - st->at.x[x]);
        st->damped.scale[x] = st->scale[x];
    }
}

bool dalcs_steady_lessens(const struct dalcs_steady *st, double part) {
    double before = 0.0;
    double now = 0.0;
    for (int x = 0; x < st->layout.n_x; x++) {
        const double scale = fmax(st->damped.scale[x], st->scale[x]);
        const double off = fabs(st->then.x[x] - st->at.x[x]);
        before = scale > 0.0 ? fmax(before, st->damped.defect[x] / scale) : before;
        now = scale > 0.0 ? fmax(now, off / scale) : now;
    }
    return now <= part * before || st->pass.residual <= part * st->damped.residual;
}

bool dalcs_steady_cycles(struct dalcs_steady *st) {
    struct dalcs_steady_damped *d = &st->damped;
    bool does = false;
    for (int k = 0; k < d->n && !does; k++) {
        does = d->piece[k] == st->pass.signature;
    }
    if (!does && d->n < DALCS_STEADY_STEPS) {
        d->piece[d->n++] = st->pass.signature;
    }
    return does;
}

/* From the end of a whole step back to its middle. */
static void go_back(struct dalcs_steady *st, const struct dalcs_orbit_point *whole) {
    for (int x = 0; x < st->layout.n_x; x++) {
        st->at.x[x] = whole->x[x] - 0.5 * st->step[x];
    }
}

enum dalcs_status dalcs_steady_damp(struct dalcs_steady *st, bool *helped) {
    struct dalcs_orbit_point *whole = &st->damped.whole;
    const double period = st->period;
    dalcs_steady_copy_point(st, whole, &st->at);
    dalcs_steady_copy_point(st, &st->damped.arrived, &st->then);
    go_back(st, whole);
    st->period = period - 0.5 * st->own.longer;
    const enum dalcs_status status = dalcs_steady_pass(st, 1, DALCS_STEADY_M);
    DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
    *helped = status == DALCS_OK && dalcs_steady_lessens(st, 0.75);
    if (!*helped) {
        st->period = period;
        dalcs_steady_copy_point(st, &st->at, whole);
        dalcs_steady_copy_point(st, &st->then, &st->damped.arrived);
    }
    return DALCS_OK;
}
