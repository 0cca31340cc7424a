/* steady_from_rest.c - a second start of a search: rest, where the operating point has led to nothing.
 *
 * In the operating point no switch moves. The loop of a control is open there, and the output of its amplifier is the error
 * times a gain of thousands: its capacitors begin at kilovolts, and its integrator takes longer back than a search lasts.
 * From IC= and 0 it begins nearby. A steady state is one, whatever start has led to it. */
#include "steady_step.h"
#include "steady_verdict.h"

#include <string.h>

/* Periods of runs of the first searches from the operating point and from rest. A search from kilovolts goes on for thousands of
 * them. One from rest may leave a limit of its control first. */
enum { FEW = 1, SOME = 32 };

/* Behind a start that leads to nothing there is another one: no file has the problem at which it ended. */
static enum dalcs_status try_start(struct dalcs_steady *st, long most, bool *found, bool *endless) {
    const struct dalcs_run_options *options = st->run->options;
    struct dalcs_run_options silent = *options;
    silent.dump_path = NULL;
    st->run->options = &silent;
    dalcs_steady_limit_crowd(st, true);
    const enum dalcs_status status = dalcs_steady_search(st, most, found, endless);
    dalcs_steady_limit_crowd(st, false);
    st->run->options = options;
    return status;
}

/* From rest, of `most` periods. *found: one was. */
static enum dalcs_status search(struct dalcs_steady *st, long most, bool *found) {
    struct dalcs_session *s = st->run->s;
    const struct dalcs_diag_mark mark = dalcs_diag_mark(&s->diag);
    bool endless = false;
    st->has_point = false;
    st->crowd.work = 0.0; /* that of the other start says nothing of this one */
    s->circuit.analyses.transient.use_initial_conditions = true;
    const enum dalcs_status status = try_start(st, most, found, &endless);
    *found = status == DALCS_OK && *found;
    s->circuit.analyses.transient.use_initial_conditions = *found;
    if (status >= DALCS_OK || status == DALCS_E_NETLIST) { /* where gates do not settle it ends */
        dalcs_diag_forget(&s->diag, &mark);
        return DALCS_OK;
    }
    return status;
}

static void tell(struct dalcs_steady *st) {
    dalcs_diag_add(&st->run->s->diag, DALCS_NOTE, NULL, NULL,
                   "from the operating point no steady state was found; this one was found "
                   "from IC= and 0, as with uic");
}

enum dalcs_status dalcs_steady_search_early(struct dalcs_steady *st, bool *found, bool *endless) {
    struct dalcs_session *s = st->run->s;
    if (s->circuit.analyses.transient.use_initial_conditions) {
        return DALCS_OK;
    }
    const struct dalcs_diag_mark mark = dalcs_diag_mark(&s->diag);
    const enum dalcs_status status = try_start(st, FEW, found, endless);
    if (status < DALCS_OK || (status == DALCS_OK && (*found || *endless))) {
        return status;
    }
    if (status != DALCS_OK) { /* an integrator has no operating point where its loop is open */
        dalcs_diag_forget(&s->diag, &mark);
        *found = *endless = false;
    }
    DALCS_TRY(search(st, SOME, found));
    if (*found) {
        tell(st);
        return DALCS_OK;
    }
    st->has_point = false;
    st->crowd.work = 0.0;
    return DALCS_OK;
}

enum dalcs_status dalcs_steady_search_from_rest(struct dalcs_steady *st,
                                                const struct dalcs_steady_attractor *a,
                                                bool *found) {
    struct dalcs_session *s = st->run->s;
    struct dalcs_orbit_point last;
    if (s->circuit.analyses.transient.use_initial_conditions || a->kind == DALCS_STEADY_CHAOS) {
        return DALCS_OK;
    }
    const size_t size = (size_t)st->layout.n_x * sizeof(double);
    double *drift = dalcs_arena_alloc(&st->arena, (size_t)st->layout.n_x + 1, sizeof(double));
    if (drift == NULL || !dalcs_steady_make_point(st, &last)) {
        return DALCS_E_NOMEM;
    }
    memcpy(drift, st->kept.drift, size);
    dalcs_steady_copy_point(st, &last, &st->at);
    DALCS_TRY(search(st, DALCS_STEADY_PERIODS, found));
    if (*found) {
        tell(st);
        return DALCS_OK;
    }
    memcpy(st->kept.drift, drift, size);
    dalcs_steady_copy_point(st, &st->at, &last);
    st->has_point = true;
    const enum dalcs_status status = dalcs_steady_pass(st, 1, DALCS_STEADY_PLAIN);
    return status < DALCS_OK ? status : DALCS_OK;
}
