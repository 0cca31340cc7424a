/* impulses.c - nodes whose potential may be an impulse.
 *
 * Where capacitors jump, the current through what joins them is an impulse. H, F and formulas that read it put one out:
 * an impulse of voltage across what hangs there, or of current into it. Where the current of a coil jumps, the voltage
 * across it is one, and E, G and formulas read that. It goes along resistances, and moves charge through them and flux in
 * coils, as far as nodes that capacitors and sources tie to ground. */
#include "audit_crossing.h"

#include "union_find.h"

static bool has(const struct dalcs_audit *audit, int node) {
    return audit->crossing.has_impulse[audit->net.node_of[node]];
}

static bool reads_voltage(const struct dalcs_device *d) {
    return d->behaviour == NULL && (d->kind == DALCS_VCVS || d->kind == DALCS_VCCS);
}

static bool is_loose(const struct dalcs_audit *audit, int node) {
    return audit->crossing.tie[audit->net.node_of[node]] != 0;
}

/* Of a node that is read: where a coil jumps each that nothing ties may have one. */
static bool may_have(const struct dalcs_audit *audit, int node) {
    return has(audit, node) || (audit->crossing.coils_jump && is_loose(audit, node));
}

/* Of what E and G read. Two nodes that a capacitor or a source ties have the same one. */
static bool control_may_have(const struct dalcs_audit *audit, const struct dalcs_device *d) {
    const int plus = audit->net.node_of[d->node[2]];
    const int minus = audit->net.node_of[d->node[3]];
    return (may_have(audit, plus) || may_have(audit, minus)) &&
           audit->crossing.tie[plus] != audit->crossing.tie[minus];
}

bool audit_has_impulse(const struct dalcs_audit *audit, const struct dalcs_device *d) {
    return has(audit, d->node[0]) || has(audit, d->node[1]) ||
           (d->kind == DALCS_VCCS && reads_voltage(d) && control_may_have(audit, d));
}

/* Clusters with a capacitor that jumped, in offset[] of their roots: in all that joins their nodes an impulse may be. */
static bool mark_jumps(struct dalcs_audit *audit, const struct audit_part *part,
                       const struct dalcs_audit_state *before,
                       const struct dalcs_audit_state *after) {
    bool jumps = false;
    double *has_jumped = audit->crossing.offset;
    audit_find_clusters(audit, part, before, after, audit_passes_charge);
    has_jumped[0] = 0.0;
    for (int k = 0; k < part->n_nodes; k++) {
        has_jumped[part->node[k]] = 0.0;
    }
    for (int k = 0; k < part->n_devices; k++) {
        const struct dalcs_device *d = &audit->circuit->device[part->device[k]];
        double scale;
        if (d->kind == DALCS_CAPACITOR &&
            fabs(audit_charge_gained(audit, part, after, part->device[k], &scale)) >
                part->tolerance * scale) {
            for (int e = 0; e < 2; e++) {
                has_jumped[dalcs_union_find(audit->crossing.cluster,
                                            audit->net.node_of[d->node[e]])] = 1.0;
            }
            jumps = true;
        }
    }
    return jumps;
}

/* Tied to ground by what no impulse of voltage is across. */
static bool is_tie(const struct dalcs_audit *audit, const struct audit_part *part,
                   const struct dalcs_audit_state *before, const struct dalcs_audit_state *after,
                   int device) {
    (void)part, (void)before, (void)after;
    const enum dalcs_device_kind kind = audit->circuit->device[device].kind;
    return kind == DALCS_CAPACITOR || kind == DALCS_VSOURCE;
}

struct reading {
    const struct dalcs_audit *audit;
    const struct audit_part *part;
    bool current, voltage; /* of which one is read that is an impulse */
};

/* While audit->crossing.cluster is that of mark_jumps(). What another part has is finite here. */
static bool reads_impulse(const struct reading *r, int control) {
    const struct dalcs_device *d = &r->audit->circuit->device[control];
    const int node = r->audit->net.node_of[d->node[d->node[0] == 0]];
    const bool is_own = r->audit->net.owner[node] == (int)(r->part - r->audit->part);
    return is_own &&
           r->audit->crossing.offset[dalcs_union_find(r->audit->crossing.cluster, node)] != 0.0;
}

static void note_term(void *to, const struct dalcs_affine_term *term) {
    struct reading *r = to;
    r->current |= term->kind == DALCS_QUANTITY_CURRENT && reads_impulse(r, term->index);
    r->voltage |= term->kind == DALCS_QUANTITY_VOLTAGE && may_have(r->audit, term->index);
}

/* What acts by a current. */
static bool acts_by_current(const struct dalcs_audit *audit, const struct audit_part *part,
                            const struct dalcs_device *d) {
    struct reading r = {.audit = audit, .part = part};
    dalcs_behaviour_visit(d->behaviour, note_term, &r);
    return r.current || ((d->kind == DALCS_CCVS || d->kind == DALCS_CCCS) && d->behaviour == NULL &&
                         reads_impulse(&r, d->control));
}

static bool acts_by_voltage(const struct dalcs_audit *audit, const struct audit_part *part,
                            const struct dalcs_device *d) {
    struct reading r = {.audit = audit, .part = part};
    dalcs_behaviour_visit(d->behaviour, note_term, &r);
    return r.voltage || (reads_voltage(d) && control_may_have(audit, d));
}

/* The ends of a device that are not firm get it; whether one had none. */
static bool spread(struct dalcs_audit *audit, const struct dalcs_device *d) {
    bool is_new = false;
    for (int e = 0; e < 2; e++) {
        const int node = audit->net.node_of[d->node[e]];
        if (audit->crossing.tie[node] != 0 && !audit->crossing.has_impulse[node]) {
            audit->crossing.has_impulse[node] = is_new = true;
        }
    }
    return is_new;
}

static void spread_all(struct dalcs_audit *audit, const struct audit_part *part) {
    bool grows = true;
    while (grows) {
        grows = false;
        for (int k = 0; k < part->n_devices; k++) {
            const struct dalcs_device *d = &audit->circuit->device[part->device[k]];
            const bool leads = d->kind != DALCS_INDUCTOR && d->kind != DALCS_ISOURCE &&
                               (has(audit, d->node[0]) || has(audit, d->node[1]));
            if (leads || acts_by_voltage(audit, part, d)) {
                grows = spread(audit, d) || grows;
            }
        }
    }
}

void audit_forget_impulses(struct dalcs_audit *audit, const struct audit_part *part) {
    audit->crossing.coils_jump = false;
    for (int k = 0; k < part->n_nodes; k++) {
        audit->crossing.has_impulse[part->node[k]] = false;
    }
}

static bool is_jumping_coil(const struct dalcs_audit *audit, const struct audit_part *part,
                            const struct dalcs_audit_state *after, int device) {
    return audit->circuit->device[device].kind == DALCS_INDUCTOR &&
           fabs(after->i[device] - audit->crossing.stored[device]) >
               part->tolerance * audit_amperes(audit, part, device);
}

static bool has_jumping_coil(const struct dalcs_audit *audit, const struct audit_part *part,
                             const struct dalcs_audit_state *after) {
    bool has = false;
    for (int k = 0; k < part->n_devices && !has; k++) {
        has = is_jumping_coil(audit, part, after, part->device[k]);
    }
    return has;
}

/* Marks in acts[] what puts out an impulse of a current that it reads. */
static bool mark_actors(const struct dalcs_audit *audit, const struct audit_part *part,
                        double *acts) {
    bool any = false;
    for (int k = 0; k < part->n_devices; k++) {
        const int device = part->device[k];
        acts[device] = acts_by_current(audit, part, &audit->circuit->device[device]) ? 1.0 : 0.0;
        any = any || acts[device] != 0.0;
    }
    return any;
}

void audit_find_impulses(struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *before,
                         const struct dalcs_audit_state *after) {
    double *acts = audit->sums.flux; /* of devices: free until fluxes are added up */
    const bool by_coils =
        (part->has.reader || part->has.voltage_reader) && has_jumping_coil(audit, part, after);
    const bool by_currents = part->has.reader && mark_jumps(audit, part, before, after) &&
                             mark_actors(audit, part, acts);
    if (!by_coils && !by_currents) {
        return;
    }
    audit_find_clusters(audit, part, before, after, is_tie);
    audit->crossing.tie[0] = 0;
    for (int k = 0; k < part->n_nodes; k++) {
        const int node = part->node[k];
        audit->crossing.tie[node] = dalcs_union_find(audit->crossing.cluster, node);
    }
    audit->crossing.coils_jump = by_coils;
    for (int k = 0; by_currents && k < part->n_devices; k++) {
        if (acts[part->device[k]] != 0.0) {
            (void)spread(audit, &audit->circuit->device[part->device[k]]);
        }
    }
    spread_all(audit, part);
}
