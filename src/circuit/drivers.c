/* drivers.c - which devices stand between a node and ground, in their order. Products of formulas look this up while they add
 * devices of their own; a search of all devices for each would take the square of the number of products. */
#include "drivers.h"

#include "builder.h"

#include <stdlib.h>

static bool make_room(struct dalcs_drivers *d, size_t n_nodes, size_t n_devices) {
    return dalcs_grow(&d->first, &d->first_capacity, n_nodes, sizeof *d->first) == DALCS_OK &&
           dalcs_grow(&d->last, &d->last_capacity, n_nodes, sizeof *d->last) == DALCS_OK &&
           dalcs_grow(&d->next, &d->next_capacity, n_devices, sizeof *d->next) == DALCS_OK;
}

int dalcs_drivers_first(struct dalcs_builder *builder, int node) {
    struct dalcs_drivers *d = &builder->formulas.drivers;
    const struct dalcs_circuit *c = builder->circuit;
    if (!make_room(d, (size_t)c->n_nodes, (size_t)c->n_devices)) {
        builder->out_of_memory = true;
        return -1;
    }
    for (; d->n_seen < c->n_devices; d->n_seen++) {
        const struct dalcs_device *device = &c->device[d->n_seen];
        const int at = device->node[0];
        if (device->node[1] != 0) {
            continue;
        }
        *(d->last[at] > 0 ? &d->next[d->last[at] - 1] : &d->first[at]) = d->n_seen + 1;
        d->last[at] = d->n_seen + 1;
    }
    return d->first[node] - 1;
}

int dalcs_drivers_next(const struct dalcs_builder *builder, int device) {
    return builder->formulas.drivers.next[device] - 1;
}

void dalcs_drivers_finish(struct dalcs_drivers *d) {
    free(d->first);
    free(d->last);
    free(d->next);
    *d = (struct dalcs_drivers){0};
}
