/* screen_rows.c - sums and lists of linear functions of what is stored: Kirchhoff's laws, states. */
#include "screen_rows.h"

/* ---- Sums ---------------------------------------------------------------------------------------- */

static void add_node(const struct audit_filling *f, struct dalcs_audit_row *row, int node,
                     double factor) {
    const struct dalcs_audit_reader *r = &f->audit->reader;
    if (node > 0 && factor != 0.0) {
        r->add_voltage(r->user, f->index, node, factor, row);
    }
}

/* Of a branch, or between the two nodes that control it. */
void audit_add_voltage(const struct audit_filling *f, struct dalcs_audit_row *row,
                       const struct dalcs_device *d, int first, double factor) {
    add_node(f, row, d->node[first], factor);
    add_node(f, row, d->node[first + 1], -factor);
}

void audit_add_read_current(const struct audit_filling *f, struct dalcs_audit_row *row, int device,
                            double factor) {
    const struct dalcs_audit_reader *r = &f->audit->reader;
    if (factor != 0.0) {
        r->add_current(r->user, f->index, device, factor, row);
    }
}

/* As audit_current() has it. */
static void add_current(const struct audit_filling *f, struct dalcs_audit_row *row, int device,
                        double factor) {
    const struct dalcs_device *d = &f->audit->circuit->device[device];
    if (d->behaviour != NULL) {
        audit_add_read_current(f, row, device, factor);
        return;
    }
    switch (d->kind) {
    case DALCS_RESISTOR:
        if (f->audit->net.is_told[device]) {
            audit_add_read_current(f, row, device, factor);
        } else {
            audit_add_voltage(f, row, d, 0, factor / d->value);
        }
        break;
    case DALCS_ISOURCE:
        dalcs_audit_row_add_stimulus(row, d->stimulus, factor);
        break;
    case DALCS_VCCS:
        audit_add_voltage(f, row, d, 2, factor * d->value);
        break;
    case DALCS_CCCS:
        audit_add_read_current(f, row, d->control, factor * d->value);
        break;
    default:
        audit_add_read_current(f, row, device, factor);
        break;
    }
}

void audit_add_affine(const struct audit_filling *f, struct dalcs_audit_row *row, int device,
                      const struct dalcs_affine *a, double factor) {
    const struct dalcs_audit_reader *r = &f->audit->reader;
    row->constant += factor * a->constant;
    for (int k = 0; k < a->n; k++) {
        const struct dalcs_affine_term *term = &a->term[k];
        const double times = factor * term->coefficient;
        switch (term->kind) {
        case DALCS_QUANTITY_VOLTAGE:
            add_node(f, row, term->index, times);
            break;
        case DALCS_QUANTITY_CURRENT:
            add_current(f, row, term->index, times);
            break;
        case DALCS_QUANTITY_PAIR:
            r->add_lambda(r->user, f->index, f->audit->net.first_lambda[device] + term->index,
                          times, row);
            break;
        default:
            dalcs_audit_row_add_stimulus(row, term->index, times);
            break;
        }
    }
}

static void clear(struct dalcs_audit_row *row) {
    for (int k = 0; k < row->n_columns; k++) {
        row->column[row->listed_column[k]] = 0.0;
        row->has_column[row->listed_column[k]] = false;
    }
    for (int k = 0; k < row->n_stimuli; k++) {
        row->stimulus[row->listed_stimulus[k]] = 0.0;
        row->has_stimulus[row->listed_stimulus[k]] = false;
    }
    row->n_columns = row->n_stimuli = 0;
    row->constant = 0.0;
}

/* ---- Lists --------------------------------------------------------------------------------------- */

static void list(struct audit_sums_of_laws *fill, enum audit_term_kind kind,
                 struct audit_term term) {
    struct audit_list *to = &fill->list[kind];
    fill->complete = fill->complete && dalcs_grow(&to->term, &to->room, (size_t)to->n + 1,
                                                  sizeof(*to->term)) == DALCS_OK;
    if (fill->complete) {
        to->term[to->n++] = term;
    }
}

/* Those that do not cancel. What is the same at all times goes into the constant. */
static void list_stimuli(struct audit_filling *f, struct dalcs_audit_row *row,
                         enum audit_term_kind kind, int place) {
    for (int k = 0; k < row->n_stimuli; k++) {
        const int index = row->listed_stimulus[k];
        const double factor = row->stimulus[index];
        const struct dalcs_stimulus *s = &f->audit->circuit->stimulus[index];
        if (s->kind == DALCS_STIMULUS_DC) {
            row->constant += factor * dalcs_stimulus_value(s, 0.0, DALCS_RIGHT);
        } else if (factor != 0.0) {
            list(&f->watch->fill, kind, (struct audit_term){place, index, factor});
        }
    }
}

static void add_constant(struct audit_sums_of_laws *fill, double **list, size_t *room, int *n,
                         double constant) {
    fill->complete =
        fill->complete && dalcs_grow(list, room, (size_t)*n + 1, sizeof(**list)) == DALCS_OK;
    if (fill->complete) {
        (*list)[(*n)++] = constant;
    }
}

/* value / allowed >= -1, of the row for signs, which is empty thereafter. */
void audit_put_sign(struct audit_filling *f) {
    struct audit_sums_of_laws *fill = &f->watch->fill;
    struct dalcs_audit_row *row = &fill->row[AUDIT_N_ROWS];
    const int place = AUDIT_PLACE_SIGNS + AUDIT_SIGN_TIMES * fill->n_signs;
    for (int k = 0; k < row->n_columns; k++) {
        const int column = row->listed_column[k];
        list(fill, AUDIT_TERM_COLUMN, (struct audit_term){place, column, row->column[column]});
    }
    if (row->n_columns > 0) {
        list_stimuli(f, row, AUDIT_TERM_SIGN, place);
        add_constant(fill, &fill->sign, &fill->sign_room, &fill->n_signs, row->constant);
    } else {
        list_stimuli(f, row, AUDIT_TERM_GUARD, fill->n_guards);
        add_constant(fill, &fill->guard, &fill->guard_room, &fill->n_guards, row->constant);
    }
    clear(row);
}

/* ---- Nodes and states ---------------------------------------------------------------------------- */

/* Of each node, in the sum: as a current, or where capacitors hang on it as a charge. */
static void weigh_nodes(struct audit_filling *f) {
    const struct dalcs_audit *audit = f->audit;
    double *by_current = f->watch->fill.node_weight;
    double *by_charge = f->watch->fill.node_weight + audit->circuit->n_nodes;
    double *charge = audit->crossing.offset; /* free between events */
    by_current[0] = by_charge[0] = 0.0;
    for (int k = 0; k < f->part->n_nodes; k++) {
        charge[f->part->node[k]] = 0.0;
    }
    for (int k = 0; k < f->part->n_devices; k++) {
        const struct dalcs_device *d = &audit->circuit->device[f->part->device[k]];
        for (int e = 0; e < 2 && d->kind == DALCS_CAPACITOR; e++) {
            charge[audit->net.node_of[d->node[e]]] +=
                d->value * audit_volts(audit, f->part, d->node[0], d->node[1]);
        }
    }
    for (int k = 0; k < f->part->n_nodes; k++) {
        const int node = f->part->node[k];
        const double amperes = f->part->tolerance * audit->sums.scale[node] +
                               audit->sums.rounding[node] + audit->options.abstol;
        const bool is_charge = audit->net.has_charge[node];
        by_current[node] = is_charge ? 0.0 : audit_over(f, amperes);
        by_charge[node] =
            is_charge ? audit_over(f, f->part->tolerance * charge[node] + amperes * f->step) : 0.0;
    }
}

/* A device's part in Kirchhoff's laws at its two ends. */
static void fill_nodes(const struct audit_filling *f, int device) {
    const struct dalcs_audit *audit = f->audit;
    const struct dalcs_device *d = &audit->circuit->device[device];
    const int n_nodes = audit->circuit->n_nodes;
    const int a = audit->net.node_of[d->node[0]];
    const int b = audit->net.node_of[d->node[1]];
    const double *weight = f->watch->fill.node_weight;
    const double by_charge = weight[n_nodes + a] - weight[n_nodes + b];
    if (d->kind == DALCS_CAPACITOR) {
        audit_add_voltage(f, &f->watch->fill.row[AUDIT_ROW_START], d, 0, by_charge * d->value);
        return;
    }
    if (weight[a] != weight[b]) {
        add_current(f, audit_row_now(f), device, weight[a] - weight[b]);
    }
    if (by_charge != 0.0) {
        add_current(f, &f->watch->fill.row[AUDIT_ROW_FLOW], device, by_charge);
    }
}

/* What stays what it is from one stretch to the next. */
static void fill_state(const struct audit_filling *f, int k) {
    const int device = f->part->device[k];
    const struct dalcs_device *d = &f->audit->circuit->device[device];
    struct dalcs_audit_row *row = &f->watch->fill.row[AUDIT_ROW_STATES];
    if (d->kind == DALCS_CAPACITOR) {
        audit_add_voltage(f, row, d, 0, f->watch->state_factor[k]);
    } else if (d->kind == DALCS_INDUCTOR) {
        audit_add_read_current(f, row, device, f->watch->state_factor[k]);
    }
}

/* Charges and fluxes at a time and at the start are the same function. */
static void add_start(const struct audit_filling *f) {
    const struct dalcs_audit_row *start = &f->watch->fill.row[AUDIT_ROW_START];
    for (int k = 0; k < start->n_columns; k++) {
        dalcs_audit_row_add_column(audit_row_now(f), start->listed_column[k],
                                   start->column[start->listed_column[k]]);
    }
}

void audit_fill_begin(struct audit_sums_of_laws *fill) {
    for (int k = 0; k <= AUDIT_N_ROWS; k++) {
        clear(&fill->row[k]);
    }
    for (int k = 0; k < AUDIT_N_TERM_KINDS; k++) {
        fill->list[k].n = 0;
    }
    fill->n_signs = fill->n_guards = 0;
    fill->complete = true;
}

void audit_fill_common(struct audit_filling *f) {
    weigh_nodes(f);
    for (int k = 0; k < f->part->n_devices; k++) {
        fill_nodes(f, f->part->device[k]);
        fill_state(f, k);
        audit_fill_branch(f, f->part->device[k]);
    }
    add_start(f);
}

void audit_fill_end(struct audit_filling *f) {
    struct audit_sums_of_laws *fill = &f->watch->fill;
    list_stimuli(f, audit_row_now(f), AUDIT_TERM_LAW, AUDIT_PLACE_LAWS);
    list_stimuli(f, &fill->row[AUDIT_ROW_FLOW], AUDIT_TERM_FLOW, AUDIT_PLACE_LAWS);
    fill->complete = fill->complete && fill->row[AUDIT_ROW_START].n_stimuli == 0;
}
