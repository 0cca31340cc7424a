/* stamp_device.c - what each kind of device writes into P, A, C, F and storage. */
#include "stamp_device.h"

#include "stamp_behaviour.h"

#include <math.h>
#include <stdlib.h>

static enum dalcs_status stamp_capacitor(struct stamps *b, int device, int forest_column) {
    struct dalcs_layout *l = b->layout;
    struct dalcs_system *s = b->s;
    const struct dalcs_device *d = &l->circuit->device[device];
    int x = forest_column;
    if (l->topology.in_forest[device]) {
        /* P x' sums C v' over the capacitors at a node; the alias 0 = v - x has its own row. */
        int row = s->n_x + b->next_row++;
        for (int e = 0; e < 2; e++) {
            int n = l->topology.node_of[d->node[e]];
            if (n != l->topology.forest_root[n]) {
                DALCS_TRY(dalcs_stamp_add(&b->P, l->kcl_row[n], x, e == 0 ? d->value : -d->value));
            }
        }
        DALCS_TRY(dalcs_stamp_add_voltage(b, &b->A, row, d->node[0], d->node[1], 1.0));
        DALCS_TRY(dalcs_stamp_add(&b->A, row, x, -1.0));
        s->dual[row] = x;
        s->column_is_current[x] = false;
        s->row_is_current[row] = false;
        s->column[x] = (struct dalcs_label){d->name, DALCS_LABEL_STATE};
        s->row[row] = (struct dalcs_label){d->name, DALCS_LABEL_BRANCH};
    } else {
        x = dalcs_stamp_new_state(b, d->name, false);
        int column;
        int row;
        dalcs_stamp_new_branch(b, device, &column, &row);
        DALCS_TRY(dalcs_stamp_add(&b->P, x, x, d->value));
        DALCS_TRY(dalcs_stamp_add(&b->A, x, column, 1.0));
        DALCS_TRY(dalcs_stamp_add_voltage(b, &b->A, row, d->node[0], d->node[1], 1.0));
        DALCS_TRY(dalcs_stamp_add(&b->A, row, x, -1.0));
        DALCS_TRY(dalcs_stamp_branch_current(b, d, column, 1.0));
    }
    l->state_column[device] = x;
    /* .ic says it of the terminals: before the start nothing flows through what is in series */
    const int *node_of = l->topology.node_of;
    const int first = d->before_series != 0 ? d->before_series : d->node[0];
    b->initial[x] = d->has_initial
                        ? d->initial
                        : dalcs_initial_voltages_between(&l->initial_voltages, l->circuit, node_of,
                                                         node_of[first], node_of[d->node[1]]);
    return dalcs_stamp_add(&b->storage, x, x, d->value);
}

static enum dalcs_status stamp_coil(struct stamps *b, int device) {
    struct dalcs_layout *l = b->layout;
    const struct dalcs_device *d = &l->circuit->device[device];
    int x = dalcs_stamp_new_state(b, d->name, true);
    l->state_column[device] = x;
    b->initial[x] = d->initial;
    DALCS_TRY(dalcs_stamp_add(&b->P, x, x, d->value));
    DALCS_TRY(dalcs_stamp_add(&b->storage, x, x, d->value));
    DALCS_TRY(dalcs_stamp_add_voltage(b, &b->A, x, d->node[0], d->node[1], 1.0));
    return dalcs_stamp_branch_current(b, d, x, 1.0);
}

static enum dalcs_status stamp_independent_coils(struct stamps *b, const struct coil_group *g) {
    struct dalcs_layout *l = b->layout;
    const struct dalcs_circuit *c = l->circuit;
    int rank = g->split.rank;
    for (int i = 0; i < rank; i++) {
        int device = g->device[g->split.coil[i]];
        int x = dalcs_stamp_new_state(b, c->device[device].name, true);
        l->state_column[device] = x;
        b->initial[x] = c->device[device].initial;
        DALCS_TRY(dalcs_stamp_add_voltage(b, &b->A, x, c->device[device].node[0],
                                          c->device[device].node[1], 1.0));
    }
    for (int i = 0; i < rank; i++) {
        int first = g->split.coil[i];
        int row = l->state_column[g->device[first]];
        for (int j = 0; j < rank; j++) {
            int second = g->split.coil[j];
            int column = l->state_column[g->device[second]];
            double L = g->L[first * g->n + second];
            DALCS_TRY(dalcs_stamp_add(&b->P, row, column, L));
            DALCS_TRY(dalcs_stamp_add(&b->storage, row, column, L));
        }
    }
    return DALCS_OK;
}

/* Perfect coupling makes their voltages multiples of those of the independent ones. */
static enum dalcs_status stamp_dependent_coils(struct stamps *b, const struct coil_group *g) {
    struct dalcs_layout *l = b->layout;
    const struct dalcs_circuit *c = l->circuit;
    int rank = g->split.rank;
    int n_dependent = g->n - rank;
    for (int k = 0; k < n_dependent; k++) {
        int device = g->device[g->split.coil[rank + k]];
        const struct dalcs_device *d = &c->device[device];
        int column;
        int row;
        dalcs_stamp_new_branch(b, device, &column, &row);
        DALCS_TRY(dalcs_stamp_add_voltage(b, &b->A, row, d->node[0], d->node[1], 1.0));
        for (int i = 0; i < rank; i++) {
            int independent = g->device[g->split.coil[i]];
            const struct dalcs_device *e = &c->device[independent];
            double ratio = g->split.ratio[i * n_dependent + k];
            DALCS_TRY(dalcs_stamp_add_voltage(b, &b->A, row, e->node[0], e->node[1], -ratio));
            b->initial[l->state_column[independent]] += ratio * d->initial;
        }
    }
    return DALCS_OK;
}

/* All coils of a group, when its first one is met. */
static enum dalcs_status stamp_group(struct stamps *b, const struct coil_group *g) {
    struct dalcs_layout *l = b->layout;
    DALCS_TRY(stamp_independent_coils(b, g));
    DALCS_TRY(stamp_dependent_coils(b, g));
    int *column = dalcs_alloc((size_t)g->n + 1, sizeof(*column));
    double *coefficient = dalcs_alloc((size_t)g->n + 1, sizeof(*coefficient));
    enum dalcs_status status = column == NULL || coefficient == NULL ? DALCS_E_NOMEM : DALCS_OK;
    for (int i = 0; i < g->n && status == DALCS_OK; i++) {
        int n_terms = dalcs_layout_coil_current(l, g->device[i], column, coefficient);
        for (int k = 0; k < n_terms && status == DALCS_OK; k++) {
            status = dalcs_stamp_branch_current(b, &l->circuit->device[g->device[i]], column[k],
                                                coefficient[k]);
        }
    }
    free(column);
    free(coefficient);
    return status;
}

int dalcs_layout_coil_current(const struct dalcs_layout *l, int device, int *column,
                              double *coefficient) {
    if (l->state_column[device] < 0) {
        column[0] = l->current_column[device];
        coefficient[0] = 1.0;
        return 1;
    }
    column[0] = l->state_column[device];
    coefficient[0] = 1.0;
    int n = 1;
    if (l->group_of[device] >= 0) {
        const struct coil_group *g = &l->group[l->group_of[device]];
        int n_dependent = g->n - g->split.rank;
        for (int i = 0; i < g->split.rank; i++) {
            for (int k = 0; g->device[g->split.coil[i]] == device && k < n_dependent; k++) {
                column[n] = l->current_column[g->device[g->split.coil[g->split.rank + k]]];
                coefficient[n++] = -g->split.ratio[i * n_dependent + k];
            }
        }
    }
    return n;
}

/* An element that carries no current by convention: 0 = i. */
static enum dalcs_status stamp_idle_branch(struct stamps *b, int device) {
    int column;
    int row;
    dalcs_stamp_new_branch(b, device, &column, &row);
    b->s->row_is_current[row] = true;
    if (b->layout->circuit->device[device].kind == DALCS_VSOURCE) {
        (void)dalcs_stamp_new_input(b, device); /* switches may look at its voltage */
    }
    return dalcs_stamp_add(&b->A, row, column, -1.0);
}

/* V, E, H and shorts whose current is an unknown: 0 = v(a) - v(b) - (what drives it). */
static enum dalcs_status stamp_voltage_branch(struct stamps *b, int device) {
    struct dalcs_layout *l = b->layout;
    const struct dalcs_device *d = &l->circuit->device[device];
    int column;
    int row;
    if (l->topology.is_idle[device]) {
        return stamp_idle_branch(b, device);
    }
    dalcs_stamp_new_branch(b, device, &column, &row);
    DALCS_TRY(dalcs_stamp_branch_current(b, d, column, 1.0));
    DALCS_TRY(dalcs_stamp_add_voltage(b, &b->A, row, d->node[0], d->node[1], 1.0));
    switch (d->kind) {
    case DALCS_VSOURCE:
        return dalcs_triplets_add(&b->E, row, dalcs_stamp_new_input(b, device), -1.0);
    case DALCS_VCVS:
        for (int k = 2; k < 4; k++) {
            DALCS_TRY(dalcs_stamp_reads(b, device, row, dalcs_stamp_node_column(l, d->node[k])));
        }
        return dalcs_stamp_add_voltage(b, &b->A, row, d->node[2], d->node[3],
                                       d->is_delay && l->options->at_rest ? -1.0 : -d->value);
    default:
        return DALCS_OK;
    }
}

/* 0 = v(a) - v(b) - R i. */
static enum dalcs_status stamp_resistance(struct stamps *b, int device) {
    const struct dalcs_device *d = &b->layout->circuit->device[device];
    DALCS_TRY(stamp_voltage_branch(b, device));
    return dalcs_stamp_add(&b->A, b->layout->branch_row[device], b->layout->current_column[device],
                           -d->value);
}

static enum dalcs_status stamp_resistor(struct stamps *b, int device) {
    const struct dalcs_device *d = &b->layout->circuit->device[device];
    if (d->value == 0.0) {
        return stamp_voltage_branch(b, device);
    }
    if (d->value < 0.0) {
        b->s->monotone = false;
        DALCS_TRY(dalcs_stamp_reads_voltage(b, device, d->node[0], d->node[1]));
    }
    return dalcs_layout_is_branch(b->layout, device)
               ? stamp_resistance(b, device)
               : dalcs_stamp_conductance(b, d, 1.0 / d->value);
}

/* Pairs: w = v(cathode) - v(anode) + Vfwd + Ron lambda >= 0. */
static enum dalcs_status stamp_pair(struct stamps *b, int anode, int cathode, double threshold,
                                    double ron, struct dalcs_pair pair) {
    struct dalcs_system *s = b->s;
    int k = b->next_pair++;
    int column = s->n_x + s->n_z + k;
    s->pair[k] = pair;
    s->column_is_current[column] = true;
    DALCS_TRY(dalcs_stamp_leave(b, &b->A, anode, column, 1.0));
    DALCS_TRY(dalcs_stamp_leave(b, &b->A, cathode, column, -1.0));
    DALCS_TRY(dalcs_stamp_add_voltage(b, &b->C, k, cathode, anode, 1.0));
    DALCS_TRY(dalcs_stamp_add(&b->C, k, column, ron));
    return threshold == 0.0 ? DALCS_OK : dalcs_triplets_add(&b->F, k, 0, threshold);
}

/* Roff lies across two branches, one of Vfwd and Ron and one of Vrev and Rrev. */
static enum dalcs_status stamp_diode(struct stamps *b, int device) {
    const struct dalcs_circuit *c = b->layout->circuit;
    const struct dalcs_device *d = &c->device[device];
    const struct dalcs_diode_model *m = &c->models.of_diode[d->model];
    b->layout->pair[device] = b->next_pair;
    struct dalcs_pair pair = {.kind = DALCS_PAIR_DIODE, .element = d->name};
    DALCS_TRY(stamp_pair(b, d->node[0], d->node[1], m->vfwd, m->ron, pair));
    if (isfinite(m->vrev)) {
        pair.is_breakdown = true;
        DALCS_TRY(stamp_pair(b, d->node[1], d->node[0], m->vrev, m->rrev, pair));
    }
    return isfinite(m->roff) ? dalcs_stamp_conductance(b, d, 1.0 / m->roff) : DALCS_OK;
}

static bool is_direct(const struct dalcs_layout *l, const struct dalcs_device *d) {
    const struct dalcs_topology *t = &l->topology;
    const int root = t->potential_root[t->node_of[d->node[2]]];
    return root >= 0 && root == t->potential_root[t->node_of[d->node[3]]];
}

double dalcs_stamp_control_sign(const struct dalcs_switch_model *m) {
    return m->is_inverted ? -1.0 : 1.0;
}

/* A switch with finite Roff is Roff in parallel with a branch that makes up Ron when closed. */
static enum dalcs_status stamp_switch(struct stamps *b, int device) {
    const struct dalcs_circuit *c = b->layout->circuit;
    const struct dalcs_device *d = &c->device[device];
    const struct dalcs_switch_model *m = &c->models.of_switch[d->model];
    struct dalcs_pair pair = {.kind = DALCS_PAIR_SWITCH,
                              .element = d->name,
                              .initially_on = d->initially_on,
                              .turn_on = m->vt + m->vh,
                              .turn_off = m->vt - m->vh};
    b->layout->pair[device] = b->next_pair;
    if (d->control < 0) {
        DALCS_TRY(dalcs_stamp_add_voltage(b, &b->control, b->next_pair, d->node[2], d->node[3],
                                          dalcs_stamp_control_sign(m)));
        pair.is_direct = d->valve < 0 && is_direct(b->layout, d);
    }
    DALCS_TRY(
        stamp_pair(b, d->node[0], d->node[1], 0.0, dalcs_stamp_series_part(m->ron, m->roff), pair));
    return isfinite(m->roff) ? dalcs_stamp_conductance(b, d, 1.0 / m->roff) : DALCS_OK;
}

enum dalcs_status dalcs_stamp_device(struct stamps *b, int device, int *next_forest) {
    struct dalcs_layout *l = b->layout;
    const struct dalcs_device *d = &l->circuit->device[device];
    if (d->behaviour != NULL) {
        return dalcs_stamp_behaviour_branch(b, device);
    }
    switch (d->kind) {
    case DALCS_RESISTOR:
        return stamp_resistor(b, device);
    case DALCS_INDUCTOR:
        if (l->group_of[device] < 0) {
            return stamp_coil(b, device);
        }
        return l->group[l->group_of[device]].device[0] == device
                   ? stamp_group(b, &l->group[l->group_of[device]])
                   : DALCS_OK;
    case DALCS_CAPACITOR:
        return stamp_capacitor(b, device, l->topology.in_forest[device] ? (*next_forest)++ : -1);
    case DALCS_VSOURCE:
        return stamp_voltage_branch(b, device);
    case DALCS_ISOURCE: {
        int input = dalcs_stamp_new_input(b, device);
        DALCS_TRY(dalcs_stamp_leave(b, &b->E, d->node[0], input, 1.0));
        return dalcs_stamp_leave(b, &b->E, d->node[1], input, -1.0);
    }
    case DALCS_VCVS:
    case DALCS_CCVS:
        b->s->monotone = false;
        return stamp_voltage_branch(b, device);
    case DALCS_VCCS:
        b->s->monotone = false;
        DALCS_TRY(dalcs_stamp_reads_voltage(b, device, d->node[2], d->node[3]));
        return dalcs_stamp_transconductance(b, d->node[0], d->node[1], d->node[2], d->node[3],
                                            d->value);
    case DALCS_CCCS:
        b->s->monotone = false;
        return DALCS_OK;
    case DALCS_DIODE:
        return stamp_diode(b, device);
    case DALCS_SWITCH:
        return stamp_switch(b, device);
    }
    return DALCS_OK;
}
