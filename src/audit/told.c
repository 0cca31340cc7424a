/* told.c - events and jumps as they are told, against both sides of their instant. */
#include "audit_internal.h"

#include "audit_told.h"

void dalcs_audit_look_before(struct dalcs_audit *audit, int part, bool is_same) {
    if (!is_same) {
        audit->reader.read_before(audit->reader.user, part, 0.0, &audit->state.later);
    }
}

void dalcs_audit_look_behind(struct dalcs_audit *audit, int part, double t) {
    audit->state.shifted.t = t;
    audit->state.shifted.side = DALCS_RIGHT;
    audit->reader.read(audit->reader.user, part, &audit->state.shifted);
    audit->reader.raise(audit->reader.user, part, audit->scale.v, audit->scale.i,
                        audit->scale.lambda);
}

/* ---- Events --------------------------------------------------------------------------------------- */

/* How much a diode conducts (> 0) or blocks (< 0) beyond doubt, over its scales: its current, less its leakage; its
 * voltage, less its line's. Breakdown is another branch, with other events. */
static double side_of_diode(struct dalcs_audit *audit, const struct dalcs_audit_state *s,
                            int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    const struct dalcs_diode_model *m = &audit->circuit->models.of_diode[d->model];
    const int node = audit->net.node_of[d->node[0]];
    const int other = audit->net.node_of[d->node[1]];
    const int own = audit->net.owner[node] >= 0 ? audit->net.owner[node] : audit->net.owner[other];
    if (own < 0 || isfinite(m->vrev) || s->is_mean[device]) {
        return 0.0;
    }
    const struct audit_part *part = &audit->part[own];
    double scale[2];
    audit_diode_scale(audit, part, device, scale);
    const double v = audit_voltage(s, d);
    const double i = s->i[device] - (isfinite(m->roff) ? v / m->roff : 0.0);
    const double current = audit_ratio(i, audit_amperes(audit, part, device));
    const double below = audit_ratio(m->vfwd - v, scale[0]);
    return current > fmax(below, 0.0) ? current : -fmax(below, 0.0);
}

void dalcs_audit_check_event(struct dalcs_audit *audit, int device, bool is_on, double t) {
    const struct dalcs_audit_state *now = &audit->state.shifted;
    double off = 0.0;
    if (audit->circuit->device[device].kind == DALCS_DIODE) {
        const double side = side_of_diode(audit, now, device);
        off = is_on ? -side : side;
    } else if (!now->is_mean[device]) {
        off = now->is_closed[device] != is_on ? 1.0 : 0.0;
    }
    dalcs_audit_add_to(audit, DALCS_AUDIT_EVENT, device, off, t);
}

/* ---- Jumps ---------------------------------------------------------------------------------------- */

static double stored_in(const struct dalcs_audit_state *s, const struct dalcs_device *d,
                        int device) {
    return d->kind == DALCS_CAPACITOR ? audit_voltage(s, d) : s->i[device];
}

/* J: half of what all capacitors and coils have changed by, squared, and of coupled coils their product; NAN: there are
 * curved ones. rounding: of these terms, which cancel where k is 1. */
static double energy_of_change(const struct dalcs_audit *audit, const struct audit_part *part,
                               double *rounding) {
    const struct dalcs_audit_state *then = &audit->state.later, *now = &audit->state.shifted;
    double sum = 0.0;
    double size = 0.0;
    for (int k = 0; k < part->n_devices; k++) {
        const int device = part->device[k];
        const struct dalcs_device *d = &audit->circuit->device[device];
        if (d->is_storage) {
            return NAN;
        }
        if (d->kind == DALCS_CAPACITOR || d->kind == DALCS_INDUCTOR) {
            const double change = stored_in(now, d, device) - stored_in(then, d, device);
            sum += 0.5 * d->value * change * change;
            size += 0.5 * d->value * change * change;
        }
    }
    for (int k = 0; k < part->n_couplings; k++) {
        const struct dalcs_coupling *m = &audit->circuit->coupling[part->coupling[k]];
        const int a = m->inductor[0], b = m->inductor[1];
        const double mutual =
            m->k * sqrt(audit->circuit->device[a].value * audit->circuit->device[b].value);
        const double product = mutual * (now->i[a] - then->i[a]) * (now->i[b] - then->i[b]);
        sum += product;
        size += fabs(product);
    }
    *rounding = AUDIT_ROUNDING * size;
    return sum;
}

/* How far sources move just before t, or behind it, in the time that an event is promised within: what follows one on a
 * steep flank is off by as much. */
static double moved_near(const struct dalcs_audit *audit, double t, bool is_before) {
    const struct dalcs_circuit *c = audit->circuit;
    const enum dalcs_side side = is_before ? DALCS_LEFT : DALCS_RIGHT;
    const double away = AUDIT_PROMISED * audit->options.resolution;
    double most = 0.0;
    for (int k = 0; k < c->n_stimuli; k++) {
        const struct dalcs_stimulus *s = &c->stimulus[k];
        const double there = dalcs_stimulus_value(s, is_before ? t - away : t + away,
                                                  is_before ? DALCS_RIGHT : DALCS_LEFT);
        most = s->kind == DALCS_STIMULUS_DC
                   ? most
                   : fmax(most, fabs(there - dalcs_stimulus_value(s, t, side)));
    }
    return most;
}

/* A: as far as the voltage takes the current of a coil in that time. It hardly moves, but where a resistance beside it leaves
 * it no time at all. */
static double moved_in_coil(const struct dalcs_audit *audit, const struct audit_part *part,
                            const struct dalcs_device *d) {
    return audit_volts(audit, part, d->node[0], d->node[1]) * AUDIT_PROMISED *
           audit->options.resolution / d->value;
}

void dalcs_audit_check_told_jump(struct dalcs_audit *audit, int index,
                                 const struct dalcs_audit_jump *jump, double t) {
    const struct dalcs_device *d = &audit->circuit->device[jump->device];
    const struct audit_part *part = &audit->part[index];
    const double scale = d->kind == DALCS_CAPACITOR
                             ? audit_volts(audit, part, d->node[0], d->node[1])
                             : audit_amperes(audit, part, jump->device);
    double off = 0.0;
    if (d->kind != DALCS_CAPACITOR && d->kind != DALCS_INDUCTOR) {
        return;
    }
    const bool is_volt = d->kind == DALCS_CAPACITOR;
    const double moved = is_volt ? 0.0 : moved_in_coil(audit, part, d);
    const double slack_before = is_volt ? moved_near(audit, t, true) : moved;
    const double slack_after = is_volt ? moved_near(audit, t, false) : moved;
    if (jump->knows_before) {
        off = fabs(jump->before - stored_in(&audit->state.later, d, jump->device)) - slack_before;
    }
    if (jump->knows_after) {
        off = fmax(off, fabs(jump->after - stored_in(&audit->state.shifted, d, jump->device)) -
                            slack_after);
    }
    off = fmax(off, 0.0);
    double worst = audit_ratio(off, scale);
    double rounding = 0.0;
    const double energy = jump->is_alone ? energy_of_change(audit, part, &rounding) : NAN;
    if (isfinite(energy)) {
        const double change = fabs(jump->after - jump->before);
        const double own = 0.5 * d->value * change * change;
        /* what the tolerance leaves open of each state is in its energy twice */
        const double size = fmax(energy, fmax(own, jump->energy_lost)) + d->value * change * scale;
        const double slack = d->value * change * (slack_before + slack_after) + rounding;
        worst = fmax(worst, audit_ratio(fmax(fabs(jump->energy_lost - energy) - slack, 0.0), size));
    }
    dalcs_audit_add_to(audit, DALCS_AUDIT_JUMP, jump->device, worst, t);
}
