/* transient_start.c - where a transient starts: initial conditions, held voltages, the operating point, an orbit. */
#include "transient.h"

#include "delayed.h"
#include "gates.h"
#include "history.h"
#include "losses_run.h"
#include "steady.h"

#include <stdlib.h>
#include <string.h>

/* From x(0-), or from the operating point (NULL). */
static enum dalcs_status start_at(struct dalcs_euler *e, struct dalcs_radau *radau,
                                  double *const *initial) {
    if (radau == NULL) {
        return dalcs_euler_start(e, initial);
    }
    dalcs_radau_start(radau, initial);
    return DALCS_OK;
}

bool dalcs_sources_jump(const struct dalcs_circuit *circuit, double t) {
    bool jumps = false;
    for (int i = 0; i < circuit->n_stimuli && !jumps; i++) {
        jumps = dalcs_stimulus_jumps_at(&circuit->stimulus[i], t);
    }
    return jumps;
}

bool dalcs_transient_begins_with_a_jump(const struct dalcs_circuit *circuit,
                                        struct dalcs_radau *radau) {
    return dalcs_sources_jump(circuit, 0.0) ||
           (radau != NULL && dalcs_radau_commands_at_start(radau));
}

/* A hysteresis goes on from the operating point. */
static void take_over_switches(struct dalcs_euler *e, const struct dalcs_euler *held) {
    for (int k = 0; k < e->n_components; k++) {
        struct dalcs_component *c = &e->component[k];
        const struct dalcs_osnsp *before = &held->component[k].osnsp;
        for (int i = 0; i < c->switches.n; i++) {
            int d = c->switches.pair[i];
            dalcs_osnsp_command(&c->osnsp, d, dalcs_osnsp_is_on(before, d));
        }
    }
}

/* With gates at rest in it. The logic of the run goes on from there. */
static enum dalcs_status rest_held(struct dalcs_run *r, struct dalcs_euler *e,
                                   struct dalcs_euler *held, struct dalcs_logic_run *logic) {
    struct dalcs_logic_run at_rest;
    if (logic == NULL || logic->circuit == NULL) {
        const enum dalcs_status status = dalcs_euler_operating_point(held, true);
        take_over_switches(e, held);
        return status;
    }
    DALCS_TRY(dalcs_logic_run_setup(&at_rest, &r->s->circuit, held, NULL));
    enum dalcs_status status = dalcs_gates_operating_point(held, &at_rest, true);
    if (status == DALCS_OK) {
        bool changed;
        memcpy(logic->network.state, at_rest.network.state,
               (size_t)logic->network.n * sizeof(*logic->network.state));
        dalcs_logic_run_finish(&at_rest);
        take_over_switches(e, held);
        return dalcs_logic_run_rest(logic, true, &changed);
    }
    dalcs_logic_run_finish(&at_rest);
    return status;
}

/* What delayed sources put out first: their signals in the operating point; NULL: what the card says. */
static void remember(const struct dalcs_circuit *c, const struct dalcs_euler *held) {
    for (int k = 0; k < c->control.n_delayed; k++) {
        const struct dalcs_delayed *d = &c->control.delayed[k];
        const double before =
            held != NULL ? dalcs_gates_read_output(
                               held, &held->network->output[c->results.measured[d->signal]])
                         : d->initial;
        dalcs_history_start(d->history, before);
    }
}

/* The operating point of `clamped`, in which .ic are held; its states start the transient. */
static enum dalcs_status start_from(struct dalcs_run *r, struct dalcs_euler *e,
                                    struct dalcs_radau *radau, struct dalcs_logic_run *logic,
                                    const struct dalcs_network *clamped) {
    struct dalcs_session *s = r->s;
    struct dalcs_euler held;
    dalcs_delayed_rest(&s->circuit);
    DALCS_TRY(dalcs_euler_setup(&held, &s->circuit, clamped, &r->osnsp, 1.0, 1.0));
    r->nonunique.undetermined.clamped = clamped;
    held.listener.open_user = &r->nonunique.undetermined;
    held.listener.on_open = dalcs_undetermined_at;
    held.listener.on_operating_point = dalcs_held_coils_rest;
    double **initial = dalcs_alloc((size_t)held.n_components, sizeof(*initial));
    enum dalcs_status status = initial == NULL ? DALCS_E_NOMEM : rest_held(r, e, &held, logic);
    status = dalcs_explain_failure(r, &held, status);
    dalcs_run_add_work(r, &held);
    if (status == DALCS_OK) {
        remember(&s->circuit, &held);
        for (int k = 0; k < held.n_components; k++) {
            initial[k] = held.component[k].u; /* the same x: clamps add algebraic unknowns only */
        }
        status = start_at(e, radau, initial);
    }
    free(initial);
    dalcs_euler_finish(&held);
    return status;
}

/* By a network of its own. */
static enum dalcs_status start_from_clamps(struct dalcs_run *r, struct dalcs_euler *e,
                                           struct dalcs_radau *radau,
                                           struct dalcs_logic_run *logic) {
    struct dalcs_session *s = r->s;
    struct dalcs_network clamped;
    DALCS_TRY(dalcs_network_build(
        &clamped, &s->circuit,
        &(struct dalcs_network_options){.clamp_initial_conditions = true, .at_rest = true},
        &s->diag));
    enum dalcs_status status = start_from(r, e, radau, logic, &clamped);
    dalcs_network_finish(&clamped);
    return status;
}

enum dalcs_status dalcs_transient_start(struct dalcs_run *r, struct dalcs_euler *e,
                                        struct dalcs_radau *radau, struct dalcs_logic_run *logic,
                                        bool has_rows) {
    const struct dalcs_circuit *c = &r->s->circuit;
    if (r->orbit != NULL) {
        return dalcs_steady_start(r->orbit, e, radau, logic);
    }
    if (logic !=
        NULL) { /* nothing is solved yet: what latches read before an operating point is not there */
        bool changed;
        DALCS_TRY(
            dalcs_logic_run_rest(logic, c->analyses.transient.use_initial_conditions, &changed));
    }
    if (c->analyses.transient.use_initial_conditions) {
        remember(c, NULL);
        return start_at(e, radau, r->s->network.initial);
    }
    if (r->s->network.held != NULL) {
        return start_from(r, e, radau, logic, r->s->network.held);
    }
    if (c->n_initial_conditions > 0 || c->control.n_delayed > 0) {
        return start_from_clamps(r, e, radau, logic);
    }
    DALCS_TRY(dalcs_gates_operating_point(e, logic, true));
    if (has_rows && dalcs_transient_begins_with_a_jump(c, radau)) {
        DALCS_TRY(dalcs_recorder_before_start(&r->s->results.recorder, e));
        if (r->transient.losses != NULL) {
            dalcs_losses_run_before_start(r->transient.losses);
        }
    }
    return start_at(e, radau, NULL);
}
