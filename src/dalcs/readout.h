/* readout.h - every voltage and current of a circuit as columns of its systems, for who checks them. */
#ifndef DALCS_READOUT_H
#define DALCS_READOUT_H

#include "system.h"

struct dalcs_readout {
    int n_nodes, n_devices;
    int *node_column;   /* [n_nodes] in the system of the node; -1: 0 V */
    int *device_system; /* [n_devices] -1: in no equation */
    int *first_pair;    /* [n_devices] of a diode, a switch or a formula, -1: none */
    int *start; /* [n_devices + 1] the current of a device is the sum of term[start[d]] to before
                           term[start[d + 1]]; of V, L, D, S, E, H, B, and of C where it is an unknown */

    struct dalcs_readout_term {
        int column;
        double coefficient;
    } * term;
};

/* The current of a device from the columns y of its system. */
static inline double dalcs_readout_current(const struct dalcs_readout *r, int device,
                                           const double *y) {
    double current = 0.0;
    for (int k = r->start[device]; k < r->start[device + 1]; k++) {
        current += r->term[k].coefficient * y[r->term[k].column];
    }
    return current;
}

struct dalcs_layout;
struct dalcs_network;

/* network->readout, in the network's arena. */
enum dalcs_status dalcs_readout_build(struct dalcs_network *network,
                                      const struct dalcs_layout *layout) DALCS_MUST_CHECK;

#endif
