/* takeover.c - is there a way for the current of a thyristor, from its cathode back to its anode, on which nothing drops?
 *
 * Where one is, its voltage stays at 0 behind the end of its current: an ideal diode or a thyristor against it, a switch
 * across it, or some of them in series with meters. Coils, capacitors, resistors and batteries are no such way, nor is a
 * diode that drops what the thyristor sees as a voltage backwards. All elements are known here, so that it does not matter how
 * a netlist writes them: what counts is what they became. */
#include "compiler.h"
#include "element_cards.h"
#include "thyristor.h"

#include <math.h>
#include <string.h>

/* One that asks. */
struct dalcs_takeover {
    struct dalcs_thyristor law; /* as it is where its current is taken over */
    struct dalcs_thyristor_places places;
    int node[2];   /* from the one to the other */
    size_t source; /* of its control, among the formulas */
    const struct dalcs_takeover *before;
};

/* Ends of devices by node: 2 k + side. */
struct ways {
    const struct dalcs_circuit *circuit;
    int *first; /* [n_nodes] an end there, -1: none */
    int *next;  /* [2 n_devices] */
    int *queue; /* [n_nodes] nodes that the current may come to */
    bool *is_reached;
};

void dalcs_thyristor_wait(struct dalcs_builder *builder, const struct dalcs_thyristor *thyristor,
                          const struct dalcs_thyristor_places *places, const int *node) {
    struct dalcs_takeover *waits = dalcs_arena_alloc(&builder->scratch, 1, sizeof *waits);
    if (!dalcs_builder_note_memory(builder, waits != NULL)) {
        return;
    }
    *waits = (struct dalcs_takeover){.law = *thyristor,
                                     .places = *places,
                                     .node = {node[0], node[1]},
                                     .source = builder->formulas.n - 1,
                                     .before = builder->models.takeover};
    waits->law.holding = thyristor->other;
    builder->models.takeover = waits;
}

/* May a current go on through it from this side without a voltage that is seen? */
static bool passes(const struct dalcs_circuit *c, const struct dalcs_device *d, int side,
                   double seen) {
    switch (d->kind) {
    case DALCS_SWITCH:
        return true;
    case DALCS_RESISTOR:
    case DALCS_INDUCTOR:
        return d->value == 0.0;
    case DALCS_DIODE:
        return side == 0 && c->models.of_diode[d->model].vfwd < seen;
    case DALCS_VSOURCE: {
        const struct dalcs_stimulus *s = d->stimulus >= 0 ? &c->stimulus[d->stimulus] : NULL;
        return s != NULL && s->kind == DALCS_STIMULUS_DC && !s->is_written && !s->is_external &&
               fabs(s->dc) < seen;
    }
    default:
        return false;
    }
}

static bool prepare(struct dalcs_builder *builder, struct ways *w) {
    const struct dalcs_circuit *c = builder->circuit;
    const size_t n_nodes = (size_t)c->n_nodes;
    *w = (struct ways){
        .circuit = c,
        .first = dalcs_arena_alloc(&builder->scratch, n_nodes, sizeof(int)),
        .next = dalcs_arena_alloc(&builder->scratch, 2 * (size_t)c->n_devices, sizeof(int)),
        .queue = dalcs_arena_alloc(&builder->scratch, n_nodes, sizeof(int)),
        .is_reached = dalcs_arena_alloc(&builder->scratch, n_nodes, sizeof(bool))};
    if (!dalcs_builder_note_memory(builder, w->first != NULL && w->next != NULL &&
                                                w->queue != NULL && w->is_reached != NULL)) {
        return false;
    }
    for (int n = 0; n < c->n_nodes; n++) {
        w->first[n] = -1;
        w->is_reached[n] = false;
    }
    for (int end = 0; end < 2 * c->n_devices; end++) {
        int *first = &w->first[c->device[end / 2].node[end % 2]];
        w->next[end] = *first;
        *first = end;
    }
    return true;
}

/* Its own valve and switch lead to no other node from its cathode. */
static bool is_taken_over(struct ways *w, const struct dalcs_takeover *t) {
    int n = 1;
    w->queue[0] = t->node[1];
    w->is_reached[t->node[1]] = true;
    for (int i = 0; i < n && !w->is_reached[t->node[0]]; i++) {
        for (int end = w->first[w->queue[i]]; end >= 0; end = w->next[end]) {
            const struct dalcs_device *d = &w->circuit->device[end / 2];
            const int to = d->node[1 - end % 2];
            if (!w->is_reached[to] && passes(w->circuit, d, end % 2, t->law.reversed)) {
                w->is_reached[to] = true;
                w->queue[n++] = to;
            }
        }
    }
    const bool is = w->is_reached[t->node[0]];
    for (int i = 0; i < n; i++) {
        w->is_reached[w->queue[i]] = false;
    }
    return is;
}

void dalcs_thyristor_settle(struct dalcs_builder *builder) {
    struct ways w;
    if (builder->models.takeover == NULL || !prepare(builder, &w)) {
        return;
    }
    for (const struct dalcs_takeover *t = builder->models.takeover; t != NULL; t = t->before) {
        if (is_taken_over(&w, t)) {
            const struct dalcs_token *control =
                dalcs_thyristor_control(builder, &t->law, &t->places);
            if (!dalcs_builder_note_memory(builder, control != NULL)) {
                return;
            }
            builder->formulas.source[t->source].token = control;
        }
    }
}
