/* steady_homotopy.c - from far away: the periodic states of circuits that leak less and less.
 *
 * In a period of k all that has gone from a state a since is drawn back by its k-th part: with a leak x = Phi(x) - (x - a)/k. For
 * small k that is a, for k without end a steady state. A map that keeps the states of a circuit within bounds has a way from
 * one to the other (S. N. Chow, J. Mallet-Paret, J. A. Yorke, Math. Comp. 32, 1978). It is followed by steps
 *
 *     (1 + 1/k - M) d = F(x) - (x - a)/k,    F(x) = Phi(x) - x,
 *
 * with k as large as they allow. A run of a control goes to and fro between the limits of its duty cycle, and so do leaps, which
 * follow it. Here it does not: an integrator that leaks has the gain of k periods, and leaves its limit once.
 *
 * A step has led near the way if the next one, of the same k with the M of there, is no more than half as long. What a period
 * forgets does not count: at the border of discontinuous conduction a coil's current is another one, and 0 a period later.
 * Behind one that is longer another one is tried, for a piece of the map may be narrow. Where the way turns back, or two pieces
 * meet too sharply, a is put to where it has come to. */
#include "steady_step.h"

#include <math.h>
#include <string.h>

/* k: 2^LONGEST is as good as no leak and keeps what is conserved (steady_continuation.c). FARTHEST: times what it has been a
 * state may go in a step. The numbers are no thresholds of an answer: of 64 loops, FARTHEST of 8 to 512 takes 16 to 73
 * passes. */
enum { FIRST = 4, LONGEST = 20, MOST_PASSES = 60, FARTHEST = 64, ROOTS = 8 };

/* Lengths that hold and do not hold are as near as that where it is of no use to look between them: 2^(1/4). */
static const double narrow = 1.19;

struct path {
    struct dalcs_orbit_point from; /* a */
    struct dalcs_steady_base kept; /* where the way was reached last */
    double k, next, refused;       /* of there; of the next step; of one that did not hold */
    int n_passes;
};

static bool make_room(struct dalcs_steady *st, struct path *p) {
    const size_t n_M = st->layout.first_of_M[st->layout.n_systems] + 1;
    p->kept.M = dalcs_arena_alloc(&st->arena, n_M, sizeof(double));
    p->kept.scale = dalcs_arena_alloc(&st->arena, (size_t)st->layout.n_x + 1, sizeof(double));
    return p->kept.M != NULL && p->kept.scale != NULL && dalcs_steady_make_point(st, &p->from) &&
           dalcs_steady_make_point(st, &p->kept.at) && dalcs_steady_make_point(st, &p->kept.then);
}

static void copy_base(const struct dalcs_steady *st, struct dalcs_steady_base *to,
                      const struct dalcs_steady_base *from) {
    dalcs_steady_copy_point(st, &to->at, &from->at);
    dalcs_steady_copy_point(st, &to->then, &from->then);
    memcpy(to->M, from->M, st->layout.first_of_M[st->layout.n_systems] * sizeof(double));
    memcpy(to->scale, from->scale, (size_t)st->layout.n_x * sizeof(double));
}

/* d of a leak of k, from the base. */
static enum dalcs_status step_of(struct dalcs_steady *st, const struct path *p, double k,
                                 double *d) {
    const struct dalcs_steady_base *b = &st->base;
    for (int x = 0; x < st->layout.n_x; x++) {
        d[x] = b->then.x[x] - b->at.x[x] - (b->at.x[x] - p->from.x[x]) / k;
    }
    return dalcs_steady_find_leap(st, b->M, k, d);
}

/* e = M e, of the last pass: what a period leaves of it. */
static void forget(struct dalcs_steady *st, double *e) {
    double *left = st->base.change;
    for (int s = 0; s < st->layout.n_systems; s++) {
        const int first = st->layout.first[s];
        const int n = st->layout.first[s + 1] - first;
        const double *M = st->pass.M + st->layout.first_of_M[s];
        for (int i = 0; i < n; i++) {
            left[first + i] = 0.0;
            for (int j = 0; j < n; j++) {
                left[first + i] += M[j * n + i] * e[first + j];
            }
        }
    }
    memcpy(e, left, (size_t)st->layout.n_x * sizeof(double));
}

/* p->next: shorter where a state would go too far for M to say anything of it. */
static enum dalcs_status limit_step(struct dalcs_steady *st, struct path *p) {
    for (int i = 0; i < ROOTS; i++) {
        double most = 0.0;
        const enum dalcs_status status = step_of(st, p, p->next, st->step);
        if (status != DALCS_OK) {
            return status < DALCS_OK ? status : DALCS_OK;
        }
        for (int x = 0; x < st->layout.n_x; x++) {
            const double size = fabs(st->step[x]);
            most = size > 0.0 ? fmax(most, size / st->base.scale[x]) : most;
        }
        if (most <= FARTHEST) {
            break;
        }
        p->next = sqrt(p->k * p->next);
    }
    return DALCS_OK;
}

/* A step from the base, and a pass behind it. *ratio: how long the next one is, over this one; INFINITY where there is none. */
static enum dalcs_status try_step(struct dalcs_steady *st, struct path *p, double *ratio) {
    double *e = st->base.work;
    *ratio = INFINITY;
    DALCS_TRY(step_of(st, p, p->next, st->step));
    dalcs_steady_copy_point(st, &st->at, &st->base.then);
    for (int x = 0; x < st->layout.n_x; x++) {
        st->at.x[x] = st->base.at.x[x] + st->step[x];
    }
    st->n.newton++;
    p->n_passes++;
    DALCS_TRY(dalcs_steady_pass(st, 1, DALCS_STEADY_M));
    for (int x = 0; x < st->layout.n_x; x++) {
        e[x] = st->then.x[x] - st->at.x[x] - (st->at.x[x] - p->from.x[x]) / p->next;
    }
    DALCS_TRY(dalcs_steady_find_leap(st, st->pass.M, p->next, e));
    forget(st, e);
    *ratio = dalcs_steady_relative_size(st, e) / dalcs_steady_relative_size(st, st->step);
    return DALCS_OK;
}

/* One step, or two, to the way of p->next. *ratio: of the last one. */
static enum dalcs_status try_steps(struct dalcs_steady *st, struct path *p, double *ratio) {
    DALCS_TRY(limit_step(st, p));
    copy_base(st, &p->kept, &st->base);
    enum dalcs_status status = try_step(st, p, ratio);
    if (status == DALCS_OK && *ratio > 0.5) {
        dalcs_steady_note_base(st);
        status = try_step(st, p, ratio);
    }
    return status < DALCS_OK ? status : DALCS_OK;
}

/* The way has been reached with p->next: how long the next step is. */
static void go_on(struct path *p, double ratio) {
    p->k = p->next;
    p->next = fmin(2.0 * p->k / ratio, exp2(LONGEST));
    if (p->k >= p->refused) {
        p->refused = INFINITY;
    } else if (p->next > sqrt(p->k * p->refused)) {
        p->next = p->refused > 2.0 * p->k ? sqrt(p->k * p->refused) : p->refused;
    }
}

/* It has not: a shorter step, or another leak. *ends: there is none. */
static void go_back(struct dalcs_steady *st, struct path *p, bool *ends) {
    copy_base(st, &st->base, &p->kept);
    p->refused = p->next;
    if (p->next > narrow * p->k) {
        p->next = sqrt(p->k * p->next);
        return;
    }
    *ends = !(p->k > narrow);
    dalcs_steady_copy_point(st, &p->from, &st->base.at);
    p->next = p->k;
    p->k = 1.0;
    p->refused = INFINITY;
}

enum dalcs_status dalcs_steady_follow(struct dalcs_steady *st, bool *is_near) {
    struct path p = {.k = 1.0, .next = FIRST, .refused = INFINITY};
    bool ends = false;
    *is_near = false;
    if (!make_room(st, &p)) {
        return DALCS_E_NOMEM;
    }
    enum dalcs_status status = dalcs_steady_pass(st, 1, DALCS_STEADY_M);
    if (status != DALCS_OK) {
        return status < DALCS_OK ? status : DALCS_OK; /* a run that fails ends it, no more */
    }
    dalcs_steady_copy_point(st, &p.from, &st->at);
    dalcs_steady_note_base(st);
    while (!*is_near && !ends && p.n_passes < MOST_PASSES && !dalcs_steady_is_crowded(st, NULL)) {
        double ratio = INFINITY;
        DALCS_TRY(try_steps(st, &p, &ratio));
        if (ratio <= 0.5) {
            dalcs_steady_note_base(st);
            *is_near = p.next >= exp2(LONGEST);
            go_on(&p, ratio);
        } else {
            go_back(st, &p, &ends);
        }
    }
    return DALCS_OK;
}
