/* audit_periodic_members.c - who is in the part that is looked at, and how large its voltages and currents are. */
#include "audit_periodic.h"

#include <math.h>

/* Does a linear E or a V source follow from nodes that are known? */
static bool feeds(const struct dalcs_device *d, const bool *is_known) {
    const bool is_source = d->kind == DALCS_VSOURCE && d->behaviour == NULL;
    const bool is_amplifier = d->kind == DALCS_VCVS && d->behaviour == NULL &&
                              is_known[d->node[2]] && is_known[d->node[3]];
    return (is_source || is_amplifier) && is_known[d->node[0]] != is_known[d->node[1]];
}

static void find_fed(struct dalcs_audit_periodic *a) {
    const struct dalcs_circuit *c = &a->run->s->circuit;
    bool *is_known = a->work.is_known;
    for (int n = 0; n < c->n_nodes; n++) {
        is_known[n] = n == 0 || a->rows.node_system[n] == a->look.part;
    }
    a->of.n_fed = 0;
    for (bool any = true; any;) {
        any = false;
        for (int d = 0; d < c->n_devices; d++) {
            if (!a->of.are_there[d] && feeds(&c->device[d], is_known)) {
                is_known[c->device[d].node[0]] = is_known[c->device[d].node[1]] = true;
                a->of.fed[a->of.n_fed++] = d;
                any = true;
            }
        }
    }
}

static void find_states(struct dalcs_audit_periodic *a) {
    const struct dalcs_circuit *c = &a->run->s->circuit;
    int k = 0; /* states are in the order of their devices */
    for (int d = 0; d < c->n_devices; d++) {
        const enum dalcs_device_kind kind = c->device[d].kind;
        a->of.state[d] = -1;
        if (kind == DALCS_CAPACITOR || kind == DALCS_INDUCTOR) {
            const struct dalcs_probe *probe = &a->run->s->network.state[k++].probe;
            a->of.state[d] = kind == DALCS_CAPACITOR ? probe->term[0].index : -1;
        }
    }
}

/* The largest voltage and current of the part. */
static void find_scales(struct dalcs_audit_periodic *a) {
    const struct dalcs_orbit_part *p = &a->log->part[a->look.part];
    const struct dalcs_radau_part *part = p->rates.part;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const struct dalcs_system *s = part->component->system;
    a->laws.orbit.volts = a->laws.orbit.amperes = 0.0;
    for (int k = 0; k < p->record.n; k++) {
        for (int c = 0; c < dalcs_system_n_equations(s); c++) {
            double *of = s->column_is_current[c] ? &a->laws.orbit.amperes : &a->laws.orbit.volts;
            *of = fmax(*of, fabs(p->record.segment[k].out[c]));
            *of = fmax(*of, fabs(p->record.segment[k].out[(l->n_nodes - 1) * l->stride + c]));
        }
    }
}

/* Outputs of gates are on their own; what they do to a small signal is known to gates alone. */
void dalcs_periodic_values_choose(struct dalcs_audit_periodic *a) {
    const struct dalcs_circuit *c = &a->run->s->circuit;
    for (int d = 0; d < c->n_devices; d++) {
        const struct dalcs_device *device = &c->device[d];
        const bool is_source = device->kind == DALCS_VSOURCE || device->kind == DALCS_ISOURCE;
        a->of.are_there[d] = a->readout->device_system[d] == a->look.part &&
                             !(is_source && a->log->gates != NULL &&
                               dalcs_logic_pin_of(a->log->gates->memory, device->stimulus) >= 0);
    }
    find_states(a);
    find_fed(a);
    find_scales(a);
}
