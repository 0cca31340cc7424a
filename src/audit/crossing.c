/* crossing.c - what holds across an event, where states may jump.
 *
 * In no time a branch can carry charge only if an impulse of current can be in it, and take flux only if an
 * impulse of voltage can (Brogliato and Thibault 2010, the jump law; Heemels, Schumacher and Weiland 1999).
 * Nodes that branches of the first kind join are a cluster: all charge on it stays, but for the one with
 * ground. Nodes that branches of the second kind do not separate have one potential: around a loop of coils
 * between such sets the fluxes that changed add up to 0. No state can jump but by such charges and fluxes,
 * and one that does not jump is where it was. */
#include "audit_crossing.h"
#include "audit_positions.h"

#include "union_find.h"

/* Coils without leakage between them hand an impulse of current on: their fluxes stay what they are. */
static bool is_perfectly_coupled(const struct dalcs_audit *audit, const struct audit_part *part,
                                 int device) {
    bool is = false;
    for (int k = 0; k < part->n_couplings && !is; k++) {
        const struct dalcs_coupling *m = &audit->circuit->coupling[part->coupling[k]];
        is = (m->inductor[0] == device || m->inductor[1] == device) && fabs(m->k) == 1.0;
    }
    return is;
}

/* Which way may charge pass in no time? The impulse of a diode's current needs that it stands at its knee thereafter, and
 * one in a resistance an impulse of voltage. */
int audit_ways_of_charge(const struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *before,
                         const struct dalcs_audit_state *after, int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    bool both = false;
    bool may_be[2];
    if (audit_has_impulse(audit, d)) {
        both = d->kind != DALCS_INDUCTOR && d->kind != DALCS_CAPACITOR;
        return both ? AUDIT_FORWARD | AUDIT_BACKWARD : 0;
    }
    switch (d->kind) {
    case DALCS_VSOURCE:
    case DALCS_VCVS:
    case DALCS_CCVS:
    case DALCS_CCCS:
        both = true;
        break;
    case DALCS_VCCS:
        both = d->behaviour != NULL;
        break;
    case DALCS_RESISTOR:
        both = dalcs_device_is_short(d); /* one whose current a formula reads */
        break;
    case DALCS_INDUCTOR:
        both = dalcs_device_is_short(d) || is_perfectly_coupled(audit, part, device);
        break;
    case DALCS_SWITCH:
        audit_find_positions(audit, part, before, after, device, may_be);
        both = audit->circuit->models.of_switch[d->model].ron == 0.0 && may_be[true];
        break;
    case DALCS_DIODE: {
        const struct dalcs_diode_model *m = &audit->circuit->models.of_diode[d->model];
        const double v = audit_voltage(after, d);
        const double allowed = part->tolerance * audit_volts(audit, part, d->node[0], d->node[1]) +
                               audit_volts_off_corner(audit, after, device);
        return (m->ron == 0.0 && v >= m->vfwd - allowed ? AUDIT_FORWARD : 0) |
               (m->rrev == 0.0 && v <= -m->vrev + allowed ? AUDIT_BACKWARD : 0);
    }
    default:
        break;
    }
    return both ? AUDIT_FORWARD | AUDIT_BACKWARD : 0;
}

bool audit_passes_charge(const struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *before,
                         const struct dalcs_audit_state *after, int device) {
    return audit_ways_of_charge(audit, part, before, after, device) != 0;
}

void audit_find_clusters(const struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *before,
                         const struct dalcs_audit_state *after, audit_joins *join) {
    audit->crossing.cluster[0] = 0;
    for (int k = 0; k < part->n_nodes; k++) {
        audit->crossing.cluster[part->node[k]] = part->node[k];
    }
    for (int k = 0; k < part->n_devices; k++) {
        const struct dalcs_device *d = &audit->circuit->device[part->device[k]];
        if (join(audit, part, before, after, part->device[k])) {
            dalcs_union_join(audit->crossing.cluster, audit->net.node_of[d->node[0]],
                             audit->net.node_of[d->node[1]]);
        }
    }
}

double audit_charge_gained(const struct dalcs_audit *audit, const struct audit_part *part,
                           const struct dalcs_audit_state *after, int device, double *scale) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    *scale = d->value * audit_volts(audit, part, d->node[0], d->node[1]);
    return d->value * (audit_voltage(after, d) - audit->crossing.stored[device]);
}

static void gather_charge(struct dalcs_audit *audit, const struct dalcs_device *d, int end,
                          double charge, double scale) {
    const int cluster = dalcs_union_find(audit->crossing.cluster, audit->net.node_of[d->node[end]]);
    audit->sums.current[cluster] += charge;
    audit->sums.scale[cluster] += scale;
}

static double conductance_of(const struct dalcs_audit *audit, const struct dalcs_audit_state *first,
                             int device) {
    const struct dalcs_circuit *c = audit->circuit;
    const struct dalcs_device *d = &c->device[device];
    if (d->kind == DALCS_SWITCH && first->is_closed[device]) {
        return 1.0 / c->models.of_switch[d->model].ron;
    }
    if (d->kind == DALCS_DIODE && first->i[device] != 0.0) {
        return 1.0 / c->models.of_diode[d->model].ron;
    }
    return d->kind == DALCS_RESISTOR ? fabs(1.0 / d->value) : 0.0;
}

struct audit_hanging audit_find_hanging(const struct dalcs_audit *audit,
                                        const struct audit_part *part,
                                        const struct dalcs_audit_state *at, audit_has_node *has,
                                        int root) {
    struct audit_hanging on = {0.0, 0.0};
    for (int k = 0; k < part->n_devices; k++) {
        const struct dalcs_device *d = &audit->circuit->device[part->device[k]];
        if (has(audit, d->node[0], root) != has(audit, d->node[1], root)) {
            const double siemens = conductance_of(audit, at, part->device[k]);
            on.siemens = isfinite(siemens) ? fmax(on.siemens, siemens) : on.siemens;
            on.farad += d->kind == DALCS_CAPACITOR ? d->value : 0.0;
        }
    }
    return on;
}

double audit_find_damping(const struct dalcs_audit *audit, const struct audit_part *part,
                          const struct dalcs_audit_state *at, double henry) {
    double siemens = part->floor.least;
    for (int k = 0; k < part->n_devices; k++) {
        const double own = conductance_of(audit, at, part->device[k]);
        siemens = own * henry <= part->at.step ? fmax(siemens, own) : siemens;
    }
    return siemens;
}

double audit_charge_unresolved(const struct dalcs_audit *audit, const struct audit_part *part,
                               const struct dalcs_audit_state *after, audit_has_node *has,
                               int root) {
    const struct audit_hanging on = audit_find_hanging(audit, part, after, has, root);
    return on.siemens * part->floor.largest_volt * audit->options.resolution;
}

bool audit_is_in_cluster(const struct dalcs_audit *audit, int node, int root) {
    return dalcs_union_find(audit->crossing.cluster, audit->net.node_of[node]) == root;
}

/* What the largest conductance moves in that time. */
static double charge_at_start(const struct dalcs_audit *audit, const struct audit_part *part) {
    return part->floor.most * part->floor.largest_volt * AUDIT_PROMISED * audit->options.resolution;
}

static void check_charge(struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *before,
                         const struct dalcs_audit_state *after) {
    const double slack = before == after ? charge_at_start(audit, part) : 0.0;
    audit_find_clusters(audit, part, before, after, audit_passes_charge);
    for (int k = 0; k < part->n_nodes; k++) {
        audit->sums.current[part->node[k]] = audit->sums.scale[part->node[k]] = 0.0;
    }
    for (int k = 0; k < part->n_devices; k++) {
        const struct dalcs_device *d = &audit->circuit->device[part->device[k]];
        if (d->kind != DALCS_CAPACITOR) {
            continue;
        }
        double scale;
        const double charge = audit_charge_gained(audit, part, after, part->device[k], &scale);
        gather_charge(audit, d, 0, charge, scale);
        gather_charge(audit, d, 1, -charge, scale);
    }
    for (int k = 0; k < part->n_nodes; k++) {
        const int node = part->node[k];
        const double scale = audit->sums.scale[node];
        if (scale > 0.0 && dalcs_union_find(audit->crossing.cluster, node) == node) {
            double off = fabs(audit->sums.current[node]) - AUDIT_ROUNDING * scale - slack;
            off -= off > part->tolerance * scale
                       ? audit_charge_unresolved(audit, part, after, audit_is_in_cluster, node)
                       : 0.0;
            audit_find_charge(audit, part, node, off, scale, after->t);
        }
    }
}

static void check_both(struct dalcs_audit *audit, const struct audit_part *part,
                       const struct dalcs_audit_state *before,
                       const struct dalcs_audit_state *after) {
    audit_find_impulses(audit, part, before, after);
    check_charge(audit, part, before, after);
    if (before != after) {
        audit_check_directions(audit, part, before, after);
    }
    audit_check_fluxes(audit, part, before, after);
    audit_forget_impulses(audit, part);
}

/* Where corners are read as they are, most jumps hold. What does not is asked again, with what corners may be off by. */
void audit_check_jump(struct dalcs_audit *audit, const struct audit_part *part,
                      const struct dalcs_audit_state *before,
                      const struct dalcs_audit_state *after) {
    audit->crossing.is_first_try = true;
    audit->crossing.holds = true;
    check_both(audit, part, before, after);
    audit->crossing.is_first_try = false;
    if (!audit->crossing.holds) {
        audit_widen_corners(audit, part, after);
        check_both(audit, part, before, after);
        audit->crossing.corners.later = NULL;
    }
}

void audit_check_crossing(struct dalcs_audit *audit, struct audit_part *part,
                          const struct dalcs_audit_state *before,
                          const struct dalcs_audit_state *after) {
    for (int k = 0; k < part->n_devices; k++) {
        const int device = part->device[k];
        const struct dalcs_device *d = &audit->circuit->device[device];
        audit->crossing.stored[device] =
            d->kind == DALCS_CAPACITOR ? audit_voltage(before, d) : before->i[device];
    }
    audit_check_jump(audit, part, before, after);
    audit_check_changes(audit, part, before, after);
}
