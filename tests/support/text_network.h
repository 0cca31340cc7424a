/* text_network.h - from netlist text to the systems that a test looks at. */
#ifndef DALCS_TEXT_NETWORK_H
#define DALCS_TEXT_NETWORK_H

#include "circuit.h"
#include "netlist.h"
#include "network.h"
#include "osnsp.h"

#include <string.h>

struct text_network {
    struct dalcs_diag diag;
    struct dalcs_circuit circuit;
    struct dalcs_network network;
};

/* Finish it whatever the result. */
static inline enum dalcs_status text_network_build(struct text_network *t, const char *text) {
    *t = (struct text_network){0};
    struct dalcs_netlist netlist = {0};
    enum dalcs_status status =
        dalcs_netlist_read_text(&netlist, "test.cir", text, strlen(text), &t->diag);
    if (status == DALCS_OK) {
        status = dalcs_circuit_build(&t->circuit, &netlist, &t->diag);
    }
    dalcs_netlist_finish(&netlist);
    if (status == DALCS_OK) {
        status = dalcs_network_build(&t->network, &t->circuit, &(struct dalcs_network_options){0},
                                     &t->diag);
    }
    return status;
}

static inline void text_network_finish(struct text_network *t) {
    dalcs_network_finish(&t->network);
    dalcs_circuit_finish(&t->circuit);
    dalcs_diag_finish(&t->diag);
}

/* u[n_x + n_inputs] of a system at t = 0: the IC= of its states, the DC values of its sources. */
static inline void text_network_inputs(const struct text_network *t, int system, double *u) {
    const struct dalcs_system *s = &t->network.system[system];
    memcpy(u, t->network.initial[system], (size_t)s->n_x * sizeof(*u));
    u[s->n_x] = 1.0;
    for (int k = 1; k < s->n_inputs; k++) {
        u[s->n_x + k] =
            dalcs_stimulus_value(&t->circuit.stimulus[s->stimulus[k]], 0.0, DALCS_RIGHT);
    }
}

/* The options a user gets. */
static inline struct dalcs_osnsp_options usual_osnsp_options(void) {
    const struct dalcs_run_options o = dalcs_run_options_default();
    return dalcs_osnsp_options_of(&o);
}

#endif
