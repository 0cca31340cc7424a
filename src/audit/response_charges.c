/* response_charges.c - charges of small signals where a switch or a diode without resistance closes.
 *
 * Capacitors that it joins are at one voltage in an orbit that has come to rest, and a small signal leaves them at others:
 * then charge passes in no time, and no voltage is what it was before. What is kept is the charge of nodes that hang together
 * by what an impulse may pass. A capacitor that nothing joins is such a set on its own, and keeps its voltage. */
#include "response_internal.h"

#include "union_find.h"

bool response_may_join(const struct dalcs_response_audit *a, const struct dalcs_response_event *e) {
    bool may = false;
    for (int d = 0; d < a->circuit->n_devices && !may; d++) {
        const struct dalcs_device *device = &a->circuit->device[d];
        may = e->changes[d] > 0 && response_is_two_sided(device) &&
              dalcs_device_ron(a->circuit, device) == 0.0;
    }
    return may;
}

static bool is_coupled(const struct dalcs_circuit *c, int device) {
    bool is = false;
    for (int k = 0; k < c->n_couplings && !is; k++) {
        is = c->coupling[k].inductor[0] == device || c->coupling[k].inductor[1] == device;
    }
    return is;
}

/* A straight one. */
static bool is_capacitor(const struct dalcs_response_audit *a, int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    return a->of.are_there[device] && d->kind == DALCS_CAPACITOR && !d->is_storage;
}

/* May an impulse of current be in the device? */
static bool may_pass(const struct dalcs_response_audit *a, const struct dalcs_response_event *e,
                     int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    if (response_is_two_sided(d)) {
        return response_may_be_free(a, e, device, RESPONSE_WIRE);
    }
    switch (d->kind) {
    case DALCS_CAPACITOR:
    case DALCS_ISOURCE:
        return false;
    case DALCS_RESISTOR:
        return dalcs_device_is_short(d);
    case DALCS_INDUCTOR: /* of an ideal transformer, too */
        return is_coupled(a->circuit, device);
    case DALCS_VCCS:
        return d->behaviour != NULL;
    default:
        return true;
    }
}

static void add_charge(struct dalcs_response_audit *a, int node, double complex charge,
                       double allowed, double farad) {
    struct response_node *n = &a->work.node[dalcs_union_find(a->work.cluster, node)];
    n->sum += charge;
    n->scale += allowed;
    n->size += farad;
}

/* Into the sets of both ends. */
static void gather(struct dalcs_response_audit *a, int device, const struct response_gain *gain) {
    const struct dalcs_device *d = &a->circuit->device[device];
    for (int end = 0; end < 2; end++) {
        const double sign = end == 0 ? d->value : -d->value;
        add_charge(a, d->node[end], sign * gain[device].off, d->value * gain[device].allowed,
                   d->value);
    }
}

void response_part_nodes(struct dalcs_response_audit *a) {
    dalcs_union_reset(a->work.cluster, a->circuit->n_nodes);
    for (int n = 0; n < a->circuit->n_nodes; n++) {
        a->work.node[n] = (struct response_node){0};
    }
}

void response_check_charges(struct dalcs_response_audit *a, const struct dalcs_response_event *e,
                            const struct response_gain *gain) {
    const struct dalcs_circuit *c = a->circuit;
    response_part_nodes(a);
    for (int d = 0; d < c->n_devices; d++) {
        if (!a->of.are_there[d] || may_pass(a, e, d)) {
            dalcs_union_join(a->work.cluster, c->device[d].node[0], c->device[d].node[1]);
        }
    }
    for (int d = 0; d < c->n_devices; d++) {
        if (is_capacitor(a, d)) {
            gather(a, d, gain);
        }
    }
    for (int d = 0; d < c->n_devices; d++) { /* told by each capacitor of a set */
        const struct dalcs_device *device = &c->device[d];
        for (int end = 0; end < 2 && is_capacitor(a, d); end++) {
            const int root = dalcs_union_find(a->work.cluster, device->node[end]);
            const struct response_node *n = &a->work.node[root];
            if (root != dalcs_union_find(a->work.cluster, 0)) {
                response_found(a, DALCS_RESPONSE_STATE, d, response_magnitude(n->sum) / n->size,
                               n->scale / n->size);
            }
        }
    }
}
