/* current.c - currents, family by family. */
#include "current.h"

#include "stamp.h"

#include <math.h>

/* Of all devices but coils. */
enum { MOST_TERMS = 4 };

static void put(struct dalcs_current *i, int column, double coefficient) {
    if (column >= 0) {
        i->term[i->n_terms++] = (struct dalcs_probe_term){column, coefficient};
    }
}

static void put_voltage(const struct dalcs_layout *l, struct dalcs_current *i, int first,
                        int second, double coefficient) {
    put(i, dalcs_stamp_node_column(l, first), coefficient);
    put(i, dalcs_stamp_node_column(l, second), -coefficient);
}

static enum dalcs_status coil_current(const struct dalcs_layout *l, int device,
                                      struct dalcs_arena *arena, struct dalcs_current *i) {
    size_t n = l->group_of[device] < 0 ? 1 : (size_t)l->group[l->group_of[device]].n + 1;
    int *column = dalcs_arena_alloc(arena, n, sizeof(*column));
    double *coefficient = dalcs_arena_alloc(arena, n, sizeof(*coefficient));
    i->term = dalcs_arena_alloc(arena, n, sizeof(*i->term));
    if (column == NULL || coefficient == NULL || i->term == NULL) {
        return DALCS_E_NOMEM;
    }
    int n_terms = dalcs_layout_coil_current(l, device, column, coefficient);
    for (int k = 0; k < n_terms; k++) {
        put(i, column[k], coefficient[k]);
    }
    return DALCS_OK;
}

/* The current of a diode or a switch, with its leakage. */
static void pair_current(const struct dalcs_layout *l, const struct dalcs_system *s, int device,
                         struct dalcs_current *i) {
    const struct dalcs_circuit *c = l->circuit;
    const struct dalcs_device *d = &c->device[device];
    const bool is_diode = d->kind == DALCS_DIODE;
    const int first_pair = s->n_x + s->n_z + l->pair[device];
    const double roff = dalcs_device_roff(c, d);
    put(i, first_pair, 1.0);
    if (is_diode && isfinite(c->models.of_diode[d->model].vrev)) {
        put(i, first_pair + 1, -1.0);
    }
    if (isfinite(roff)) {
        put_voltage(l, i, d->node[0], d->node[1], 1.0 / roff);
    }
}

enum dalcs_status dalcs_layout_current(const struct dalcs_layout *l, const struct dalcs_system *s,
                                       int device, struct dalcs_arena *arena,
                                       struct dalcs_current *i) {
    const struct dalcs_device *d = &l->circuit->device[device];
    *i = (struct dalcs_current){0};
    if (d->kind == DALCS_INDUCTOR) {
        return coil_current(l, device, arena, i);
    }
    i->term = dalcs_arena_alloc(arena, MOST_TERMS, sizeof(*i->term));
    if (i->term == NULL) {
        return DALCS_E_NOMEM;
    }
    if (d->behaviour != NULL) { /* an unknown */
        put(i, l->current_column[device], 1.0);
        return DALCS_OK;
    }
    switch (d->kind) {
    case DALCS_RESISTOR:
        if (l->current_column[device] >= 0) {
            put(i, l->current_column[device], 1.0);
        } else {
            put_voltage(l, i, d->node[0], d->node[1], 1.0 / d->value);
        }
        break;
    case DALCS_VCCS:
        put_voltage(l, i, d->node[2], d->node[3], d->value);
        break;
    case DALCS_CCCS:
        put(i, l->current_column[d->control], d->value);
        break;
    case DALCS_ISOURCE:
        i->term[0] = (struct dalcs_probe_term){l->input[device], 1.0};
        i->n_inputs = 1;
        break;
    case DALCS_DIODE:
    case DALCS_SWITCH:
        pair_current(l, s, device, i);
        break;
    default: /* C, V, E, H: the current is an unknown */
        put(i, l->current_column[device], 1.0);
        break;
    }
    return DALCS_OK;
}
