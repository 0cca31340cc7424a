/* spice_netlist.c - the circuit in ngspice's language, and where its signals are in the answer. */
#include "session_internal.h"

#include <string.h>

static enum dalcs_status choose_names(struct dalcs_session *s) {
    DALCS_TRY(dalcs_session_apply_values(s));
    return s->results.spice.circuit != NULL
               ? DALCS_OK
               : dalcs_spice_names_build(&s->results.spice, &s->circuit);
}

enum dalcs_status dalcs_session_write_spice(struct dalcs_session *session,
                                            const struct dalcs_spice_options *options,
                                            FILE *stream) {
    if (session->circuit.n_devices == 0) {
        dalcs_diag_add(&session->diag, DALCS_ERROR, NULL, NULL,
                       "a system given by its matrices is no circuit that ngspice could take");
        return DALCS_E_NETLIST;
    }
    DALCS_TRY(choose_names(session));
    return dalcs_spice_write(&session->results.spice, options, stream, &session->diag);
}

enum dalcs_status dalcs_session_spice_columns(struct dalcs_session *session, const char *signal,
                                              const char **plus, const char **minus) {
    DALCS_TRY(choose_names(session));
    for (int i = 0; i < session->circuit.results.n_signals; i++) {
        if (strcmp(session->circuit.results.signal[i].name, signal) == 0) {
            *plus = session->results.spice.column[i][0];
            *minus = session->results.spice.column[i][1];
            return DALCS_OK;
        }
    }
    return DALCS_E_OPTION;
}
