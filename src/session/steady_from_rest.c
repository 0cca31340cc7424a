/* steady_from_rest.c - a second start of a search: rest, where the operating point has led to nothing.
 *
 * In the operating point no switch moves. The loop of a control is open there, and the output of its amplifier is the error
 * times a gain of thousands: its capacitors begin at kilovolts, and its integrator takes longer back than a search lasts.
 * From IC= and 0 it begins nearby. A steady state is one, whatever start has led to it. */
#include "steady_step.h"
#include "steady_verdict.h"

/* *found: one was. */
static enum dalcs_status search(struct dalcs_steady *st, bool *found) {
    struct dalcs_session *s = st->run->s;
    const struct dalcs_diag_mark mark = dalcs_diag_mark(&s->diag);
    bool endless = false;
    st->has_point = false;
    s->circuit.analyses.transient.use_initial_conditions = true;
    dalcs_steady_limit_crowd(st, true);
    const enum dalcs_status status = dalcs_steady_search(st, found, &endless);
    dalcs_steady_limit_crowd(st, false);
    *found = status == DALCS_OK && *found;
    s->circuit.analyses.transient.use_initial_conditions = *found;
    if (status >= DALCS_OK || status == DALCS_E_NETLIST) { /* where gates do not settle it ends */
        dalcs_diag_forget(&s->diag, &mark);
        return DALCS_OK;
    }
    return status;
}

enum dalcs_status dalcs_steady_search_from_rest(struct dalcs_steady *st,
                                                const struct dalcs_steady_attractor *a,
                                                bool *found) {
    struct dalcs_session *s = st->run->s;
    struct dalcs_orbit_point last;
    if (s->circuit.analyses.transient.use_initial_conditions || a->kind == DALCS_STEADY_CHAOS) {
        return DALCS_OK;
    }
    if (!dalcs_steady_make_point(st, &last)) {
        return DALCS_E_NOMEM;
    }
    dalcs_steady_copy_point(st, &last, &st->at);
    DALCS_TRY(search(st, found));
    if (*found) {
        dalcs_diag_add(&s->diag, DALCS_NOTE, NULL, NULL,
                       "from the operating point no steady state was found; this one was found "
                       "from IC= and 0, as with uic");
        return DALCS_OK;
    }
    dalcs_steady_copy_point(st, &st->at, &last);
    st->has_point = true;
    const enum dalcs_status status = dalcs_steady_pass(st, 1, DALCS_STEADY_PLAIN);
    return status < DALCS_OK ? status : DALCS_OK;
}
