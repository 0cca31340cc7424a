/* orbit_rest.c - what lambda and w come to in each stretch, and which of them is as good as 0. */
#include "orbit_rest.h"

#include "magnitudes.h"
#include "orbit_near.h"
#include "rounding.h"
#include "step_error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int n_pairs_of(const struct dalcs_orbit_part *p) {
    return p->rates.part->component->system->n_pairs;
}

static bool is_diode(const struct dalcs_orbit_part *p, int pair) {
    return p->rates.part->component->system->pair[pair].kind == DALCS_PAIR_DIODE;
}

/* ---- While the run goes on ----------------------------------------------------------------------- */

/* The one that the present segment is of. */
static struct dalcs_orbit_stretch *stretch_of(struct dalcs_orbit_part *p,
                                              const struct dalcs_orbit_span *span) {
    struct dalcs_orbit_rest *rest = &p->rest;
    struct dalcs_orbit_stretch *last = rest->n > 0 ? &rest->stretch[rest->n - 1] : NULL;
    if (last != NULL && last->mode == span->mode && !rest->is_over) {
        return last;
    }
    if (rest->now == NULL) {
        rest->now = dalcs_arena_alloc(&p->log->arena, (size_t)n_pairs_of(p), sizeof(double));
    }
    if (rest->now == NULL) {
        return NULL;
    }
    if (dalcs_grow(&rest->stretch, &rest->capacity, (size_t)rest->n + 1, sizeof *rest->stretch) !=
        DALCS_OK) {
        return NULL;
    }
    last = &rest->stretch[rest->n];
    *last = (struct dalcs_orbit_stretch){.from = p->rates.part->segment.t, .mode = span->mode};
    last->largest = dalcs_arena_alloc(&p->log->arena, (size_t)n_pairs_of(p), sizeof(double));
    last->moved = dalcs_arena_alloc(&p->log->arena, (size_t)n_pairs_of(p), sizeof(double));
    const bool complete = last->largest != NULL && last->moved != NULL;
    rest->n += complete ? 1 : 0;
    return complete ? last : NULL;
}

/* Behind the start of the segment, where the mode may take something away; at as many times as a step has nodes. */
static void note_pairs(struct dalcs_orbit_part *p, struct dalcs_orbit_stretch *stretch) {
    const struct dalcs_radau_part *part = p->rates.part;
    const struct dalcs_collocation *method = part->stages.method;
    const double length = part->segment.t_end - part->segment.t;
    for (int k = 0; k < n_pairs_of(p); k++) {
        p->rest.now[k] = 0.0;
    }
    for (int node = 1; node <= method->s; node++) {
        dalcs_step_values(part, part->segment.end * method->node[node], p->work_y);
        for (int k = 0; k < n_pairs_of(p); k++) {
            const double value = fabs(p->work_y[dalcs_orbit_guard_row(part, k)]);
            p->rest.now[k] = is_diode(p, k) ? fmax(p->rest.now[k], value) : 0.0;
        }
    }
    for (int k = 0; k < n_pairs_of(p); k++) {
        stretch->largest[k] = fmax(stretch->largest[k], p->rest.now[k]);
        stretch->moved[k] += p->rest.now[k] * length;
    }
}

enum dalcs_status dalcs_orbit_rest_note(struct dalcs_orbit_part *p,
                                        const struct dalcs_orbit_span *span) {
    const struct dalcs_radau_part *part = p->rates.part;
    struct dalcs_orbit_stretch *stretch = stretch_of(p, span);
    if (stretch == NULL) {
        return DALCS_E_NOMEM;
    }
    stretch->to = part->segment.t_end;
    stretch->n++;
    p->rest.is_over = part->segment.why != DALCS_END_OF_STEP;
    note_pairs(p, stretch);
    return dalcs_orbit_near_note(p, span);
}

/* ---- At its end ---------------------------------------------------------------------------------- */

/* own[n_pairs][2]: V, A: w and lambda at their largest. */
static void find_own(const struct dalcs_orbit_part *p, double (*own)[2]) {
    for (int m = 0; m < p->rest.n; m++) {
        const struct dalcs_orbit_stretch *stretch = &p->rest.stretch[m];
        for (int k = 0; k < n_pairs_of(p); k++) {
            double *of = &own[k][dalcs_mode_has(stretch->mode, k) ? 1 : 0];
            *of = fmax(*of, stretch->largest[k]);
        }
    }
}

/* Vs or C: what rounding makes of a lambda or w that is 0. Each step makes of the digits of what is held beside a pair a
 * charge or a flux (guard_scale.h). */
static double rounding_of(const struct dalcs_orbit_part *p,
                          const struct dalcs_orbit_stretch *stretch, int pair) {
    const struct dalcs_radau_part *part = p->rates.part;
    const double *unit = part->scales.unit;
    const bool is_on = dalcs_mode_has(stretch->mode, pair);
    const double held =
        is_on ? part->laws.held_charge[pair] * unit[0] : part->laws.held_flux[pair] * unit[1];
    return dalcs_answer_rounded * unit[is_on ? 1 : 0] * (stretch->to - stretch->from) +
           dalcs_sum_rounded * (double)stretch->n * held;
}

/* Rounding, or what would come to nothing of its own size in a period, if it went on as in the stretch. A stretch that is
 * nothing beside the period has no part in the response. */
static bool rests(const struct dalcs_orbit_part *p, const struct dalcs_orbit_stretch *stretch,
                  int pair, double T, const double *own) {
    const double part = (stretch->to - stretch->from) / T;
    const double size = own[dalcs_mode_has(stretch->mode, pair) ? 1 : 0];
    return part > dalcs_nothing && (stretch->moved[pair] <= rounding_of(p, stretch, pair) ||
                                    stretch->largest[pair] <= dalcs_alike * part * size);
}

static enum dalcs_status find_resting(struct dalcs_orbit_part *p, double T, double (*own)[2]) {
    const size_t words = (size_t)p->rates.part->stages.n_words;
    for (int m = 0; m < p->rest.n; m++) {
        struct dalcs_orbit_stretch *stretch = &p->rest.stretch[m];
        for (int k = 0; k < n_pairs_of(p); k++) {
            if (!is_diode(p, k) || !rests(p, stretch, k, T, own[k])) {
                continue;
            }
            if (stretch->resting == NULL) {
                stretch->resting = dalcs_arena_alloc(&p->log->arena, words, sizeof(uint64_t));
                DALCS_TRY(stretch->resting != NULL ? DALCS_OK : DALCS_E_NOMEM);
            }
            stretch->resting[k / 64] |= (uint64_t)1 << (k % 64);
            p->rest.any = true;
        }
    }
    return DALCS_OK;
}

/* What the span begins with stays with the first of two, what it ends with goes to the second. */
static enum dalcs_status cut_span(struct dalcs_orbit_part *p, int at, double t) {
    DALCS_TRY(dalcs_grow(&p->span, &p->capacity, (size_t)p->n + 1, sizeof *p->span));
    memmove(p->span + at + 1, p->span + at, (size_t)(p->n - at) * sizeof *p->span);
    p->n++;
    struct dalcs_orbit_span *first = &p->span[at];
    struct dalcs_orbit_span *second = &p->span[at + 1];
    *first = (struct dalcs_orbit_span){.from = first->from,
                                       .to = t,
                                       .mode = first->mode,
                                       .jump = first->jump,
                                       .behind = first->behind,
                                       .row = -1};
    second->from = t;
    second->jump = NULL;
    second->behind = NULL;
    return DALCS_OK;
}

/* Spans end where what rests in them changes. */
static enum dalcs_status cut_spans(struct dalcs_orbit_part *p) {
    const int n_words = p->rates.part->stages.n_words;
    int at = 0;
    for (int m = 0; m < p->rest.n; m++) {
        const struct dalcs_orbit_stretch *stretch = &p->rest.stretch[m];
        while (at < p->n - 1 && p->span[at].to <= stretch->from) {
            at++;
        }
        struct dalcs_orbit_span *span = &p->span[at];
        if (span->from >= stretch->from) {
            span->resting = stretch->resting;
            continue;
        }
        const uint64_t *before = span->resting;
        const bool is_same = before == NULL || stretch->resting == NULL
                                 ? before == stretch->resting
                                 : dalcs_mode_is(before, stretch->resting, n_words);
        if (!is_same) {
            DALCS_TRY(cut_span(p, at, stretch->from));
            p->span[at].resting = before;
            p->span[++at].resting = stretch->resting;
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_orbit_rest_find(struct dalcs_orbit_part *p, double T) {
    double(*own)[2] = dalcs_arena_alloc(&p->log->arena, (size_t)n_pairs_of(p), sizeof *own);
    if (own == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_orbit_near_find(p));
    find_own(p, own);
    DALCS_TRY(find_resting(p, T, own));
    return p->rest.any ? cut_spans(p) : DALCS_OK;
}

void dalcs_orbit_rest_finish(struct dalcs_orbit_part *p) {
    free(p->rest.stretch);
    dalcs_orbit_near_finish(p);
}
