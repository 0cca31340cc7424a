/* screen_branches.c - the laws and signs of branches as linear functions, on the side that a state is on. */
#include "audit_currents.h"
#include "audit_positions.h"
#include "screen_rows.h"

static struct dalcs_audit_row *sign(const struct audit_filling *f) {
    return &f->watch->fill.row[AUDIT_N_ROWS];
}

/* factor (i - v/roff) */
static void add_own_current(const struct audit_filling *f, struct dalcs_audit_row *row, int device,
                            double roff, double factor) {
    const struct dalcs_device *d = &f->audit->circuit->device[device];
    audit_add_read_current(f, row, device, factor);
    audit_add_voltage(f, row, d, 0, isfinite(roff) ? -factor / roff : 0.0);
}

/* factor (v - at - r own) */
static void add_line(const struct audit_filling *f, struct dalcs_audit_row *row, int device,
                     double roff, double at, double r, double factor) {
    audit_add_voltage(f, row, &f->audit->circuit->device[device], 0, factor);
    row->constant -= factor * at;
    add_own_current(f, row, device, roff, -r * factor);
}

static void fill_diode(struct audit_filling *f, int device, enum audit_side side) {
    const struct dalcs_device *d = &f->audit->circuit->device[device];
    const struct dalcs_diode_model *m = &f->audit->circuit->models.of_diode[d->model];
    double scale[2];
    audit_diode_scale(f->audit, f->part, device, scale);
    const double allowed[2] = {f->part->tolerance * scale[0],
                               f->part->tolerance * scale[1] + f->audit->options.abstol};
    if (side == AUDIT_ON) {
        add_line(f, audit_row_now(f), device, m->roff, m->vfwd, m->ron, audit_over(f, allowed[0]));
        add_own_current(f, sign(f), device, m->roff, 1.0 / allowed[1]);
        audit_put_sign(f);
    } else if (side == AUDIT_IN_BREAKDOWN) {
        add_line(f, audit_row_now(f), device, m->roff, -m->vrev, m->rrev,
                 audit_over(f, allowed[0]));
        add_own_current(f, sign(f), device, m->roff, -1.0 / allowed[1]);
        audit_put_sign(f);
    } else {
        add_own_current(f, audit_row_now(f), device, m->roff, audit_over(f, allowed[1]));
        add_line(f, sign(f), device, INFINITY, m->vfwd, 0.0, -1.0 / allowed[0]);
        audit_put_sign(f);
        if (isfinite(m->vrev)) {
            add_line(f, sign(f), device, INFINITY, -m->vrev, 0.0, 1.0 / allowed[0]);
            audit_put_sign(f);
        }
    }
}

static void fill_switch(struct audit_filling *f, int device, bool is_closed) {
    const struct dalcs_device *d = &f->audit->circuit->device[device];
    const struct dalcs_switch_model *m = &f->audit->circuit->models.of_switch[d->model];
    const double rounding = fmax(f->audit->sums.rounding[f->audit->net.node_of[d->node[0]]],
                                 f->audit->sums.rounding[f->audit->net.node_of[d->node[1]]]) +
                            f->audit->sums.amperes;
    if (is_closed) {
        const double volts = audit_volts(f->audit, f->part, d->node[0], d->node[1]);
        add_line(f, audit_row_now(f), device, INFINITY, 0.0, m->ron,
                 audit_over(f, f->part->tolerance * volts + m->ron * rounding +
                                   f->audit->options.vntol));
    } else {
        const double amperes = audit_amperes(f->audit, f->part, device);
        add_own_current(
            f, audit_row_now(f), device, m->roff,
            audit_over(f, f->part->tolerance * amperes + rounding + f->audit->options.abstol));
    }
    /* closed: control - (vt - vh) >= 0, open: (vt + vh) - control >= 0 */
    const double allowed =
        f->part->tolerance * audit_control_scale(f->audit, f->part, device) + 0x1p-500;
    const double factor = (is_closed ? 1.0 : -1.0) / allowed;
    const double of_control = m->is_inverted ? -factor : factor;
    sign(f)->constant = -factor * m->vt + fabs(m->vh) / allowed;
    if (d->control >= 0) {
        audit_add_read_current(f, sign(f), d->control, of_control);
    } else {
        audit_add_voltage(f, sign(f), d, 2, of_control);
    }
    audit_put_sign(f);
}

/* What an affine function is held to: the sizes of its terms at this state, of its scales where these are more. */
static double size_of(const struct audit_filling *f, int device, const struct dalcs_affine *a) {
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
            of = f->audit->scale.lambda[f->audit->net.first_lambda[device] + term->index];
            break;
        default:
            of = fabs(
                dalcs_stimulus_value(&f->audit->circuit->stimulus[term->index], f->t, DALCS_RIGHT));
            break;
        }
        size += fabs(term->coefficient) * of;
    }
    return size;
}

/* What a formula puts out, if that is no smooth function. What a part of one does is looked at where that is read. */
static void fill_formula(struct audit_filling *f, int device) {
    const struct dalcs_device *d = &f->audit->circuit->device[device];
    const struct dalcs_behaviour *b = d->behaviour;
    const bool is_voltage = d->kind == DALCS_VCVS;
    if (b->smooth != NULL || (f->audit->net.is_inner != NULL && f->audit->net.is_inner[device])) {
        return;
    }
    const double held = size_of(f, device, &b->output) +
                        (is_voltage ? audit_volts(f->audit, f->part, d->node[0], d->node[1])
                                    : audit_amperes(f->audit, f->part, device));
    const double factor = audit_over(f, f->part->tolerance * held);
    audit_add_affine(f, audit_row_now(f), device, &b->output, -factor);
    if (is_voltage) {
        audit_add_voltage(f, audit_row_now(f), d, 0, factor);
    } else {
        audit_add_read_current(f, audit_row_now(f), device, factor);
    }
}

static void fill_pair(struct audit_filling *f, int device, int k, enum audit_side side) {
    const struct dalcs_audit_reader *r = &f->audit->reader;
    const struct dalcs_affine *w = &f->audit->circuit->device[device].behaviour->w[k];
    const int pair = f->audit->net.first_lambda[device] + k;
    const double size = fmax(size_of(f, device, w), 0x1p-500);
    const double lambda_size = fmax(f->audit->scale.lambda[pair], 0x1p-500);
    const double tolerance = f->part->tolerance;
    if (side == AUDIT_ON) {
        audit_add_affine(f, audit_row_now(f), device, w, audit_over(f, tolerance * size));
        r->add_lambda(r->user, f->index, pair, 1.0 / (tolerance * lambda_size), sign(f));
    } else {
        r->add_lambda(r->user, f->index, pair, audit_over(f, tolerance * lambda_size),
                      audit_row_now(f));
        audit_add_affine(f, sign(f), device, w, 1.0 / (tolerance * size));
    }
    audit_put_sign(f);
}

int audit_n_choices(const struct dalcs_circuit *circuit, int device) {
    const struct dalcs_device *d = &circuit->device[device];
    return d->behaviour != NULL                                ? d->behaviour->n_pairs
           : d->kind == DALCS_DIODE || d->kind == DALCS_SWITCH ? 1
                                                               : 0;
}

/* As the run has it: a wrong side can only ask for a look that was not needed. */
enum audit_side audit_side_of(const struct audit_filling *f, int device, int choice) {
    const struct dalcs_device *d = &f->audit->circuit->device[device];
    const struct dalcs_audit_reader *r = &f->audit->reader;
    if (r->is_on(r->user, f->index, device, choice)) {
        return AUDIT_ON;
    }
    const bool breaks_down = d->kind == DALCS_DIODE &&
                             isfinite(f->audit->circuit->models.of_diode[d->model].vrev) &&
                             r->is_on(r->user, f->index, device, choice + 1);
    return breaks_down ? AUDIT_IN_BREAKDOWN : AUDIT_OFF;
}

void audit_fill_side(struct audit_filling *f, int device, int choice, enum audit_side side) {
    const struct dalcs_device *d = &f->audit->circuit->device[device];
    if (d->behaviour != NULL) {
        fill_pair(f, device, choice, side);
    } else if (d->kind == DALCS_DIODE) {
        fill_diode(f, device, side);
    } else {
        fill_switch(f, device, side == AUDIT_ON);
    }
}

/* The flux of a coil from the start on, less the integral of its voltage. */
static void fill_coil(struct audit_filling *f, int device) {
    const struct dalcs_device *d = &f->audit->circuit->device[device];
    const double volts = audit_volts(f->audit, f->part, d->node[0], d->node[1]);
    const double factor = audit_over(
        f, f->part->tolerance * (audit_flux_scale(f->audit, f->part, device) + volts * f->step) +
               f->audit->options.vntol * f->step);
    struct dalcs_audit_row *start = &f->watch->fill.row[AUDIT_ROW_START];
    audit_add_voltage(f, &f->watch->fill.row[AUDIT_ROW_FLOW], d, 0, -factor);
    audit_add_read_current(f, start, device, factor * d->value);
    for (int k = 0; k < f->part->n_couplings; k++) {
        const struct dalcs_coupling *m = &f->audit->circuit->coupling[f->part->coupling[k]];
        for (int e = 0; e < 2; e++) {
            if (m->inductor[e] == device) {
                const int other = m->inductor[1 - e];
                const double mutual =
                    m->k * sqrt(d->value * f->audit->circuit->device[other].value);
                audit_add_read_current(f, start, other, factor * mutual);
            }
        }
    }
}

void audit_fill_branch(struct audit_filling *f, int device) {
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
        factor = audit_over(f, tolerance * scale + f->audit->options.vntol);
        audit_add_voltage(f, audit_row_now(f), d, 0, factor);
        dalcs_audit_row_add_stimulus(audit_row_now(f), d->stimulus, -factor);
        break;
    case DALCS_VCVS:
        scale += fabs(d->value) * audit_volts(f->audit, f->part, d->node[2], d->node[3]);
        factor = audit_over(f, tolerance * scale + fabs(d->value) * f->audit->sums.volts +
                                   f->audit->options.vntol);
        audit_add_voltage(f, audit_row_now(f), d, 0, factor);
        audit_add_voltage(f, audit_row_now(f), d, 2, -factor * d->value);
        break;
    case DALCS_CCVS:
        scale += fabs(d->value) * audit_amperes(f->audit, f->part, d->control);
        factor = audit_over(f, tolerance * scale + fabs(d->value) * f->audit->sums.amperes +
                                   f->audit->options.vntol);
        audit_add_voltage(f, audit_row_now(f), d, 0, factor);
        audit_add_read_current(f, audit_row_now(f), d->control, -factor * d->value);
        break;
    case DALCS_RESISTOR:
        if (f->audit->net.is_told[device]) {
            const struct audit_number drop = audit_drop(f->audit, f->part, device);
            factor = audit_over(f, tolerance * drop.value + drop.rounding);
            audit_add_voltage(f, audit_row_now(f), d, 0, factor);
            audit_add_read_current(f, audit_row_now(f), device, -factor * d->value);
        }
        break;
    case DALCS_INDUCTOR:
        fill_coil(f, device);
        break;
    default:
        break;
    }
}
