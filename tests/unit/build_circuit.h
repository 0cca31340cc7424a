/* build_circuit.h - for the tests: a circuit from text, and the messages about it. */
#ifndef DALCS_TEST_BUILD_CIRCUIT_H
#define DALCS_TEST_BUILD_CIRCUIT_H

#include "circuit.h"
#include "netlist.h"
#include "run_tests.h"

#include <string.h>

/* The netlist is gone when this returns: the circuit must not need it. */
static inline enum dalcs_status build_circuit(struct dalcs_circuit *circuit,
                                              struct dalcs_diag *diag, const char *text) {
    struct dalcs_netlist netlist = {0};
    *diag = (struct dalcs_diag){0};
    *circuit = (struct dalcs_circuit){0};
    enum dalcs_status status = dalcs_netlist_read_text(&netlist, "t.cir", text, strlen(text), diag);
    if (status == DALCS_OK) {
        status = dalcs_circuit_build(circuit, &netlist, diag);
    }
    dalcs_netlist_finish(&netlist);
    return status;
}

/* Builds what must be free of errors. */
static inline void build_good_circuit(struct dalcs_circuit *circuit, const char *text) {
    struct dalcs_diag diag;
    const enum dalcs_status status = build_circuit(circuit, &diag, text);
    for (size_t k = 0; k < diag.n; k++) {
        ck_assert_msg(diag.item[k].severity != DALCS_ERROR, "%s", diag.item[k].text);
    }
    ck_assert_int_eq(status, DALCS_OK);
    dalcs_diag_finish(&diag);
}

static inline const struct dalcs_device *device_named(const struct dalcs_circuit *circuit,
                                                      const char *name) {
    for (int k = 0; k < circuit->n_devices; k++) {
        if (strcmp(circuit->device[k].name, name) == 0) {
            return &circuit->device[k];
        }
    }
    ck_abort_msg("no device %s", name);
    return NULL;
}

#endif
