/* response_fluxes.c - fluxes of small signals where a switch or a diode that is a cut opens.
 *
 * This is the dual of response_charges.c. Coils that then share a current have one current in an orbit that has come to rest,
 * and a small signal leaves them with others: then an impulse of voltage is across what opens, and no current is what it was
 * before. What is kept is the flux of each loop in which no such impulse can be. The integrals of the impulses are differences
 * of potentials of nodes, so that the gains of coils around such a loop add up to 0. A coil in a loop of its own keeps its
 * flux. */
#include "response_internal.h"

#include "union_find.h"

bool response_may_part(const struct dalcs_response_audit *a, const struct dalcs_response_event *e) {
    bool may = false;
    for (int d = 0; d < a->circuit->n_devices && !may; d++) {
        const struct dalcs_device *device = &a->circuit->device[d];
        may = e->changes[d] < 0 && response_is_two_sided(device) &&
              isinf(dalcs_device_roff(a->circuit, device));
    }
    return may;
}

/* May an impulse of voltage be across the device? */
static bool may_stand(const struct dalcs_response_audit *a, const struct dalcs_response_event *e,
                      int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    if (response_is_two_sided(d)) {
        return response_may_be_free(a, e, device, RESPONSE_CUT);
    }
    switch (d->kind) {
    case DALCS_INDUCTOR: /* one with a core, whose flux is not known here */
    case DALCS_ISOURCE:
    case DALCS_VCCS:
    case DALCS_CCCS:
    case DALCS_VCVS:
        return true;
    case DALCS_CCVS:
        return d->behaviour != NULL;
    default: /* they have voltages without impulses as long as currents have none */
        return false;
    }
}

/* The root of a node; *between is the flux between the two, with what is allowed and the inductance. node[n] has that between
 * n and its parent. */
static int find_root(struct dalcs_response_audit *a, int n, struct response_node *between) {
    *between = (struct response_node){0};
    while (a->work.cluster[n] != n) {
        struct response_node *step = &a->work.node[n];
        const int up = a->work.cluster[n];
        if (a->work.cluster[up] != up) {
            step->sum += a->work.node[up].sum;
            step->scale += a->work.node[up].scale;
            step->size += a->work.node[up].size;
            a->work.cluster[n] = a->work.cluster[up];
        }
        between->sum += step->sum;
        between->scale += step->scale;
        between->size += step->size;
        n = a->work.cluster[n];
    }
    return n;
}

/* A coil joins two sets of nodes, or it closes a loop. */
static void add_coil(struct dalcs_response_audit *a, int device, const struct response_gain *gain) {
    const struct dalcs_device *d = &a->circuit->device[device];
    struct response_node end[2];
    const int root[2] = {find_root(a, d->node[0], &end[0]), find_root(a, d->node[1], &end[1])};
    const struct response_node whole = {.sum = gain->off - end[0].sum + end[1].sum,
                                        .scale = gain->allowed + end[0].scale + end[1].scale,
                                        .size = d->value + end[0].size + end[1].size};
    if (root[0] != root[1]) {
        a->work.cluster[root[0]] = root[1];
        a->work.node[root[0]] = whole;
    } else {
        response_found(a, DALCS_RESPONSE_STATE, device, response_magnitude(whole.sum) / whole.size,
                       whole.scale / whole.size);
    }
}

void response_check_fluxes(struct dalcs_response_audit *a, const struct dalcs_response_event *e,
                           const struct response_gain *gain) {
    const struct dalcs_circuit *c = a->circuit;
    response_part_nodes(a);
    for (int d = 0; d < c->n_devices; d++) {
        if (a->of.are_there[d] && !response_is_coil(a, d) && !may_stand(a, e, d)) {
            dalcs_union_join(a->work.cluster, c->device[d].node[0], c->device[d].node[1]);
        }
    }
    for (int d = 0; d < c->n_devices; d++) {
        if (response_is_coil(a, d)) {
            add_coil(a, d, &gain[d]);
        }
    }
}
