/* leaks.c - coils that nothing but leaks feed.
 *
 * Such a coil takes on their current within L g. The stages of a step that is longer lie behind that: its current is known to
 * what the leaks carry. */
#include "audit_internal.h"

/* S, of what else hangs on a node than a coil; INFINITY: something whose current no voltage tells. */
static double siemens_beside(const struct dalcs_audit *audit, const struct audit_part *part,
                             const struct dalcs_audit_state *s, int node, int coil) {
    const struct dalcs_circuit *c = audit->circuit;
    double sum = node == 0 ? INFINITY : 0.0;
    for (int k = 0; k < part->n_devices && sum < INFINITY; k++) {
        const int device = part->device[k];
        const struct dalcs_device *d = &c->device[device];
        if (device == coil ||
            (audit->net.node_of[d->node[0]] != node && audit->net.node_of[d->node[1]] != node)) {
            continue;
        }
        const double conducts = audit_conductance(audit, s, device);
        const bool is_open = d->kind == DALCS_SWITCH  ? !s->is_closed[device]
                             : d->kind == DALCS_DIODE ? s->i[device] <= 0.0
                                                      : false;
        sum += !is_open                  ? (conducts > 0.0 ? conducts : INFINITY)
               : d->kind == DALCS_SWITCH ? 1.0 / c->switch_model[d->model].roff
                                         : 1.0 / c->diode_model[d->model].roff;
    }
    return sum;
}

double audit_leak_of(const struct dalcs_audit *audit, const struct audit_part *part,
                     const struct dalcs_audit_state *s, int coil) {
    const struct dalcs_device *d = &audit->circuit->device[coil];
    double least = INFINITY;
    for (int e = 0; e < 2; e++) {
        least = fmin(least, siemens_beside(audit, part, s, audit->net.node_of[d->node[e]], coil));
    }
    return d->value * least <= part->at.step ? least * audit->sums.largest_volt : 0.0;
}

double audit_leaks_at(const struct dalcs_audit *audit, const struct audit_part *part,
                      const struct dalcs_audit_state *s, int node) {
    double sum = 0.0;
    for (int k = 0; k < part->n_devices; k++) {
        const struct dalcs_device *d = &audit->circuit->device[part->device[k]];
        if (d->kind == DALCS_INDUCTOR &&
            (audit->net.node_of[d->node[0]] == node || audit->net.node_of[d->node[1]] == node)) {
            sum += audit_leak_of(audit, part, s, part->device[k]);
        }
    }
    return sum;
}
