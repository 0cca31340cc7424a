/* laws.c - what holds at each time: branches, signs, positions and Kirchhoff's current law. */
#include "audit_internal.h"

/* *size: what the terms are held to, added up; *terms: what they are. */
static double affine_value(const struct dalcs_audit *audit, const struct audit_part *part,
                           const struct dalcs_audit_state *s, int device,
                           const struct dalcs_affine *a, double *size, double *terms) {
    double sum = a->constant;
    *size = *terms = fabs(a->constant);
    for (int k = 0; k < a->n; k++) {
        const struct dalcs_affine_term *term = &a->term[k];
        double value;
        double scale;
        switch (term->kind) {
        case DALCS_QUANTITY_VOLTAGE:
            value = s->v[term->index];
            scale = term->index > 0 ? audit_volts(audit, part, term->index, 0) : 0.0;
            break;
        case DALCS_QUANTITY_CURRENT:
            value = audit_current(audit, s, term->index);
            scale = audit_amperes(audit, part, term->index);
            break;
        case DALCS_QUANTITY_PAIR:
            value = s->lambda[audit->first_lambda[device] + term->index];
            scale = audit->lambda_scale[audit->first_lambda[device] + term->index];
            break;
        default:
            value = dalcs_stimulus_value(&audit->circuit->stimulus[term->index], s->t, s->side);
            scale = fabs(value);
            break;
        }
        sum += term->coefficient * value;
        *size += fabs(term->coefficient) * fmax(scale, fabs(value));
        *terms += fabs(term->coefficient * value);
    }
    return sum;
}

/* A lambda that adds to what an affine function reads besides is held to that one's scale, too. */
static void raise_lambdas(struct dalcs_audit *audit, int device, const struct dalcs_affine *a,
                          double size) {
    double *scale = audit->lambda_scale + audit->first_lambda[device];
    for (int k = 0; k < a->n; k++) {
        if (a->term[k].kind == DALCS_QUANTITY_PAIR) {
            size -= fabs(a->term[k].coefficient) * scale[a->term[k].index];
        }
    }
    for (int k = 0; k < a->n; k++) {
        if (a->term[k].kind == DALCS_QUANTITY_PAIR) {
            scale[a->term[k].index] =
                fmax(scale[a->term[k].index], size / fabs(a->term[k].coefficient));
        }
    }
}

/* What rounding of charges and fluxes makes of the currents and voltages that an affine function reads. */
static double rounding_read(const struct dalcs_audit *audit, const struct dalcs_affine *a) {
    double rounding = 0.0;
    for (int k = 0; k < a->n; k++) {
        const struct dalcs_affine_term *term = &a->term[k];
        rounding +=
            term->kind == DALCS_QUANTITY_CURRENT   ? fabs(term->coefficient) * audit->sums.amperes
            : term->kind == DALCS_QUANTITY_VOLTAGE ? fabs(term->coefficient) * audit->sums.volts
                                                   : 0.0;
    }
    return rounding;
}

/* A formula's output, less what the device puts out; each of its pairs. */
static void check_formula(struct dalcs_audit *audit, struct audit_part *part,
                          const struct dalcs_audit_state *s, int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    double size;
    double terms;
    const double f = affine_value(audit, part, s, device, &d->behaviour->output, &size, &terms);
    const bool is_voltage = d->kind == DALCS_VCVS;
    double *largest = &part->formula[is_voltage ? 0 : 1];
    *largest = fmax(*largest, terms);
    const double is = is_voltage ? audit_voltage(s, d) : s->i[device];
    const double scale = is_voltage ? audit_volts(audit, part, d->node[0], d->node[1])
                                    : audit_amperes(audit, part, device);
    const double held = size + scale;
    const enum dalcs_audit_law law = is_voltage ? DALCS_AUDIT_BRANCH : DALCS_AUDIT_CURRENT;
    const double rounding = AUDIT_ROUNDING * size + rounding_read(audit, &d->behaviour->output);
    audit_find(audit, part, law, device, fabs(is - f) - rounding, held, s->t);
    for (int k = 0; k < d->behaviour->n_pairs; k++) {
        const int pair = audit->first_lambda[device] + k;
        const double w = affine_value(audit, part, s, device, &d->behaviour->w[k], &size, &terms);
        raise_lambdas(audit, device, &d->behaviour->w[k], size);
        const double lambda = audit_ratio(s->lambda[pair], audit->lambda_scale[pair]);
        const double over = fabs(fmin(lambda, audit_ratio(w, size))) - AUDIT_ROUNDING;
        audit_find(audit, part, law, device, over * held, held, s->t);
    }
}

/* One of the two branches of a diode, 0 <= current _|_ beyond = v + ron current - v_at >= 0, over its scales. */
static double pair_defect(double current, double beyond, const double scale[2]) {
    const double over[2] = {audit_ratio(beyond, scale[0]), audit_ratio(current, scale[1])};
    return fmax(-over[0], fmin(over[0], over[1]));
}

/* A, in the currents at the two ends of a device. */
static double ampere_rounding(const struct dalcs_audit *audit, const struct dalcs_device *d) {
    return audit->sums.amperes + fmax(audit->sums.rounding[audit->node_of[d->node[0]]],
                                      audit->sums.rounding[audit->node_of[d->node[1]]]);
}

/* How wrong a diode's branches are, and the current that it blocks, over scale[2] in V and A. */
static void diode_defects(const struct dalcs_audit *audit, const struct dalcs_audit_state *s,
                          int device, const double scale[2], double *branch, double *blocked) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    const struct dalcs_diode_model *m = &audit->circuit->diode_model[d->model];
    const double v = audit_voltage(s, d);
    const double leak = isfinite(m->roff) ? v / m->roff : 0.0;
    const double own = s->i[device] - leak;
    const double forward = fmax(own, 0.0);
    const double reverse = fmax(-own, 0.0);
    *branch = pair_defect(forward, m->vfwd + m->ron * forward - v, scale);
    *blocked = 0.0;
    if (isfinite(m->vrev)) {
        *branch = fmax(*branch, pair_defect(reverse, m->vrev + m->rrev * reverse + v, scale));
    } else {
        *blocked = audit_ratio(reverse - audit->options.abstol, scale[1]);
    }
}

void audit_diode_scale(const struct dalcs_audit *audit, const struct audit_part *part, int device,
                       double scale[2]) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    /* currents of pairs are held to 1e-2 of the largest, others to 1e-5 (doc/methods.md) */
    const double amperes = fmax(audit_amperes(audit, part, device), 1e3 * part->ampere);
    /* what is within rounding of 0 is nothing: it is over a scale that is not less */
    scale[0] = audit->sums.volts / part->tolerance +
               audit_volts(audit, part, d->node[0], d->node[1]) +
               audit->circuit->diode_model[d->model].ron * amperes;
    scale[1] = amperes + ampere_rounding(audit, d) / part->tolerance;
}

static void check_diode(struct dalcs_audit *audit, const struct audit_part *part,
                        const struct dalcs_audit_state *s, int device) {
    double scale[2];
    audit_diode_scale(audit, part, device, scale);
    double branch;
    double blocked;
    diode_defects(audit, s, device, scale, &branch, &blocked);
    if (fmax(branch, blocked) > part->tolerance && part->lateness > 0.0) {
        audit->shifted.side = s->side;
        audit->shifted.t = s->t + part->lateness;
        audit->reader.read(audit->reader.user, (int)(part - audit->part), &audit->shifted);
        double later[2];
        diode_defects(audit, &audit->shifted, device, scale, &later[0], &later[1]);
        branch = fmin(branch, later[0]);
        blocked = fmin(blocked, later[1]);
    }
    audit_find(audit, part, DALCS_AUDIT_BRANCH, device, branch * scale[0], scale[0], s->t);
    audit_find(audit, part, DALCS_AUDIT_CURRENT, device, blocked * scale[1], scale[1], s->t);
}

double audit_control(const struct dalcs_audit *audit, const struct dalcs_audit_state *s, int device,
                     double *half_width) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    const struct dalcs_switch_model *m = &audit->circuit->switch_model[d->model];
    double control = d->control >= 0 ? s->i[d->control] : s->v[d->node[2]] - s->v[d->node[3]];
    control = m->is_inverted ? -control : control;
    *half_width = fabs(m->vh);
    return control - m->vt;
}

double audit_control_slack(struct dalcs_audit *audit, const struct audit_part *part,
                           const struct dalcs_audit_state *s, int device) {
    double half_width;
    audit->shifted.side = s->side;
    audit->shifted.t = s->t + (s->side == DALCS_RIGHT ? 1.0 : -1.0) * audit->options.resolution;
    audit->reader.read(audit->reader.user, (int)(part - audit->part), &audit->shifted);
    return fabs(audit_control(audit, &audit->shifted, device, &half_width) -
                audit_control(audit, s, device, &half_width));
}

double audit_control_scale(const struct dalcs_audit *audit, const struct audit_part *part,
                           int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    const struct dalcs_switch_model *m = &audit->circuit->switch_model[d->model];
    const double signal = d->control >= 0 ? audit_amperes(audit, part, d->control)
                                          : audit_volts(audit, part, d->node[2], d->node[3]);
    return fmax(signal, fabs(m->vt) + fabs(m->vh));
}

/* A switch that slides stands at its threshold; for a mean of two positions signs hold, and no law of either. */
static void check_mean(struct dalcs_audit *audit, const struct audit_part *part,
                       const struct dalcs_audit_state *s, int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    if (d->kind == DALCS_SWITCH) {
        double half_width;
        const double off = fabs(audit_control(audit, s, device, &half_width)) - half_width;
        audit_find(audit, part, DALCS_AUDIT_POSITION, device,
                   off - (off > 0.0 ? audit_control_slack(audit, part, s, device) : 0.0),
                   audit_control_scale(audit, part, device), s->t);
        audit->count.positions++;
    } else if (d->kind == DALCS_DIODE && d->behaviour == NULL) {
        const struct dalcs_diode_model *m = &audit->circuit->diode_model[d->model];
        const double v = audit_voltage(s, d);
        const double own = s->i[device] - (isfinite(m->roff) ? v / m->roff : 0.0);
        const double amperes = fmax(audit_amperes(audit, part, device), 1e3 * part->ampere);
        audit_find(audit, part, DALCS_AUDIT_BRANCH, device,
                   v - m->vfwd - m->ron * own - audit->options.vntol,
                   audit_volts(audit, part, d->node[0], d->node[1]) + m->ron * amperes, s->t);
        audit_find(audit, part, DALCS_AUDIT_CURRENT, device,
                   isfinite(m->vrev) ? 0.0 : -own - audit->options.abstol, amperes, s->t);
    }
}

static void check_switch(struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *s, int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    const struct dalcs_switch_model *m = &audit->circuit->switch_model[d->model];
    const bool is_closed = s->is_closed[device];
    const double v = audit_voltage(s, d);
    const double i = s->i[device];
    const double rounding = ampere_rounding(audit, d);
    if (is_closed) {
        audit_find(audit, part, DALCS_AUDIT_BRANCH, device,
                   fabs(v - m->ron * i) - m->ron * rounding - audit->options.vntol,
                   audit_volts(audit, part, d->node[0], d->node[1]), s->t);
    } else {
        const double leak = isfinite(m->roff) ? v / m->roff : 0.0;
        audit_find(audit, part, DALCS_AUDIT_CURRENT, device,
                   fabs(i - leak) - rounding - audit->options.abstol,
                   audit_amperes(audit, part, device), s->t);
    }
    double half_width;
    const double control = audit_control(audit, s, device, &half_width);
    double wrong = is_closed ? -half_width - control : control - half_width;
    wrong -= wrong > 0.0 ? audit_control_slack(audit, part, s, device) : 0.0;
    audit_find(audit, part, DALCS_AUDIT_POSITION, device, wrong,
               audit_control_scale(audit, part, device), s->t);
    /* within its hysteresis it starts where the netlist says, if nothing may have moved it there */
    if (s->t == 0.0 && audit->options.is_start && d->control < 0 && fabs(control) < half_width &&
        audit->is_fed[d->node[2]] && audit->is_fed[d->node[3]]) {
        const double off = is_closed != d->initially_on ? half_width : 0.0;
        audit_find(audit, part, DALCS_AUDIT_POSITION, device, off, half_width, s->t);
    }
    audit->count.positions++;
}

double audit_current(const struct dalcs_audit *audit, const struct dalcs_audit_state *s,
                     int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    if (d->behaviour != NULL) {
        return s->i[device];
    }
    switch (d->kind) {
    case DALCS_RESISTOR:
        return d->value != 0.0 ? audit_voltage(s, d) / d->value : 0.0;
    case DALCS_ISOURCE:
        return dalcs_stimulus_value(&audit->circuit->stimulus[d->stimulus], s->t, s->side);
    case DALCS_VCCS:
        return d->value * (s->v[d->node[2]] - s->v[d->node[3]]);
    case DALCS_CCCS:
        return d->value * s->i[d->control];
    default:
        return s->i[device];
    }
}

/* How far a source moves while times cannot be told apart: on a steep flank that is seen. */
static double source_slack(const struct dalcs_audit *audit, const struct dalcs_stimulus *stimulus,
                           const struct dalcs_audit_state *s) {
    const double later =
        dalcs_stimulus_value(stimulus, s->t + audit->options.resolution, DALCS_LEFT);
    const double sooner =
        dalcs_stimulus_value(stimulus, s->t - audit->options.resolution, DALCS_RIGHT);
    return fabs(later - sooner);
}

static void check_branch(struct dalcs_audit *audit, struct audit_part *part,
                         const struct dalcs_audit_state *s, int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    if (s->is_mean[device]) {
        check_mean(audit, part, s, device);
        return;
    }
    if (d->behaviour != NULL) {
        check_formula(audit, part, s, device);
        return;
    }
    double wanted;
    double rounding = 0.0; /* of what it reads */
    double scale = audit_volts(audit, part, d->node[0], d->node[1]);
    switch (d->kind) {
    case DALCS_VSOURCE:
        wanted = dalcs_stimulus_value(&audit->circuit->stimulus[d->stimulus], s->t, s->side);
        break;
    case DALCS_VCVS:
        wanted = d->value * (s->v[d->node[2]] - s->v[d->node[3]]);
        scale += fabs(d->value) * audit_volts(audit, part, d->node[2], d->node[3]);
        rounding = fabs(d->value) * audit->sums.volts;
        break;
    case DALCS_CCVS:
        wanted = d->value * s->i[d->control];
        scale += fabs(d->value) * audit_amperes(audit, part, d->control);
        rounding = fabs(d->value) * audit->sums.amperes;
        break;
    case DALCS_DIODE:
        check_diode(audit, part, s, device);
        return;
    case DALCS_SWITCH:
        check_switch(audit, part, s, device);
        return;
    default: /* R, C, L, I, F, G: their currents are in Kirchhoff's law */
        return;
    }
    double off = fabs(audit_voltage(s, d) - wanted) - rounding - audit->options.vntol;
    if (d->kind == DALCS_VSOURCE && off > part->tolerance * scale) {
        off -= source_slack(audit, &audit->circuit->stimulus[d->stimulus], s);
    }
    audit_find(audit, part, DALCS_AUDIT_BRANCH, device, off, scale, s->t);
}

/* ---- Kirchhoff's current law -------------------------------------------------------------------- */

static void leave(const struct dalcs_audit *audit, int node, double current, double scale,
                  double rounding) {
    node = audit->node_of[node];
    audit->sums.current[node] += current;
    audit->sums.scale[node] += scale;
    audit->sums.rounding[node] += rounding;
}

/* Charge and flux are each a product and a sum, at the two ends that a derivative is taken between. */
#define STORED_ROUNDING (4.0 * 0x1p-52)

/* What rounding of fluxes makes of voltages and of charges of currents. Conducting branches hand it on, and along a chain
 * of them it adds up: what is at one device may come from all others. */
static void round_storage(struct dalcs_audit *audit, const struct audit_part *part,
                          const struct dalcs_audit_state *s) {
    const double least = STORED_ROUNDING * part->slope;
    audit->sums.volts = audit->sums.amperes = 0.0;
    for (int k = 0; k < part->n_devices; k++) {
        const struct dalcs_device *d = &audit->circuit->device[part->device[k]];
        if (d->kind == DALCS_INDUCTOR) {
            audit->sums.volts += least * audit_flux_scale(audit, part, part->device[k]);
        } else if (d->kind == DALCS_CAPACITOR) {
            const double volts = fabs(s->v[d->node[0]]) + fabs(s->v[d->node[1]]);
            audit->sums.amperes += least * d->value * volts;
        }
    }
}

/* What rounding of the voltages at a device makes of its current, of a charge over a step, or over a step of a flux. */
static double rounding_of(const struct dalcs_audit *audit, const struct audit_part *part,
                          const struct dalcs_audit_state *s, const struct dalcs_device *d,
                          double current) {
    const double volts = fabs(s->v[d->node[0]]) + fabs(s->v[d->node[1]]);
    if (d->kind == DALCS_CAPACITOR) {
        return STORED_ROUNDING * d->value * part->slope * volts;
    }
    if (d->kind == DALCS_VCCS && d->behaviour == NULL) {
        const double controls = fabs(s->v[d->node[2]]) + fabs(s->v[d->node[3]]);
        return fabs(d->value) * (AUDIT_ROUNDING * controls + audit->sums.volts);
    }
    if (d->kind == DALCS_CCCS) {
        return AUDIT_ROUNDING * fabs(current) + fabs(d->value) * audit->sums.amperes;
    }
    if (d->kind == DALCS_INDUCTOR) {
        /* a voltage of 0 is that to the rounding of the largest one in the same equations (Wilkinson) */
        return AUDIT_ROUNDING * fabs(current) +
               STORED_ROUNDING * fmax(volts, part->largest_volt) * part->step / d->value;
    }
    const double g = d->kind == DALCS_RESISTOR && d->value != 0.0 ? fabs(1.0 / d->value) : 0.0;
    return AUDIT_ROUNDING * (g * volts + fabs(current)) + 2.0 * g * audit->sums.volts;
}

void audit_sum_currents(struct dalcs_audit *audit, const struct audit_part *part,
                        const struct dalcs_audit_state *s) {
    for (int k = 0; k < part->n_nodes; k++) {
        const int node = part->node[k];
        audit->sums.current[node] = audit->sums.scale[node] = audit->sums.rounding[node] = 0.0;
    }
    round_storage(audit, part, s);
    for (int k = 0; k < part->n_devices; k++) {
        const int device = part->device[k];
        const struct dalcs_device *d = &audit->circuit->device[device];
        const bool is_charge = d->kind == DALCS_CAPACITOR;
        const double current = is_charge ? 0.0 : audit_current(audit, s, device);
        const double scale = is_charge ? 0.0 : audit_amperes(audit, part, device);
        const double rounding = rounding_of(audit, part, s, d, current);
        leave(audit, d->node[0], current, scale, rounding);
        leave(audit, d->node[1], -current, scale, rounding);
    }
    audit->sums.rounding[0] = 0.0;
}

void audit_note_scales(struct dalcs_audit *audit, struct audit_part *part,
                       const struct dalcs_audit_state *s) {
    double volt = part->formula[0]; /* what cancels in a formula leaves its rounding */
    double ampere = part->formula[1];
    for (int k = 0; k < part->n_devices; k++) {
        const int device = part->device[k];
        const struct dalcs_device *d = &audit->circuit->device[device];
        const double i = d->kind == DALCS_CAPACITOR ? 0.0 : audit_current(audit, s, device);
        audit->i_scale[device] = fmax(audit->i_scale[device], fabs(i));
        ampere = fmax(ampere, audit->i_scale[device]);
        for (int e = 0; e < 2; e++) {
            const int node = d->node[e];
            audit->v_scale[node] = fmax(audit->v_scale[node], fabs(s->v[node]));
            volt = fmax(volt, audit->v_scale[node]);
        }
        for (int p = 0; d->behaviour != NULL && p < d->behaviour->n_pairs; p++) {
            double *scale = &audit->lambda_scale[audit->first_lambda[device] + p];
            *scale = fmax(*scale, fabs(s->lambda[audit->first_lambda[device] + p]));
        }
    }
    part->largest_volt = volt;
    /* doc/methods.md, "What the tolerance means": signals below 1e-5 of the largest of their unit are held to
     * that one's scale, and each unit vouches a millionth for the other through the conductances, of 1 S where there
     * are none. */
    const bool has_any = part->most > 0.0;
    part->volt = fmax(1e-5 * volt, 1e-6 / (has_any ? part->most : 1.0) * ampere);
    part->ampere = fmax(1e-5 * ampere, 1e-6 * (has_any ? part->least : 1.0) * volt);
}

void audit_check_instant(struct dalcs_audit *audit, struct audit_part *part,
                         const struct dalcs_audit_state *s) {
    audit->count.instants++;
    audit_sum_currents(audit, part, s);
    for (int k = 0; k < part->n_devices; k++) {
        check_branch(audit, part, s, part->device[k]);
    }
    for (int k = 0; k < part->n_nodes; k++) {
        const int node = part->node[k];
        if (!audit->has_charge[node]) {
            audit_find(audit, part, DALCS_AUDIT_KCL, node,
                       fabs(audit->sums.current[node]) - audit->sums.rounding[node] -
                           audit->options.abstol,
                       audit->sums.scale[node], s->t);
        }
    }
}
