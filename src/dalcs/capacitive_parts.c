/* capacitive_parts.c - parts whose voltage an operating point does not determine: at rest capacitors
 * carry no current, and no other element connects the part to the rest of the circuit. */
#include "capacitive_parts.h"

#include "union_find.h"

#include <stdlib.h>

static bool is_current_source(const struct dalcs_device *d) {
    return d->kind == DALCS_ISOURCE || d->kind == DALCS_CCCS || d->kind == DALCS_VCCS;
}

static void merge(const struct dalcs_circuit *c, int *whole) {
    dalcs_union_reset(whole, c->n_nodes);
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        if (d->kind != DALCS_CAPACITOR && !is_current_source(d)) {
            dalcs_union_join(whole, d->node[0], d->node[1]);
        }
    }
    for (int k = 0; k < c->n_initial_conditions && !c->analyses.operating_point; k++) {
        dalcs_union_join(whole, c->initial_condition[k].node[0], c->initial_condition[k].node[1]);
    }
}

/* The devices between each part and the rest. */
struct border {
    int capacitor; /* one of them + 1, 0 without */
    bool is_fed;   /* by a current source: the run handles it */
};

static void note_parts(const struct dalcs_circuit *c, int *whole, struct border *border,
                       struct dalcs_diag *diag) {
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        int part[2] = {dalcs_union_find(whole, d->node[0]), dalcs_union_find(whole, d->node[1])};
        for (int e = 0; e < 2 && part[0] != part[1]; e++) {
            struct border *b = &border[part[e]];
            b->is_fed = b->is_fed || d->kind != DALCS_CAPACITOR;
            b->capacitor = b->capacitor == 0 && d->kind == DALCS_CAPACITOR ? i + 1 : b->capacitor;
        }
    }
    for (int k = 1; k < c->n_nodes; k++) {
        if (whole[k] == k && border[k].capacitor > 0 && !border[k].is_fed) {
            dalcs_diag_add(diag, DALCS_NOTE, &c->device[border[k].capacitor - 1].where, NULL,
                           "only capacitors connect node '%s' and the part around it to the rest: "
                           "the operating point does not determine its voltage, and the one of "
                           "least norm is taken",
                           c->node_name[k]);
        }
    }
}

enum dalcs_status dalcs_capacitive_parts_note(const struct dalcs_circuit *c,
                                              struct dalcs_diag *diag) {
    if (!c->analyses.operating_point &&
        (!c->analyses.transient.present || c->analyses.transient.use_initial_conditions)) {
        return DALCS_OK;
    }
    int *whole = dalcs_alloc((size_t)c->n_nodes, sizeof(*whole));
    struct border *border = dalcs_alloc((size_t)c->n_nodes, sizeof(*border));
    bool complete = whole != NULL && border != NULL;
    if (complete) {
        merge(c, whole);
        note_parts(c, whole, border, diag);
    }
    free(whole);
    free(border);
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}
