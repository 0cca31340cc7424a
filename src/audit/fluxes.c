/* fluxes.c - what fluxes do across an event: those of coils around loops, and the way that diodes let them pass.
 *
 * An impulse of voltage is across nothing that bounds its voltage. Nodes that such branches join have one flux; coils give
 * the differences between these. A diode takes an impulse backward only (Heemels, Schumacher and Weiland 1999: the impulse
 * satisfies the conditions of complementarity, too). */
#include "audit_crossing.h"

#include "union_find.h"

/* Does a finite voltage stand across it, whatever happens? */
static bool bounds_voltage(const struct dalcs_audit *audit, const struct audit_part *part,
                           const struct dalcs_audit_state *before,
                           const struct dalcs_audit_state *after, int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    bool may_be[2];
    switch (d->kind) {
    case DALCS_CAPACITOR:
    case DALCS_VSOURCE:
        return true;
    case DALCS_RESISTOR:
        return !audit_has_impulse(audit, d);
    case DALCS_SWITCH:
        audit_find_positions(audit, part, before, after, device, may_be);
        return !audit_has_impulse(audit, d) &&
               (isfinite(audit->circuit->models.of_switch[d->model].roff) || !may_be[false]);
    case DALCS_DIODE: {
        const struct dalcs_diode_model *m = &audit->circuit->models.of_diode[d->model];
        return !audit_has_impulse(audit, d) &&
               (isfinite(m->roff) || isfinite(m->vrev) ||
                after->i[device] > part->tolerance * audit_amperes(audit, part, device) +
                                       audit_amperes_off_corner(audit, after, device));
    }
    default: /* I, E, F, G, H, formulas: whatever their controls have */
        return false;
    }
}

/* The root of a node, and the flux between the two: offset[n] is that of n over its parent. */
static int find_root(const struct dalcs_audit *audit, int node, double *flux) {
    *flux = 0.0;
    while (audit->crossing.cluster[node] != node) {
        *flux += audit->crossing.offset[node];
        node = audit->crossing.cluster[node];
    }
    return node;
}

static void sum_fluxes(struct dalcs_audit *audit, const struct audit_part *part,
                       const struct dalcs_audit_state *after) {
    for (int k = 0; k < part->n_devices; k++) {
        const int device = part->device[k];
        const struct dalcs_device *d = &audit->circuit->device[device];
        audit->sums.flux[device] =
            d->kind == DALCS_INDUCTOR
                ? d->value * (after->i[device] - audit->crossing.stored[device])
                : 0.0;
    }
    for (int k = 0; k < part->n_couplings; k++) {
        const struct dalcs_coupling *m = &audit->circuit->coupling[part->coupling[k]];
        const int a = m->inductor[0];
        const int b = m->inductor[1];
        const double mutual =
            m->k * sqrt(audit->circuit->device[a].value * audit->circuit->device[b].value);
        audit->sums.flux[a] += mutual * (after->i[b] - audit->crossing.stored[b]);
        audit->sums.flux[b] += mutual * (after->i[a] - audit->crossing.stored[a]);
    }
}

/* What passes while times cannot be told apart: a coil that is cut off may have 1e9 V for 1e-14 s. */
static double flux_unresolved(const struct dalcs_audit *audit,
                              const struct dalcs_audit_state *before,
                              const struct dalcs_audit_state *after, const struct dalcs_device *d) {
    return fmax(fabs(audit_voltage(before, d)), fabs(audit_voltage(after, d))) *
           audit->options.resolution;
}

/* Fluxes of nodes over the roots of their trees, with scales and roundings of these. */
static void begin_trees(struct dalcs_audit *audit, const struct audit_part *part) {
    for (int k = 0; k < part->n_nodes; k++) {
        const int node = part->node[k];
        audit->crossing.cluster[node] = dalcs_union_find(audit->crossing.cluster, node);
        audit->crossing.offset[node] = 0.0;
        audit->sums.scale[node] = audit->sums.rounding[node] = 0.0; /* here of a root's tree */
    }
    audit->sums.scale[0] = audit->sums.rounding[0] = 0.0;
}

/* Its flux over what the tree between its nodes has: *root is that tree. false: it joins two trees. */
static bool closes_loop(struct dalcs_audit *audit, const struct dalcs_device *d, double own,
                        double *over, int root[2]) {
    double flux[2];
    root[0] = find_root(audit, audit->net.node_of[d->node[0]], &flux[0]);
    root[1] = find_root(audit, audit->net.node_of[d->node[1]], &flux[1]);
    *over = own - (flux[0] - flux[1]);
    return root[0] == root[1];
}

static void take_coil(struct dalcs_audit *audit, const struct audit_part *part, int device,
                      const struct dalcs_audit_state *before,
                      const struct dalcs_audit_state *after) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    double over;
    int root[2];
    const bool closes = closes_loop(audit, d, audit->sums.flux[device], &over, root);
    const double scale = audit_flux_scale(audit, part, device);
    const double rounding = AUDIT_ROUNDING * scale + flux_unresolved(audit, before, after, d);
    if (closes) {
        audit_find_flux(audit, part, device, fabs(over) - rounding - audit->sums.rounding[root[0]],
                        scale + audit->sums.scale[root[0]], after->t);
    } else {
        audit->crossing.cluster[root[0]] = root[1];
        audit->crossing.offset[root[0]] = over;
        audit->sums.scale[root[1]] += audit->sums.scale[root[0]] + scale;
        audit->sums.rounding[root[1]] += audit->sums.rounding[root[0]] + rounding;
    }
}

/* Forward there is no impulse of voltage: the diode conducts. */
static void take_diode(struct dalcs_audit *audit, const struct audit_part *part, int device,
                       const struct dalcs_audit_state *after) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    double backward;
    int root[2];
    if (closes_loop(audit, d, 0.0, &backward, root) && !audit_has_impulse(audit, d)) {
        audit_find_flux(audit, part, device, -backward - audit->sums.rounding[root[0]],
                        audit->sums.scale[root[0]], after->t);
    }
}

void audit_check_fluxes(struct dalcs_audit *audit, const struct audit_part *part,
                        const struct dalcs_audit_state *before,
                        const struct dalcs_audit_state *after) {
    audit_find_clusters(audit, part, before, after, bounds_voltage);
    sum_fluxes(audit, part, after);
    begin_trees(audit, part);
    for (int k = 0; k < part->n_devices; k++) {
        if (audit->circuit->device[part->device[k]].kind == DALCS_INDUCTOR) {
            take_coil(audit, part, part->device[k], before, after);
        }
    }
    for (int k = 0; k < part->n_devices; k++) {
        if (audit->circuit->device[part->device[k]].kind == DALCS_DIODE) {
            take_diode(audit, part, part->device[k], after);
        }
    }
}
