/* session_told.c - what a session is told before it reads a netlist. */
#include "session_internal.h"

#include "draws.h"
#include "expand.h"

#include <math.h>
#include <string.h>

enum dalcs_status dalcs_session_set_dialect(struct dalcs_session *session, const char *name) {
    struct dalcs_dialect dialect = {DALCS_DIALECT_UNKNOWN, name != NULL};
    if (session->name != NULL) {
        return DALCS_E_OPTION; /* it is read */
    }
    if (name != NULL && !dalcs_dialect_find(name, &dialect.name)) {
        dalcs_diag_add(&session->diag, DALCS_ERROR, NULL, DALCS_DIALECTS, "unknown dialect '%s'",
                       name);
        return DALCS_E_OPTION;
    }
    session->dialect = dialect;
    return DALCS_OK;
}

enum dalcs_status dalcs_session_set_seed(struct dalcs_session *session, double seed) {
    if (session->name != NULL) {
        return DALCS_E_OPTION; /* it is read */
    }
    if (!(seed >= 0.0 && seed <= DALCS_MOST_SEED) || seed != (double)(uint64_t)seed) {
        dalcs_diag_add(&session->diag, DALCS_ERROR, NULL, NULL,
                       "a seed is a whole number from 0 to 2^53, not %.17g", seed);
        return DALCS_E_OPTION;
    }
    session->asks.seed = (uint64_t)seed;
    session->asks.has_seed = true;
    return DALCS_OK;
}

double dalcs_session_seed(const struct dalcs_session *session) {
    return session->source.has_netlist ? dalcs_deck_seed(&session->source.netlist) : 1.0;
}

enum dalcs_status dalcs_session_ask_losses(struct dalcs_session *session, double from, double to) {
    if (session->name != NULL) {
        return DALCS_E_OPTION; /* it is read */
    }
    session->asks.losses = (struct dalcs_losses_request){true, !isnan(from), from, to};
    return DALCS_OK;
}

enum dalcs_status dalcs_session_ask_steady(struct dalcs_session *session) {
    if (session->name != NULL) {
        return DALCS_E_OPTION; /* it is read */
    }
    session->asks.steady = true;
    return DALCS_OK;
}

enum dalcs_status dalcs_session_ask_response(struct dalcs_session *session) {
    session->asks.response = session->name == NULL;
    return dalcs_session_ask_steady(session);
}

enum dalcs_status dalcs_session_ask_sensitivities(struct dalcs_session *session) {
    session->asks.sensitivities = session->name == NULL;
    return dalcs_session_ask_steady(session);
}

enum dalcs_status dalcs_session_set_transient(struct dalcs_session *session, const char *times,
                                              const char *stop) {
    if (session->name != NULL) {
        return DALCS_E_OPTION; /* it is read */
    }
    session->asks.transient =
        times != NULL ? dalcs_arena_copy(&session->arena, times, strlen(times)) : NULL;
    session->asks.transient_stop =
        stop != NULL ? dalcs_arena_copy(&session->arena, stop, strlen(stop)) : NULL;
    const bool complete = (times == NULL || session->asks.transient != NULL) &&
                          (stop == NULL || session->asks.transient_stop != NULL);
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_session_keep_netlist(struct dalcs_session *session) {
    if (session->name != NULL) {
        return DALCS_E_OPTION; /* it is read */
    }
    session->source.keeps_netlist = true;
    return DALCS_OK;
}
