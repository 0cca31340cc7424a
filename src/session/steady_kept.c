/* steady_kept.c - what the circuit and the run are, put aside while a period of it is run; and an orbit, for the analysis
 * behind it. */
#include "steady.h"

#include <stdlib.h>
#include <string.h>

enum dalcs_status dalcs_steady_keep(struct dalcs_run *r, struct dalcs_steady_kept *kept) {
    const struct dalcs_circuit *c = &r->s->circuit;
    *kept = (struct dalcs_steady_kept){
        .transient = c->analyses.transient, .h = r->h, .max_step = r->radau.max_step};
    kept->stimulus = dalcs_alloc((size_t)c->n_stimuli, sizeof(*kept->stimulus));
    for (int i = 0; i < c->n_stimuli && kept->stimulus != NULL; i++) {
        kept->stimulus[i] = c->stimulus[i];
    }
    return kept->stimulus != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

void dalcs_steady_put_back(struct dalcs_run *r, const struct dalcs_steady_kept *kept, bool all) {
    struct dalcs_circuit *c = &r->s->circuit;
    for (int i = 0; i < c->n_stimuli; i++) {
        if (all || c->stimulus[i].kind != kept->stimulus[i].kind) {
            c->stimulus[i] = kept->stimulus[i];
        }
    }
    c->analyses.transient = kept->transient;
    r->h = kept->h;
    r->radau.max_step = kept->max_step;
}

/* ---- An orbit ------------------------------------------------------------------------------------ */

struct dalcs_steady_known {
    struct dalcs_arena arena;
    struct dalcs_orbit_point at;
    double *scale;
    double period;
    bool is_free, is_exact;
};

enum dalcs_status dalcs_steady_remember(const struct dalcs_steady *st) {
    const size_t n_x = (size_t)st->layout.n_x;
    const size_t n_pairs = (size_t)st->layout.n_pairs;
    struct dalcs_run *r = st->run;
    dalcs_steady_forget(r);
    struct dalcs_steady_known *k = dalcs_alloc(1, sizeof *k);
    if (k == NULL) {
        return DALCS_E_NOMEM;
    }
    r->known = k;
    k->at.x = dalcs_arena_alloc(&k->arena, n_x + 1, sizeof(double));
    k->at.closed = dalcs_arena_alloc(&k->arena, n_pairs + 1, sizeof(bool));
    k->scale = dalcs_arena_alloc(&k->arena, n_x + 1, sizeof(double));
    if (k->at.x == NULL || k->at.closed == NULL || k->scale == NULL) {
        dalcs_steady_forget(r);
        return DALCS_E_NOMEM;
    }
    memcpy(k->at.x, st->at.x, n_x * sizeof(double));
    memcpy(k->at.closed, st->at.closed, n_pairs * sizeof(bool));
    memcpy(k->scale, st->scale, n_x * sizeof(double));
    k->period = st->period;
    k->is_free = st->own.is_free;
    k->is_exact = st->pass.is_exact;
    return DALCS_OK;
}

bool dalcs_steady_recall(struct dalcs_steady *st) {
    const struct dalcs_steady_known *k = st->run->known;
    if (k == NULL) {
        return false;
    }
    memcpy(st->at.x, k->at.x, (size_t)st->layout.n_x * sizeof(double));
    memcpy(st->at.closed, k->at.closed, (size_t)st->layout.n_pairs * sizeof(bool));
    memcpy(st->scale, k->scale, (size_t)st->layout.n_x * sizeof(double));
    st->period = k->period;
    st->own.is_free = k->is_free;
    st->pass.is_exact = k->is_exact;
    st->has_point = true;
    return true;
}

void dalcs_steady_forget(struct dalcs_run *r) {
    if (r->known != NULL) {
        dalcs_arena_finish(&r->known->arena);
        free(r->known);
        r->known = NULL;
    }
}
