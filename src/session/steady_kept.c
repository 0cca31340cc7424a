/* steady_kept.c - what the circuit and the run are, put aside while a period of it is run. */
#include "steady.h"

enum dalcs_status dalcs_steady_keep(struct dalcs_run *r, struct dalcs_steady_kept *kept) {
    const struct dalcs_circuit *c = &r->s->circuit;
    *kept =
        (struct dalcs_steady_kept){.transient = c->transient, .h = r->h, .max_step = r->max_step};
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
    c->transient = kept->transient;
    r->h = kept->h;
    r->max_step = kept->max_step;
}
