/* edges_ahead.c - asks each stimulus again only where its edge may be another one. */
#include "edges_ahead.h"

#include "magnitudes.h"
#include "memory.h"

#include <math.h>
#include <stdlib.h>

enum dalcs_status dalcs_edges_ahead_setup(struct dalcs_edges_ahead *ahead, size_t most) {
    *ahead = (struct dalcs_edges_ahead){.edge = dalcs_alloc(most, sizeof(*ahead->edge))};
    return ahead->edge != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

void dalcs_edges_ahead_finish(struct dalcs_edges_ahead *ahead) {
    free(ahead->edge);
    *ahead = (struct dalcs_edges_ahead){0};
}

static bool is_known(const struct dalcs_stimulus *s) {
    bool known = !s->is_written && s->kind != DALCS_STIMULUS_DELAYED;
    for (int k = 0; s->kind == DALCS_STIMULUS_FORMULA && k < s->u.formula.argument.n && known;
         k++) {
        known = is_known(s->u.formula.argument.part[k].of);
    }
    return known;
}

void dalcs_edges_ahead_add(struct dalcs_edges_ahead *ahead, const struct dalcs_stimulus *of) {
    if (of->kind == DALCS_STIMULUS_DC && !of->is_written) {
        return; /* it has no edges */
    }
    ahead->edge[ahead->n++] = (struct dalcs_edge_ahead){
        .of = of, .is_known = is_known(of), .from = INFINITY, .to = INFINITY};
}

enum dalcs_status dalcs_edges_ahead_of_all(struct dalcs_edges_ahead *ahead,
                                           const struct dalcs_stimulus *first, int n) {
    DALCS_TRY(dalcs_edges_ahead_setup(ahead, (size_t)n));
    for (int k = 0; k < n; k++) {
        dalcs_edges_ahead_add(ahead, &first[k]);
    }
    return DALCS_OK;
}

/* Near its edge the stimulus itself is asked: only it knows whether t means that edge. */
static bool holds(const struct dalcs_edge_ahead *edge, double t) {
    return edge->is_known && edge->from <= t && t < edge->to - dalcs_alike * t;
}

double dalcs_edges_ahead_after(struct dalcs_edges_ahead *ahead, double t) {
    double next = INFINITY;
    for (int k = 0; k < ahead->n; k++) {
        struct dalcs_edge_ahead *edge = &ahead->edge[k];
        if (!holds(edge, t)) {
            edge->from = t;
            edge->to = dalcs_stimulus_next_edge(edge->of, t);
        }
        next = fmin(next, edge->to);
    }
    return next;
}
