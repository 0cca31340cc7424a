/* steady_shorter.c - has M held over a step? If not, a leap that is as long as M holds.
 *
 * As events come and go with the states, pieces of the map follow each other, and a step of Newton's method leads to where
 * another piece is. In a control that is saturated 1 - M is nearly singular, and the step leads a million volts away; in a
 * bridge whose switches have diodes in parallel steps lead to and fro. A leap of k periods,
 *
 *     (1 + 1/k - M) d = F,    F = Phi(x) - x,
 *
 * goes the way of a run: for k without end it is that step. Were the map straight, d/k would be left of F behind it.
 * What else is there is worth a correction e by the same matrix, (1 + 1/k - M) e = F(x + d) - d/k. M has held if e is no more
 * than half of d. F itself does not tell: a run that leaves saturation has an F a thousand times as large as before. The
 * correction is the same in all units of F (P. Deuflhard, Newton Methods for Nonlinear Problems, Springer 2004, chapter
 * 3: natural monotonicity).
 *
 * Halving finds the longest leap over which M holds, and the next longer one is taken: it ends in another piece, whose M
 * leads on. */
#include "steady_step.h"

#include <math.h>
#include <string.h>

/* k is a power of 2, up to one that is as good as a step of Newton's method and keeps what is conserved
 * (steady_continuation.c). Six halvings leave a factor of 2^(20/64) = 1.24. Four of them tell that a leap of 2^2 periods is too
 * long: a run gets as far in as many periods. */
enum { LONGEST = 20, SHORTEST = 2, HALVINGS = 6 };

void dalcs_steady_note_base(struct dalcs_steady *st) {
    struct dalcs_steady_base *b = &st->base;
    dalcs_steady_copy_point(st, &b->at, &st->at);
    dalcs_steady_copy_point(st, &b->then, &st->then);
    memcpy(b->M, st->pass.M, st->layout.first_of_M[st->layout.n_systems] * sizeof(double));
    memcpy(b->scale, st->scale, (size_t)st->layout.n_x * sizeof(double));
}

double dalcs_steady_relative_size(const struct dalcs_steady *st, const double *x) {
    double most = 0.0;
    for (int i = 0; i < st->layout.n_x; i++) {
        const double scale = fmax(st->base.scale[i], st->scale[i]);
        most = fabs(x[i]) > 0.0 ? fmax(most, fabs(x[i]) / scale) : most;
    }
    return most;
}

/* Has M of the base held over st->step, of k periods, behind which the last pass began? */
static enum dalcs_status find_holds(struct dalcs_steady *st, double k, bool *holds) {
    double *e = st->base.work;
    for (int x = 0; x < st->layout.n_x; x++) {
        e[x] = st->then.x[x] - st->at.x[x] - st->step[x] / k;
    }
    const enum dalcs_status status = dalcs_steady_find_leap(st, st->base.M, k, e);
    *holds = status == DALCS_OK &&
             dalcs_steady_relative_size(st, e) <= 0.5 * dalcs_steady_relative_size(st, st->step);
    return status < DALCS_OK ? status : DALCS_OK;
}

/* Has Phi(x) - x been halved since the base, in units in which energies are alike? In a passive circuit a leap that is short
 * enough lessens it. Beside gates there are no such units: what is over a scale gets smaller where a leap leads far away. */
static bool is_halved(struct dalcs_steady *st) {
    double *before = st->base.work;
    double *now = st->base.change;
    for (int x = 0; x < st->layout.n_x; x++) {
        before[x] = st->base.then.x[x] - st->base.at.x[x];
        now[x] = st->then.x[x] - st->at.x[x];
    }
    return st->layout.memory.n_numbers == 0 &&
           dalcs_steady_size(st, now) <= 0.5 * dalcs_steady_size(st, before);
}

enum dalcs_status dalcs_steady_find_helped(struct dalcs_steady *st, bool *helped) {
    const bool is_conserving = st->kept.n > 0; /* 1 - M is singular */
    DALCS_TRY(find_holds(st, is_conserving ? exp2(LONGEST) : INFINITY, helped));
    return DALCS_OK;
}

/* A leap of 2^e periods from the base, and a pass behind it. *holds: M has held. *helped: little is left of Phi(x) - x. */
static enum dalcs_status try_leap(struct dalcs_steady *st, double e, bool *holds, bool *helped) {
    const double k = exp2(e);
    *holds = *helped = false;
    for (int x = 0; x < st->layout.n_x; x++) {
        st->step[x] = st->base.then.x[x] - st->base.at.x[x];
    }
    DALCS_TRY(dalcs_steady_find_leap(st, st->base.M, k, st->step));
    dalcs_steady_copy_point(st, &st->at, &st->base.then);
    for (int x = 0; x < st->layout.n_x; x++) {
        st->at.x[x] = st->base.at.x[x] + st->step[x];
    }
    DALCS_TRY(dalcs_steady_pass(st, 1, DALCS_STEADY_M));
    DALCS_TRY(find_holds(st, k, holds));
    *helped = *holds && is_halved(st);
    return DALCS_OK;
}

/* The longest leap over which M holds is between *low and *high. *ends: a run has come through from *high. */
struct leaps {
    double low, high, last;
    bool ends;
};

static enum dalcs_status halve(struct dalcs_steady *st, struct leaps *l, bool *helped) {
    enum dalcs_status status = DALCS_OK;
    for (int i = 0; i < HALVINGS && l->high > SHORTEST && !*helped; i++) {
        bool holds;
        l->last = 0.5 * (l->low + l->high);
        status = try_leap(st, l->last, &holds, helped);
        DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
        l->low = holds ? l->last : l->low;
        l->high = holds ? l->high : l->last;
        l->ends = holds ? l->ends : status == DALCS_OK;
    }
    return status;
}

enum dalcs_status dalcs_steady_shorten(struct dalcs_steady *st, bool *helped) {
    struct leaps l = {.high = LONGEST};
    *helped = false;
    enum dalcs_status status = halve(st, &l, helped);
    DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
    const double chosen = l.ends ? l.high : l.low;
    if (!*helped && chosen > SHORTEST && chosen != l.last) {
        bool holds;
        status = try_leap(st, chosen, &holds, helped);
        DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
    }
    *helped = *helped || chosen > SHORTEST;
    if (status != DALCS_OK) {
        *helped = false;
        dalcs_steady_copy_point(st, &st->at, &st->base.at);
        dalcs_steady_copy_point(st, &st->then, &st->base.then);
    }
    return DALCS_OK;
}
