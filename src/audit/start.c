/* start.c - where a run begins.
 *
 * With uic capacitors and coils have what IC= says, or jump from there as they do at an event. Else the circuit rests:
 * currents that are no capacitor's cancel at each set of nodes that ideal branches join, and no voltage is across a coil.
 * An ideal branch may carry at once what a capacitor behind it takes from a source that moves, so no node alone is asked.
 * A law has one unit: where it is asked as a charge or a flux elsewhere, here it is that of a step. */
#include "audit_crossing.h"

#include "union_find.h"

static void check_initial(struct dalcs_audit *audit, const struct audit_part *part,
                          const struct dalcs_audit_state *first) {
    for (int k = 0; k < part->n_devices; k++) {
        const struct dalcs_device *d = &audit->circuit->device[part->device[k]];
        audit->crossing.stored[part->device[k]] = d->has_initial ? d->initial : 0.0;
    }
    audit_check_jump(audit, part, first, first);
}

static bool is_ideal(const struct dalcs_audit *audit, const struct audit_part *part,
                     const struct dalcs_audit_state *before, const struct dalcs_audit_state *first,
                     int device) {
    const struct dalcs_circuit *c = audit->circuit;
    const struct dalcs_device *d = &c->device[device];
    switch (d->kind) {
    case DALCS_VSOURCE:
    case DALCS_VCVS:
        return true;
    case DALCS_RESISTOR:
        return d->value == 0.0;
    case DALCS_SWITCH:
        return first->is_closed[device] && c->models.of_switch[d->model].ron == 0.0;
    case DALCS_INDUCTOR: /* without leakage it hands on what another one carries */
    case DALCS_DIODE: /* one at its knee may have carried at rest what a source that moves takes from it at once */
        return audit_ways_of_charge(audit, part, before, first, device) != 0;
    default:
        return false;
    }
}

/* Stages of a step lie behind a transient of L/R, or RC, that is shorter than it, and their polynomial is off at its
 * beginning by so much less than how the voltage, or the current, goes on: so far, times the polynomial's Lebesgue function
 * there, from its stages alone. That is 13 for seven stages. 0: nothing is known of them. */
static double reach_of(const struct dalcs_audit_polynomials *p) {
    double sum = 0.0;
    for (int j = 0; p != NULL && j < p->n_nodes; j++) {
        double product = p->node[j] > 0.0 ? 1.0 : 0.0;
        for (int k = 0; k < p->n_nodes && p->node[j] > 0.0; k++) {
            product *= k == j || !(p->node[k] > 0.0) ? 1.0 : p->node[k] / (p->node[k] - p->node[j]);
        }
        sum += fabs(product);
    }
    return sum;
}

/* Into crossing.offset: what leaves each node through all but capacitors at the end of the step. */
static void sum_later_currents(struct dalcs_audit *audit, const struct audit_part *part,
                               const struct dalcs_audit_state *first) {
    audit->state.shifted.side = DALCS_LEFT;
    audit->state.shifted.t = first->t + part->at.step;
    audit->reader.read(audit->reader.user, (int)(part - audit->part), &audit->state.shifted);
    audit_sum_currents(audit, part, &audit->state.shifted);
    for (int k = 0; k < part->n_nodes; k++) {
        audit->crossing.offset[part->node[k]] = audit->sums.current[part->node[k]];
    }
}

/* How far stages that lie behind a transient of RC may be off at their beginning, in A; no more than what the promised
 * error of a voltage drives through the resistance. */
static double behind_transient(const struct dalcs_audit *audit, const struct audit_part *part,
                               const struct audit_hanging *on, double later, double reach) {
    const double known = part->at.step * on->siemens;
    const double behind = known > 0.0 ? reach * later * on->farad / known : 0.0;
    return fmin(behind, on->siemens * part->floor.largest_volt * audit->options.failure);
}

static void add_to_clusters(struct dalcs_audit *audit, const struct audit_part *part) {
    struct audit_sums *sums = &audit->sums;
    for (int k = 0; k < part->n_nodes; k++) {
        const int node = part->node[k];
        const int root = dalcs_union_find(audit->crossing.cluster, node);
        if (root != node) {
            sums->current[root] += sums->current[node];
            sums->scale[root] += sums->scale[node];
            sums->rounding[root] += sums->rounding[node];
            audit->crossing.offset[root] += audit->crossing.offset[node];
        }
    }
}

static void check_currents(struct dalcs_audit *audit, const struct audit_part *part,
                           const struct dalcs_audit_state *first, double reach) {
    struct audit_sums *sums = &audit->sums;
    sum_later_currents(audit, part, first);
    audit_sum_currents(audit, part, first);
    audit_find_clusters(audit, part, first, first, is_ideal);
    add_to_clusters(audit, part);
    for (int k = 0; k < part->n_nodes; k++) {
        const int node = part->node[k];
        if (dalcs_union_find(audit->crossing.cluster, node) == node) {
            const double duration = audit->net.has_charge[node] ? part->at.step : 1.0;
            const double later = fabs(audit->crossing.offset[node] - sums->current[node]);
            double off = fabs(sums->current[node]) - sums->rounding[node] - audit->options.abstol;
            if (off > part->tolerance * sums->scale[node]) {
                const struct audit_hanging on =
                    audit_find_hanging(audit, part, first, audit_is_in_cluster, node);
                off -= behind_transient(audit, part, &on, later, reach);
            }
            audit_find(audit, part, DALCS_AUDIT_KCL, node, off * duration,
                       sums->scale[node] * duration, first->t);
        }
    }
}

/* What drives a current that moves makes a voltage across a coil. */
static bool has_moving_current(const struct dalcs_audit *audit, const struct audit_part *part) {
    bool has = false;
    for (int k = 0; k < part->n_devices && !has; k++) {
        const struct dalcs_device *d = &audit->circuit->device[part->device[k]];
        has = d->kind == DALCS_VCCS ||
              (d->kind == DALCS_ISOURCE &&
               audit->circuit->stimulus[d->stimulus].kind != DALCS_STIMULUS_DC);
    }
    return has;
}

/* How far stages that lie behind a transient of L/R may be off at their beginning, in V: a resistance takes its current from
 * the coil as fast as the coil's ends move, alike or not. No more than the promised error of a voltage, but for what the
 * least conductance takes. */
static double behind_leak(const struct dalcs_audit *audit, const struct audit_part *part,
                          const struct dalcs_audit_state *first, const struct dalcs_device *d,
                          double reach) {
    const struct dalcs_audit_state *later = &audit->state.shifted;
    double moved = 0.0;
    for (int end = 0; end < 2; end++) {
        moved += fabs(later->v[d->node[end]] - first->v[d->node[end]]);
    }
    const double per_siemens = reach * moved / part->at.step * d->value;
    const double siemens = audit_find_damping(audit, part, first, d->value);
    return fmax(per_siemens * part->floor.least,
                fmin(per_siemens * siemens, part->floor.largest_volt * audit->options.failure));
}

static void check_coils(struct dalcs_audit *audit, const struct audit_part *part,
                        const struct dalcs_audit_state *first, double reach) {
    const struct dalcs_audit_state *later = &audit->state.shifted;
    bool is_read = false;
    for (int k = 0; k < part->n_devices; k++) {
        const int device = part->device[k];
        const struct dalcs_device *d = &audit->circuit->device[device];
        if (d->kind == DALCS_INDUCTOR && !is_read) {
            audit->state.shifted.side = DALCS_LEFT;
            audit->state.shifted.t = first->t + part->at.step;
            audit->reader.read(audit->reader.user, (int)(part - audit->part),
                               &audit->state.shifted);
            is_read = true;
        }
        if (d->kind == DALCS_INDUCTOR) {
            const double off = fabs(audit_voltage(first, d)) - 2.0 * audit->sums.volts -
                               audit->options.vntol - behind_leak(audit, part, first, d, reach);
            /* What is 0 at the start has the scale that the first step gives it, as it has in the engine. */
            const double scale = fmax(audit_volts(audit, part, d->node[0], d->node[1]),
                                      fabs(later->v[d->node[0]]) + fabs(later->v[d->node[1]]));
            audit_find(audit, part, DALCS_AUDIT_BRANCH, device, off * part->at.step,
                       scale * part->at.step, first->t);
        }
    }
}

void audit_check_start(struct dalcs_audit *audit, const struct audit_part *part,
                       const struct dalcs_audit_state *first,
                       const struct dalcs_audit_polynomials *stored) {
    if (audit->options.origin == DALCS_AUDIT_FROM_INITIAL) {
        check_initial(audit, part, first);
    } else if (audit->options.origin == DALCS_AUDIT_FROM_REST && !part->has.reader &&
               !part->is_restless) {
        const double reach = reach_of(stored);
        check_currents(audit, part, first, reach);
        if (stored != NULL && !has_moving_current(audit, part)) {
            check_coils(audit, part, first, reach);
        }
    }
}
