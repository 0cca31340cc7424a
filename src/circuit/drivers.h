/* drivers.h - the devices from a node to ground. */
#ifndef DALCS_DRIVERS_H
#define DALCS_DRIVERS_H

#include <stddef.h>

struct dalcs_builder;

/* Zero-initialise. Devices by their number and 1: 0 is none. */
struct dalcs_drivers {
    int *first, *last; /* [n_nodes] */
    int *next;         /* [n_devices] of the same node */
    size_t first_capacity, last_capacity, next_capacity;
    int n_seen; /* devices that are listed: nodes of the others may still be changed */
};

/* The first device whose first node this is, and ground its second; -1: none. All elements are known, and those that
 * are added later come behind them. */
int dalcs_drivers_first(struct dalcs_builder *builder, int node);

/* The next one of the same node, -1: none. */
int dalcs_drivers_next(const struct dalcs_builder *builder, int device);

void dalcs_drivers_finish(struct dalcs_drivers *drivers);

#endif
