/* directions.c - which way charge may have gone in no time.
 *
 * The impulse of a diode's current has a sign as its current has (Heemels, Schumacher and Weiland 1999): what nodes have
 * gained has come along branches from nodes that lost it. So of all nodes from which charge can reach one, none
 * outside can have given them any, and together they hold no more than before; of all that charge from one can reach,
 * no less (Gale 1957: a flow exists only if every such set allows it). */
#include "audit_crossing.h"

/* Branches are gone through so many times, in both orders, for a set; where chains of diodes lead farther, there is none. */
enum { MOST_SWEEPS = 32 };

/* The node that gained most (sign 1), or lost most (-1), of what it is held to; -1: none did by more than the tolerance. */
static int find_extreme(const struct dalcs_audit *audit, const struct audit_part *part,
                        double sign) {
    double most = part->tolerance;
    int extreme = -1;
    for (int k = 0; k < part->n_nodes; k++) {
        const int node = part->node[k];
        const double share =
            audit_ratio(sign * audit->crossing.offset[node], audit->sums.scale[node]);
        if (share > most) {
            most = share;
            extreme = node;
        }
    }
    return extreme;
}

/* Joins an end of a branch to the set, if charge can go between it and one in the set, as `sign` has it. */
static bool extend(const struct dalcs_audit *audit, const struct dalcs_device *d, int way,
                   double sign) {
    int *in = audit->crossing.cluster;
    const int end[2] = {audit->net.node_of[d->node[0]], audit->net.node_of[d->node[1]]};
    bool found = false;
    for (int from = 0; from < 2; from++) {
        const int outer = sign > 0.0 ? end[from] : end[1 - from];
        const int inner = sign > 0.0 ? end[1 - from] : end[from];
        if ((way & (from == 0 ? AUDIT_FORWARD : AUDIT_BACKWARD)) != 0 && in[inner] && !in[outer]) {
            in[outer] = 1;
            found = true;
        }
    }
    return found;
}

/* The set of a node, in crossing.cluster. Not where ground is in it, which has all charge there is, or where it is not
 * complete. */
static bool find_set(const struct dalcs_audit *audit, const struct audit_part *part,
                     const struct dalcs_audit_state *before, const struct dalcs_audit_state *after,
                     int node, double sign) {
    int *in = audit->crossing.cluster;
    in[0] = 0;
    for (int k = 0; k < part->n_nodes; k++) {
        in[part->node[k]] = part->node[k] == node;
    }
    bool grows = true;
    for (int sweep = 0; sweep < MOST_SWEEPS && grows && !in[0]; sweep++) {
        grows = false;
        for (int k = 0; k < part->n_devices; k++) {
            const int device = part->device[sweep % 2 == 0 ? k : part->n_devices - 1 - k];
            const int way = audit_ways_of_charge(audit, part, before, after, device);
            grows = extend(audit, &audit->circuit->device[device], way, sign) || grows;
        }
    }
    return !grows && !in[0];
}

static bool is_in_set(const struct dalcs_audit *audit, int node, int mark) {
    return audit->crossing.cluster[audit->net.node_of[node]] == mark;
}

static void check_set(struct dalcs_audit *audit, const struct audit_part *part,
                      const struct dalcs_audit_state *after, int node, double sign) {
    double charge = 0.0;
    double scale = 0.0;
    for (int k = 0; k < part->n_nodes; k++) {
        if (audit->crossing.cluster[part->node[k]]) {
            charge += sign * audit->crossing.offset[part->node[k]];
            scale += audit->sums.scale[part->node[k]];
        }
    }
    double off = charge - AUDIT_ROUNDING * scale;
    off -= off > part->tolerance * scale ? audit_charge_unresolved(audit, part, after, is_in_set, 1)
                                         : 0.0;
    audit_find_charge(audit, part, node, off, scale, after->t);
}

/* Of each node: the charge that it gained, in crossing.offset, and what that is held to, in sums.scale. */
static void gather(struct dalcs_audit *audit, const struct audit_part *part,
                   const struct dalcs_audit_state *after) {
    for (int k = 0; k < part->n_nodes; k++) {
        audit->crossing.offset[part->node[k]] = audit->sums.scale[part->node[k]] = 0.0;
    }
    for (int k = 0; k < part->n_devices; k++) {
        const struct dalcs_device *d = &audit->circuit->device[part->device[k]];
        if (d->kind != DALCS_CAPACITOR) {
            continue;
        }
        double scale;
        const double charge = audit_charge_gained(audit, part, after, part->device[k], &scale);
        for (int end = 0; end < 2; end++) {
            const int node = audit->net.node_of[d->node[end]];
            audit->crossing.offset[node] += end == 0 ? charge : -charge;
            audit->sums.scale[node] += scale;
        }
    }
}

void audit_check_directions(struct dalcs_audit *audit, const struct audit_part *part,
                            const struct dalcs_audit_state *before,
                            const struct dalcs_audit_state *after) {
    gather(audit, part, after);
    for (double sign = 1.0; sign >= -1.0; sign -= 2.0) {
        const int node = find_extreme(audit, part, sign);
        if (node >= 0 && find_set(audit, part, before, after, node, sign)) {
            check_set(audit, part, after, node, sign);
        }
    }
}
