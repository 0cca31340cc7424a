/* laws.c - what holds of a branch at each time: its law, its signs, its position. */
#include "audit_currents.h"
#include "audit_formula.h"
#include "audit_positions.h"

/* One of the two branches of a diode, 0 <= current _|_ beyond = v + ron current - v_at >= 0, over its scales. */
static double pair_defect(double current, double beyond, const double scale[2]) {
    const double over[2] = {audit_ratio(beyond, scale[0]), audit_ratio(current, scale[1])};
    return fmax(-over[0], fmin(over[0], over[1]));
}

/* A, in the currents at the two ends of a device. */
static double ampere_rounding(const struct dalcs_audit *audit, const struct dalcs_device *d) {
    return audit->sums.amperes + fmax(audit->sums.rounding[audit->net.node_of[d->node[0]]],
                                      audit->sums.rounding[audit->net.node_of[d->node[1]]]);
}

/* How wrong a diode's branches are, and the current that it blocks, over scale[2] in V and A. */
static void diode_defects(const struct dalcs_audit *audit, const struct dalcs_audit_state *s,
                          int device, const double scale[2], double *branch, double *blocked) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    const struct dalcs_diode_model *m = &audit->circuit->models.of_diode[d->model];
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
    const double amperes = fmax(audit_amperes(audit, part, device), 1e3 * part->floor.ampere);
    /* what is within rounding of 0 is nothing: it is over a scale that is not less */
    scale[0] = audit->sums.volts / part->tolerance +
               audit_volts(audit, part, d->node[0], d->node[1]) +
               audit->circuit->models.of_diode[d->model].ron * amperes;
    scale[1] = amperes + ampere_rounding(audit, d) / part->tolerance;
}

static void check_diode(struct dalcs_audit *audit, const struct audit_part *part,
                        const struct dalcs_audit_state *s, int device) {
    double scale[2];
    audit_diode_scale(audit, part, device, scale);
    double branch;
    double blocked;
    diode_defects(audit, s, device, scale, &branch, &blocked);
    if (fmax(branch, blocked) > part->tolerance && part->at.lateness > 0.0) {
        audit->state.shifted.side = s->side;
        audit->state.shifted.t = s->t + part->at.lateness;
        audit->reader.read(audit->reader.user, (int)(part - audit->part), &audit->state.shifted);
        double later[2];
        diode_defects(audit, &audit->state.shifted, device, scale, &later[0], &later[1]);
        branch = fmin(branch, later[0]);
        blocked = fmin(blocked, later[1]);
    }
    audit_find(audit, part, DALCS_AUDIT_BRANCH, device, branch * scale[0], scale[0], s->t);
    audit_find(audit, part, DALCS_AUDIT_CURRENT, device, blocked * scale[1], scale[1], s->t);
}

double audit_control(const struct dalcs_audit *audit, const struct dalcs_audit_state *s, int device,
                     double *half_width) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    const struct dalcs_switch_model *m = &audit->circuit->models.of_switch[d->model];
    double control = d->control >= 0 ? s->i[d->control] : s->v[d->node[2]] - s->v[d->node[3]];
    control = m->is_inverted ? -control : control;
    *half_width = fabs(m->vh);
    return control - m->vt;
}

/* By how much a control moves until another time, s later. */
static double moves_by(struct dalcs_audit *audit, const struct audit_part *part,
                       const struct dalcs_audit_state *s, int device, double later) {
    double half_width;
    audit->state.shifted.side = s->side;
    audit->state.shifted.t = s->t + later;
    audit->reader.read(audit->reader.user, (int)(part - audit->part), &audit->state.shifted);
    return fabs(audit_control(audit, &audit->state.shifted, device, &half_width) -
                audit_control(audit, s, device, &half_width));
}

/* A stretch may be shorter than what times can be told apart by. Then an edge that it begins with may as well be behind
 * its end: a diode opens 5e-20 s behind the edge that closes a switch. */
double audit_control_slack(struct dalcs_audit *audit, const struct audit_part *part,
                           const struct dalcs_audit_state *s, int device) {
    const double moved = fmax(audit->options.resolution, part->at.lateness);
    const double inwards = s->side == DALCS_RIGHT ? moved : -moved;
    const double slack = moves_by(audit, part, s, device, inwards);
    const bool is_all_near = part->at.span > 0.0 && part->at.span <= audit->options.resolution;
    return is_all_near ? fmax(slack, moves_by(audit, part, s, device, -inwards)) : slack;
}

double audit_control_scale(const struct dalcs_audit *audit, const struct audit_part *part,
                           int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    const struct dalcs_switch_model *m = &audit->circuit->models.of_switch[d->model];
    const double signal = d->control >= 0 ? audit_amperes(audit, part, d->control)
                                          : audit_volts(audit, part, d->node[2], d->node[3]);
    return fmax(signal, fabs(m->vt) + fabs(m->vh));
}

/* Does a formula that is a mean itself put out what controls a switch? Then that may be at the threshold for any share of
 * the time, and tells nothing. */
static bool is_put_out(const struct dalcs_audit *audit, const struct audit_part *part,
                       const struct dalcs_audit_state *s, const struct dalcs_device *of) {
    bool is = false;
    for (int k = 0; k < part->n_devices && of->control < 0 && !is; k++) {
        const struct dalcs_device *d = &audit->circuit->device[part->device[k]];
        is = d->behaviour != NULL && d->kind == DALCS_VCVS && s->is_mean[part->device[k]] &&
             isfinite(audit_jump_beside(audit, part, s, part->device[k])) &&
             ((d->node[0] == of->node[2] && d->node[1] == of->node[3]) ||
              (d->node[0] == of->node[3] && d->node[1] == of->node[2]));
    }
    return is;
}

/* A switch that slides stands at its threshold, or what commands it is a formula that does; for a mean of two positions
 * signs hold, and no law of either. */
static void check_mean(struct dalcs_audit *audit, const struct audit_part *part,
                       const struct dalcs_audit_state *s, int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    if (d->kind == DALCS_SWITCH) {
        double half_width;
        const double scale = audit_control_scale(audit, part, device);
        double off = fabs(audit_control(audit, s, device, &half_width)) - half_width;
        off -= off > 0.0 ? audit_control_slack(audit, part, s, device) : 0.0;
        off = is_put_out(audit, part, s, d) ? scale : off;
        for (int k = 0; k < part->n_devices && off > part->tolerance * scale; k++) {
            const int of = part->device[k];
            const bool may_command = s->is_mean[of] && audit->circuit->device[of].behaviour != NULL;
            const double beside = may_command ? audit_jump_beside(audit, part, s, of) : INFINITY;
            off = fmin(off, beside * scale);
        }
        audit_find(audit, part, DALCS_AUDIT_POSITION, device, off, scale, s->t);
        audit_count_position(audit, part);
    } else if (d->kind == DALCS_DIODE && d->behaviour == NULL) {
        const struct dalcs_diode_model *m = &audit->circuit->models.of_diode[d->model];
        const double v = audit_voltage(s, d);
        const double own = s->i[device] - (isfinite(m->roff) ? v / m->roff : 0.0);
        const double amperes = fmax(audit_amperes(audit, part, device), 1e3 * part->floor.ampere);
        audit_find(audit, part, DALCS_AUDIT_BRANCH, device,
                   v - m->vfwd - m->ron * own - audit->options.vntol,
                   audit_volts(audit, part, d->node[0], d->node[1]) + m->ron * amperes, s->t);
        audit_find(audit, part, DALCS_AUDIT_CURRENT, device,
                   isfinite(m->vrev) ? 0.0 : -own - audit->options.abstol, amperes, s->t);
    }
}

/* Below the threshold that closes it a switch with a valve stays closed by the current of that alone. One that decays is 0 to
 * rounding one day and has not ended: then no voltage is against the valve. */
static bool is_kept(const struct dalcs_audit *audit, const struct audit_part *part,
                    const struct dalcs_audit_state *s, int device) {
    const int valve = audit->circuit->device[device].valve;
    if (valve < 0 || s->i[valve] != 0.0) {
        return true;
    }
    const struct dalcs_device *d = &audit->circuit->device[valve];
    const double against = audit->circuit->models.of_diode[d->model].vfwd - audit_voltage(s, d);
    return against <= audit->options.vntol +
                          part->tolerance * audit_volts(audit, part, d->node[0], d->node[1]);
}

static void check_switch(struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *s, int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    const struct dalcs_switch_model *m = &audit->circuit->models.of_switch[d->model];
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
    const double opens_at = is_kept(audit, part, s, device) ? -half_width : half_width;
    double wrong = is_closed ? opens_at - control : control - half_width;
    wrong -= wrong > 0.0 ? audit_control_slack(audit, part, s, device) : 0.0;
    audit_find(audit, part, DALCS_AUDIT_POSITION, device, wrong,
               audit_control_scale(audit, part, device), s->t);
    /* within its hysteresis it starts where the netlist says, if nothing may have moved it there */
    if (s->t == 0.0 && audit->options.is_start && d->control < 0 && fabs(control) < half_width &&
        audit->net.is_fed[d->node[2]] && audit->net.is_fed[d->node[3]]) {
        const double off = is_closed != d->initially_on ? half_width : 0.0;
        audit_find(audit, part, DALCS_AUDIT_POSITION, device, off, half_width, s->t);
    }
    audit_count_position(audit, part);
}

double audit_current(const struct dalcs_audit *audit, const struct dalcs_audit_state *s,
                     int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    if (d->behaviour != NULL) {
        return s->i[device];
    }
    switch (d->kind) {
    case DALCS_RESISTOR:
        return audit->net.is_told[device] ? s->i[device] : audit_voltage(s, d) / d->value;
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

double audit_current_rounding(const struct dalcs_audit *audit, const struct dalcs_audit_state *s,
                              int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    const bool is_made = d->kind == DALCS_RESISTOR && !audit->net.is_told[device];
    const double volts = fabs(s->v[d->node[0]]) + fabs(s->v[d->node[1]]);
    const double of_voltages = is_made ? volts / fabs(d->value) : 0.0;
    return AUDIT_ROUNDING * (of_voltages + fabs(audit_current(audit, s, device)));
}

struct audit_number audit_drop(const struct dalcs_audit *audit, const struct audit_part *part,
                               int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    const double *v = audit->scale.v;
    const double at_nodes = v[d->node[0]] + v[d->node[1]];
    const double ohms = fabs(d->value);
    if (ohms == 0.0) { /* any current */
        return (struct audit_number){audit_volts(audit, part, d->node[0], d->node[1]),
                                     2.0 * audit->sums.volts + audit->options.vntol};
    }
    return (struct audit_number){ohms * audit_amperes(audit, part, device),
                                 AUDIT_ROUNDING * at_nodes + 2.0 * audit->sums.volts +
                                     ohms * audit->options.abstol};
}

/* v = R i where i is told. */
static void check_resistor(struct dalcs_audit *audit, struct audit_part *part,
                           const struct dalcs_audit_state *s, int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    if (!audit->net.is_told[device]) {
        return; /* its current is in Kirchhoff's law */
    }
    const struct audit_number drop = audit_drop(audit, part, device);
    double off = fabs(audit_voltage(s, d) - d->value * s->i[device]) - drop.rounding;
    if (off > part->tolerance * drop.value) {
        off -= audit_sources_move(audit, part, s, d);
    }
    audit_find(audit, part, DALCS_AUDIT_BRANCH, device, off, drop.value, s->t);
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

void audit_check_branch(struct dalcs_audit *audit, struct audit_part *part,
                        const struct dalcs_audit_state *s, int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    if (s->is_mean[device]) {
        check_mean(audit, part, s, device);
        return;
    }
    if (d->behaviour != NULL) {
        audit_check_formula(audit, part, s, device);
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
    case DALCS_RESISTOR:
        check_resistor(audit, part, s, device);
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
