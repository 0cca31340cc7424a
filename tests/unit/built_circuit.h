/* built_circuit.h - nodes and signals of a circuit by their names. */
#ifndef BUILT_CIRCUIT_H
#define BUILT_CIRCUIT_H

#include "build_circuit.h"

static struct dalcs_circuit circuit;

static inline int node_named(const char *name) {
    for (int k = 0; k < circuit.n_nodes; k++) {
        if (strcmp(circuit.node_name[k], name) == 0) {
            return k;
        }
    }
    ck_abort_msg("no node %s", name);
    return -1;
}

static inline void check_signals(const char *const *name, int n) {
    ck_assert_int_eq(circuit.results.n_signals, n);
    for (int k = 0; k < n; k++) {
        ck_assert_str_eq(circuit.results.signal[k].name, name[k]);
    }
}

#endif
