/* screen_rows.c - the laws and signs of a mode as linear functions of what is stored. */
#include "screen.h"

#include <string.h>

struct filling {
    struct dalcs_audit *audit;
    struct audit_part *part;
    struct audit_watch *watch;
    struct audit_screen *screen;
    const struct dalcs_audit_state *s; /* of the mode */
    int index;                         /* of the part */
    double step;                       /* s */
    bool complete;
};

/* ---- Sums ---------------------------------------------------------------------------------------- */

static void add_node(const struct filling *f, struct dalcs_audit_row *row, int node,
                     double factor) {
    const struct dalcs_audit_reader *r = &f->audit->reader;
    if (node > 0 && factor != 0.0) {
        r->add_voltage(r->user, f->index, node, factor, row);
    }
}

/* Of a branch, or between the two nodes that control it. */
static void add_voltage(const struct filling *f, struct dalcs_audit_row *row,
                        const struct dalcs_device *d, int first, double factor) {
    add_node(f, row, d->node[first], factor);
    add_node(f, row, d->node[first + 1], -factor);
}

static void add_read_current(const struct filling *f, struct dalcs_audit_row *row, int device,
                             double factor) {
    const struct dalcs_audit_reader *r = &f->audit->reader;
    if (factor != 0.0) {
        r->add_current(r->user, f->index, device, factor, row);
    }
}

/* As audit_current() has it. */
static void add_current(const struct filling *f, struct dalcs_audit_row *row, int device,
                        double factor) {
    const struct dalcs_device *d = &f->audit->circuit->device[device];
    if (d->behaviour != NULL) {
        add_read_current(f, row, device, factor);
        return;
    }
    switch (d->kind) {
    case DALCS_RESISTOR:
        add_voltage(f, row, d, 0, d->value != 0.0 ? factor / d->value : 0.0);
        break;
    case DALCS_ISOURCE:
        dalcs_audit_row_add_stimulus(row, d->stimulus, factor);
        break;
    case DALCS_VCCS:
        add_voltage(f, row, d, 2, factor * d->value);
        break;
    case DALCS_CCCS:
        add_read_current(f, row, d->control, factor * d->value);
        break;
    default:
        add_read_current(f, row, device, factor);
        break;
    }
}

static void add_affine(const struct filling *f, struct dalcs_audit_row *row, int device,
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
            r->add_lambda(r->user, f->index, f->audit->first_lambda[device] + term->index, times,
                          row);
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

static void list(struct filling *f, int index, double factor) {
    struct audit_screen *screen = f->screen;
    f->complete =
        f->complete && dalcs_grow(&screen->term, &screen->term_room, (size_t)screen->n_terms + 1,
                                  sizeof(*screen->term)) == DALCS_OK;
    if (f->complete) {
        screen->term[screen->n_terms++] = (struct audit_term){index, factor};
    }
}

/* Those that do not cancel. What is the same at all times goes into the constant. */
static int list_stimuli(struct filling *f, struct dalcs_audit_row *row) {
    int n = 0;
    for (int k = 0; k < row->n_stimuli; k++) {
        const int index = row->listed_stimulus[k];
        const double factor = row->stimulus[index];
        const struct dalcs_stimulus *s = &f->audit->circuit->stimulus[index];
        if (s->kind == DALCS_STIMULUS_DC) {
            row->constant += factor * dalcs_stimulus_value(s, 0.0, DALCS_RIGHT);
        } else if (factor != 0.0) {
            list(f, index, factor);
            n++;
        }
    }
    return n;
}

/* value / allowed >= -1, of the row for signs, which is empty thereafter. */
static void put_sign(struct filling *f) {
    struct audit_screen *screen = f->screen;
    struct dalcs_audit_row *row = &f->watch->row[AUDIT_N_ROWS];
    f->complete =
        f->complete && dalcs_grow(&screen->sign, &screen->sign_room, (size_t)screen->n_signs + 1,
                                  sizeof(*screen->sign)) == DALCS_OK;
    if (f->complete) {
        struct audit_sign sign = {.first = screen->n_terms, .n = row->n_columns};
        for (int k = 0; k < row->n_columns; k++) {
            list(f, row->listed_column[k], row->column[row->listed_column[k]]);
        }
        sign.n_stimuli = list_stimuli(f, row);
        sign.constant = row->constant;
        screen->sign[screen->n_signs++] = sign;
    }
    clear(row);
}

/* ---- Branches ------------------------------------------------------------------------------------ */

static struct dalcs_audit_row *now(const struct filling *f) {
    return &f->watch->row[AUDIT_ROW_NOW];
}

static struct dalcs_audit_row *sign(const struct filling *f) {
    return &f->watch->row[AUDIT_N_ROWS];
}

static double over(const struct filling *f, double allowed) {
    return audit_screen_weight(f->audit) / fmax(allowed, 0x1p-500);
}

/* factor (i - v/roff) */
static void add_own_current(const struct filling *f, struct dalcs_audit_row *row, int device,
                            double roff, double factor) {
    const struct dalcs_device *d = &f->audit->circuit->device[device];
    add_read_current(f, row, device, factor);
    add_voltage(f, row, d, 0, isfinite(roff) ? -factor / roff : 0.0);
}

/* factor (v - at - r own) */
static void add_line(const struct filling *f, struct dalcs_audit_row *row, int device, double roff,
                     double at, double r, double factor) {
    add_voltage(f, row, &f->audit->circuit->device[device], 0, factor);
    row->constant -= factor * at;
    add_own_current(f, row, device, roff, -r * factor);
}

static void fill_diode(struct filling *f, int device) {
    const struct dalcs_device *d = &f->audit->circuit->device[device];
    const struct dalcs_diode_model *m = &f->audit->circuit->diode_model[d->model];
    double scale[2];
    audit_diode_scale(f->audit, f->part, device, scale);
    const double allowed[2] = {f->part->tolerance * scale[0],
                               f->part->tolerance * scale[1] + f->audit->options.abstol};
    const double v = audit_voltage(f->s, d);
    const double own = f->s->i[device] - (isfinite(m->roff) ? v / m->roff : 0.0);
    if (own > 0.0 && fabs(m->vfwd + m->ron * own - v) * scale[1] <= own * scale[0]) {
        add_line(f, now(f), device, m->roff, m->vfwd, m->ron, over(f, allowed[0]));
        add_own_current(f, sign(f), device, m->roff, 1.0 / allowed[1]);
        put_sign(f);
    } else if (own < 0.0 && isfinite(m->vrev) &&
               fabs(m->vrev - m->rrev * own + v) * scale[1] <= -own * scale[0]) {
        add_line(f, now(f), device, m->roff, -m->vrev, m->rrev, over(f, allowed[0]));
        add_own_current(f, sign(f), device, m->roff, -1.0 / allowed[1]);
        put_sign(f);
    } else {
        add_own_current(f, now(f), device, m->roff, over(f, allowed[1]));
        add_line(f, sign(f), device, INFINITY, m->vfwd, 0.0, -1.0 / allowed[0]);
        put_sign(f);
        if (isfinite(m->vrev)) {
            add_line(f, sign(f), device, INFINITY, -m->vrev, 0.0, 1.0 / allowed[0]);
            put_sign(f);
        }
    }
}

static void fill_switch(struct filling *f, int device) {
    const struct dalcs_device *d = &f->audit->circuit->device[device];
    const struct dalcs_switch_model *m = &f->audit->circuit->switch_model[d->model];
    const bool is_closed = f->s->is_closed[device];
    const double rounding = fmax(f->audit->sums.rounding[f->audit->node_of[d->node[0]]],
                                 f->audit->sums.rounding[f->audit->node_of[d->node[1]]]) +
                            f->audit->sums.amperes;
    if (is_closed) {
        const double volts = audit_volts(f->audit, f->part, d->node[0], d->node[1]);
        add_line(f, now(f), device, INFINITY, 0.0, m->ron,
                 over(f, f->part->tolerance * volts + m->ron * rounding + f->audit->options.vntol));
    } else {
        const double amperes = audit_amperes(f->audit, f->part, device);
        add_own_current(
            f, now(f), device, m->roff,
            over(f, f->part->tolerance * amperes + rounding + f->audit->options.abstol));
    }
    /* closed: control - (vt - vh) >= 0, open: (vt + vh) - control >= 0 */
    const double allowed =
        f->part->tolerance * audit_control_scale(f->audit, f->part, device) + 0x1p-500;
    const double factor = (is_closed ? 1.0 : -1.0) / allowed;
    const double of_control = m->is_inverted ? -factor : factor;
    sign(f)->constant = -factor * m->vt + fabs(m->vh) / allowed;
    if (d->control >= 0) {
        add_read_current(f, sign(f), d->control, of_control);
    } else {
        add_voltage(f, sign(f), d, 2, of_control);
    }
    put_sign(f);
}

/* What an affine function is held to: the sizes of its terms at this state, of its scales where these are more. */
static double size_of(const struct filling *f, int device, const struct dalcs_affine *a) {
    double size = fabs(a->constant);
    for (int k = 0; k < a->n; k++) {
        const struct dalcs_affine_term *term = &a->term[k];
        double of;
        switch (term->kind) {
        case DALCS_QUANTITY_VOLTAGE:
            of = term->index > 0 ? audit_volts(f->audit, f->part, term->index, 0) : 0.0;
            break;
        case DALCS_QUANTITY_CURRENT:
            of = audit_amperes(f->audit, f->part, term->index);
            break;
        case DALCS_QUANTITY_PAIR:
            of = f->audit->lambda_scale[f->audit->first_lambda[device] + term->index];
            break;
        default:
            of = fabs(dalcs_stimulus_value(&f->audit->circuit->stimulus[term->index], f->s->t,
                                           f->s->side));
            break;
        }
        size += fabs(term->coefficient) * of;
    }
    return size;
}

static double value_of(const struct filling *f, int device, const struct dalcs_affine *a) {
    double sum = a->constant;
    for (int k = 0; k < a->n; k++) {
        const struct dalcs_affine_term *term = &a->term[k];
        const double of = term->kind == DALCS_QUANTITY_VOLTAGE ? f->s->v[term->index]
                          : term->kind == DALCS_QUANTITY_CURRENT
                              ? audit_current(f->audit, f->s, term->index)
                          : term->kind == DALCS_QUANTITY_PAIR
                              ? f->s->lambda[f->audit->first_lambda[device] + term->index]
                              : dalcs_stimulus_value(&f->audit->circuit->stimulus[term->index],
                                                     f->s->t, f->s->side);
        sum += term->coefficient * of;
    }
    return sum;
}

static void fill_formula(struct filling *f, int device) {
    const struct dalcs_device *d = &f->audit->circuit->device[device];
    const struct dalcs_audit_reader *r = &f->audit->reader;
    const struct dalcs_behaviour *b = d->behaviour;
    const bool is_voltage = d->kind == DALCS_VCVS;
    const double held = size_of(f, device, &b->output) +
                        (is_voltage ? audit_volts(f->audit, f->part, d->node[0], d->node[1])
                                    : audit_amperes(f->audit, f->part, device));
    const double factor = over(f, f->part->tolerance * held);
    add_affine(f, now(f), device, &b->output, -factor);
    if (is_voltage) {
        add_voltage(f, now(f), d, 0, factor);
    } else {
        add_read_current(f, now(f), device, factor);
    }
    for (int k = 0; k < b->n_pairs; k++) {
        const int pair = f->audit->first_lambda[device] + k;
        const double size = fmax(size_of(f, device, &b->w[k]), 0x1p-500);
        const double lambda_size = fmax(f->audit->lambda_scale[pair], 0x1p-500);
        const double w = value_of(f, device, &b->w[k]);
        const double tolerance = f->part->tolerance;
        if (f->s->lambda[pair] * size > fabs(w) * lambda_size) {
            add_affine(f, now(f), device, &b->w[k], over(f, tolerance * size));
            r->add_lambda(r->user, f->index, pair, 1.0 / (tolerance * lambda_size), sign(f));
        } else {
            r->add_lambda(r->user, f->index, pair, over(f, tolerance * lambda_size), now(f));
            add_affine(f, sign(f), device, &b->w[k], 1.0 / (tolerance * size));
        }
        put_sign(f);
    }
}

/* The flux of a coil from the start on, less the integral of its voltage. */
static void fill_coil(struct filling *f, int device) {
    const struct dalcs_device *d = &f->audit->circuit->device[device];
    const double volts = audit_volts(f->audit, f->part, d->node[0], d->node[1]);
    const double factor = over(
        f, f->part->tolerance * (audit_flux_scale(f->audit, f->part, device) + volts * f->step) +
               f->audit->options.vntol * f->step);
    struct dalcs_audit_row *start = &f->watch->row[AUDIT_ROW_START];
    add_voltage(f, &f->watch->row[AUDIT_ROW_FLOW], d, 0, -factor);
    add_read_current(f, start, device, factor * d->value);
    for (int k = 0; k < f->part->n_couplings; k++) {
        const struct dalcs_coupling *m = &f->audit->circuit->coupling[f->part->coupling[k]];
        for (int e = 0; e < 2; e++) {
            if (m->inductor[e] == device) {
                const int other = m->inductor[1 - e];
                const double mutual =
                    m->k * sqrt(d->value * f->audit->circuit->device[other].value);
                add_read_current(f, start, other, factor * mutual);
            }
        }
    }
}

static void fill_branch(struct filling *f, int device) {
    const struct dalcs_device *d = &f->audit->circuit->device[device];
    const double tolerance = f->part->tolerance;
    double scale = audit_volts(f->audit, f->part, d->node[0], d->node[1]);
    double factor;
    if (d->behaviour != NULL) {
        fill_formula(f, device);
        return;
    }
    switch (d->kind) {
    case DALCS_VSOURCE:
        factor = over(f, tolerance * scale + f->audit->options.vntol);
        add_voltage(f, now(f), d, 0, factor);
        dalcs_audit_row_add_stimulus(now(f), d->stimulus, -factor);
        break;
    case DALCS_VCVS:
        scale += fabs(d->value) * audit_volts(f->audit, f->part, d->node[2], d->node[3]);
        factor = over(f, tolerance * scale + fabs(d->value) * f->audit->sums.volts +
                             f->audit->options.vntol);
        add_voltage(f, now(f), d, 0, factor);
        add_voltage(f, now(f), d, 2, -factor * d->value);
        break;
    case DALCS_CCVS:
        scale += fabs(d->value) * audit_amperes(f->audit, f->part, d->control);
        factor = over(f, tolerance * scale + fabs(d->value) * f->audit->sums.amperes +
                             f->audit->options.vntol);
        add_voltage(f, now(f), d, 0, factor);
        add_read_current(f, now(f), d->control, -factor * d->value);
        break;
    case DALCS_DIODE:
        fill_diode(f, device);
        break;
    case DALCS_SWITCH:
        fill_switch(f, device);
        break;
    case DALCS_INDUCTOR:
        fill_coil(f, device);
        break;
    default:
        break;
    }
}

/* ---- Nodes and states ---------------------------------------------------------------------------- */

/* Of each node, in the sum: as a current, or where capacitors hang on it as a charge. */
static void weigh_nodes(struct filling *f) {
    const struct dalcs_audit *audit = f->audit;
    double *by_current = f->watch->node_weight;
    double *by_charge = f->watch->node_weight + audit->circuit->n_nodes;
    double *charge = audit->offset; /* free between events */
    by_current[0] = by_charge[0] = 0.0;
    for (int k = 0; k < f->part->n_nodes; k++) {
        charge[f->part->node[k]] = 0.0;
    }
    for (int k = 0; k < f->part->n_devices; k++) {
        const struct dalcs_device *d = &audit->circuit->device[f->part->device[k]];
        for (int e = 0; e < 2 && d->kind == DALCS_CAPACITOR; e++) {
            charge[audit->node_of[d->node[e]]] +=
                d->value * audit_volts(audit, f->part, d->node[0], d->node[1]);
        }
    }
    for (int k = 0; k < f->part->n_nodes; k++) {
        const int node = f->part->node[k];
        const double amperes = f->part->tolerance * audit->sums.scale[node] +
                               audit->sums.rounding[node] + audit->options.abstol;
        const bool is_charge = audit->has_charge[node];
        by_current[node] = is_charge ? 0.0 : over(f, amperes);
        by_charge[node] =
            is_charge ? over(f, f->part->tolerance * charge[node] + amperes * f->step) : 0.0;
    }
}

/* A device's part in Kirchhoff's laws at its two ends. */
static void fill_nodes(const struct filling *f, int device) {
    const struct dalcs_audit *audit = f->audit;
    const struct dalcs_device *d = &audit->circuit->device[device];
    const int n_nodes = audit->circuit->n_nodes;
    const int a = audit->node_of[d->node[0]];
    const int b = audit->node_of[d->node[1]];
    const double *weight = f->watch->node_weight;
    const double by_charge = weight[n_nodes + a] - weight[n_nodes + b];
    if (d->kind == DALCS_CAPACITOR) {
        add_voltage(f, &f->watch->row[AUDIT_ROW_START], d, 0, by_charge * d->value);
        return;
    }
    if (weight[a] != weight[b]) {
        add_current(f, now(f), device, weight[a] - weight[b]);
    }
    if (by_charge != 0.0) {
        add_current(f, &f->watch->row[AUDIT_ROW_FLOW], device, by_charge);
    }
}

/* What stays what it is from one stretch to the next. */
static void fill_state(const struct filling *f, int k) {
    const int device = f->part->device[k];
    const struct dalcs_device *d = &f->audit->circuit->device[device];
    struct dalcs_audit_row *row = &f->watch->row[AUDIT_ROW_STATES];
    if (d->kind == DALCS_CAPACITOR) {
        add_voltage(f, row, d, 0, f->watch->state_factor[k]);
    } else if (d->kind == DALCS_INDUCTOR) {
        add_read_current(f, row, device, f->watch->state_factor[k]);
    }
}

/* Charges and fluxes at a time and at the start are the same function. */
static void add_start(const struct filling *f) {
    const struct dalcs_audit_row *start = &f->watch->row[AUDIT_ROW_START];
    for (int k = 0; k < start->n_columns; k++) {
        dalcs_audit_row_add_column(now(f), start->listed_column[k],
                                   start->column[start->listed_column[k]]);
    }
}

bool audit_screen_fill(struct dalcs_audit *audit, struct audit_part *part,
                       struct audit_screen *screen, double step,
                       const struct dalcs_audit_state *s) {
    struct filling f = {audit, part, part->watch, screen, s, (int)(part - audit->part), step, true};
    for (int k = 0; k <= AUDIT_N_ROWS; k++) {
        clear(&f.watch->row[k]);
    }
    screen->n_terms = screen->n_signs = 0;
    audit_sum_currents(audit, part, s);
    weigh_nodes(&f);
    for (int k = 0; k < part->n_devices; k++) {
        fill_nodes(&f, part->device[k]);
        fill_state(&f, k);
    }
    for (int k = 0; k < part->n_devices; k++) {
        fill_branch(&f, part->device[k]);
    }
    add_start(&f);
    screen->first = screen->n_terms;
    screen->n_stimuli = list_stimuli(&f, now(&f));
    screen->n_flows = list_stimuli(&f, &f.watch->row[AUDIT_ROW_FLOW]);
    return f.complete && f.watch->row[AUDIT_ROW_START].n_stimuli == 0;
}

void audit_screen_put_rows(struct audit_watch *watch, struct audit_screen *screen, int n) {
    memset(screen->row, 0, AUDIT_N_ROWS * (size_t)n * sizeof(double));
    for (int r = 0; r < AUDIT_N_ROWS; r++) {
        const struct dalcs_audit_row *row = &watch->row[r];
        for (int k = 0; k < row->n_columns; k++) {
            screen->row[r * n + row->listed_column[k]] = row->column[row->listed_column[k]];
        }
    }
    screen->constant = watch->row[AUDIT_ROW_NOW].constant;
    screen->rate = watch->row[AUDIT_ROW_FLOW].constant;
}
