/* intervals.c - what holds between two times: charge at nodes, flux of coils, energy.
 *
 * A polynomial that is right to the tolerance may have a derivative that is not. So storage is held to
 * integrals: the charge that capacitors at a node took up is what its other branches brought. */
#include "audit_currents.h"

const double audit_gauss_node[] = {0.04691007703066800, 0.23076534494715845, 0.5,
                                   0.76923465505284155, 0.95308992296933200};
const double audit_gauss_weight[] = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                     0.23931433524968324, 0.11846344252809454};

static void clear(struct dalcs_audit *audit, const struct audit_part *part) {
    for (int k = 0; k < part->n_nodes; k++) {
        const int node = part->node[k];
        audit->sums.current[node] = audit->sums.scale[node] = audit->sums.rounding[node] = 0.0;
    }
    for (int k = 0; k < part->n_devices; k++) {
        audit->sums.flux[part->device[k]] = 0.0;
    }
    audit->sums.energy = audit->sums.energy_scale = audit->sums.energy_rounding = 0.0;
}

static void leave(const struct dalcs_audit *audit, const struct dalcs_device *d, double charge,
                  double scale, double rounding) {
    for (int e = 0; e < 2; e++) {
        const int node = audit->net.node_of[d->node[e]];
        audit->sums.current[node] += e == 0 ? charge : -charge;
        audit->sums.scale[node] += scale;
        audit->sums.rounding[node] += rounding;
    }
}

/* Currents and voltages at one time, for so long. */
static void add_flow(struct dalcs_audit *audit, const struct audit_part *part,
                     const struct dalcs_audit_state *s, double duration) {
    for (int k = 0; k < part->n_devices; k++) {
        const int device = part->device[k];
        const struct dalcs_device *d = &audit->circuit->device[device];
        if (d->kind == DALCS_CAPACITOR) {
            continue;
        }
        const double v = audit_voltage(s, d);
        const double i = audit_current(audit, s, device);
        const double amperes = audit_amperes(audit, part, device);
        const double volts = fabs(s->v[d->node[0]]) + fabs(s->v[d->node[1]]);
        const double rounding = audit_current_rounding(audit, s, device) * duration;
        leave(audit, d, i * duration, amperes * duration, rounding);
        audit->sums.energy_rounding +=
            volts * rounding; /* Tellegen: currents that miss at a node take its voltage's power */
        if (d->kind == DALCS_INDUCTOR) {
            audit->sums.flux[device] -= v * duration;
        } else {
            audit->sums.energy += v * i * duration;
            audit->sums.energy_scale +=
                audit_volts(audit, part, d->node[0], d->node[1]) * amperes * duration;
        }
    }
}

/* What is stored at one time, with that sign; flux of coils and their energy behind couplings. */
static void add_storage(struct dalcs_audit *audit, const struct audit_part *part,
                        const struct dalcs_audit_state *s, double sign) {
    for (int k = 0; k < part->n_devices; k++) {
        const int device = part->device[k];
        const struct dalcs_device *d = &audit->circuit->device[device];
        if (d->kind == DALCS_CAPACITOR) {
            const double v = audit_voltage(s, d);
            const double volts = audit_volts(audit, part, d->node[0], d->node[1]);
            leave(audit, d, sign * d->value * v, 0.5 * d->value * volts,
                  AUDIT_ROUNDING * d->value * (fabs(s->v[d->node[0]]) + fabs(s->v[d->node[1]])));
            audit->sums.energy += sign * 0.5 * d->value * v * v;
            audit->sums.energy_scale += 0.5 * d->value * volts * volts;
        } else if (d->kind == DALCS_INDUCTOR) {
            const double i = s->i[device];
            const double amperes = audit_amperes(audit, part, device);
            audit->sums.flux[device] += sign * d->value * i;
            audit->sums.energy += sign * 0.5 * d->value * i * i;
            audit->sums.energy_scale += 0.5 * d->value * amperes * amperes;
        }
    }
    for (int k = 0; k < part->n_couplings; k++) {
        const struct dalcs_coupling *m = &audit->circuit->coupling[part->coupling[k]];
        const struct dalcs_device *a = &audit->circuit->device[m->inductor[0]];
        const struct dalcs_device *b = &audit->circuit->device[m->inductor[1]];
        const double mutual = sign * m->k * sqrt(a->value * b->value);
        audit->sums.flux[m->inductor[0]] += mutual * s->i[m->inductor[1]];
        audit->sums.flux[m->inductor[1]] += mutual * s->i[m->inductor[0]];
        audit->sums.energy += mutual * s->i[m->inductor[0]] * s->i[m->inductor[1]];
    }
}

double audit_flux_scale(const struct dalcs_audit *audit, const struct audit_part *part,
                        int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    double scale = d->value * audit_amperes(audit, part, device);
    for (int k = 0; k < part->n_couplings; k++) {
        const struct dalcs_coupling *m = &audit->circuit->coupling[part->coupling[k]];
        for (int e = 0; e < 2; e++) {
            if (m->inductor[e] == device) {
                const int other = m->inductor[1 - e];
                scale += fabs(m->k) * sqrt(d->value * audit->circuit->device[other].value) *
                         audit_amperes(audit, part, other);
            }
        }
    }
    return scale;
}

static void judge(struct dalcs_audit *audit, const struct audit_part *part, double duration,
                  double time) {
    for (int k = 0; k < part->n_nodes; k++) {
        const int node = part->node[k];
        if (audit->net.has_charge[node]) {
            double off = fabs(audit->sums.current[node]) - audit->options.abstol * duration;
            const double allowed =
                audit->sums.rounding[node] + part->tolerance * audit->sums.scale[node];
            off -= off > allowed ? audit_rounding_around(audit, part, &audit->state.later, node)
                                 : audit->sums.rounding[node];
            audit_find(audit, part, DALCS_AUDIT_KCL, node, off, audit->sums.scale[node], time);
        }
    }
    for (int k = 0; k < part->n_devices; k++) {
        const int device = part->device[k];
        const struct dalcs_device *d = &audit->circuit->device[device];
        if (d->kind == DALCS_INDUCTOR) {
            const double scale = audit_flux_scale(audit, part, device) +
                                 audit_volts(audit, part, d->node[0], d->node[1]) * duration;
            audit_find(audit, part, DALCS_AUDIT_BRANCH, device,
                       fabs(audit->sums.flux[device]) - AUDIT_ROUNDING * scale -
                           audit->options.vntol * duration,
                       scale, time);
        }
    }
}

void audit_check_interval(struct dalcs_audit *audit, struct audit_part *part, double from,
                          double to) {
    const int index = (int)(part - audit->part);
    struct dalcs_audit_state *s = &audit->state.later;
    clear(audit, part);
    s->side = DALCS_RIGHT;
    s->t = from;
    audit->reader.read(audit->reader.user, index, s);
    add_storage(audit, part, s, -1.0);
    for (int k = 0; k < AUDIT_GAUSS; k++) {
        s->t = from + audit_gauss_node[k] * (to - from);
        audit->reader.read(audit->reader.user, index, s);
        add_flow(audit, part, s, audit_gauss_weight[k] * (to - from));
    }
    s->side = DALCS_LEFT;
    s->t = to;
    audit->reader.read(audit->reader.user, index, s);
    add_storage(audit, part, s, 1.0);
    judge(audit, part, to - from, to);
    audit_find(audit, part, DALCS_AUDIT_ENERGY, index,
               fmax(fabs(audit->sums.energy) - audit->sums.energy_rounding, 0.0),
               audit->sums.energy_scale, to);
}
