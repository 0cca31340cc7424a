/* cosimulation.c - the course of a run is interrupted at the times that the program asked for: it reads all signals as they
 * are just before, and what it gives is written into the stimuli of the external sources, as gates write what they show. */
#include "cosimulation.h"

#include "gates.h"
#include "logic_outputs.h"
#include "rows.h"

#include <math.h>
#include <stdlib.h>

static const struct dalcs_device *external_at(const struct dalcs_circuit *c, size_t index) {
    const struct dalcs_device *found = NULL;
    for (int d = 0; d < c->n_devices && found == NULL; d++) {
        const int stimulus = c->device[d].stimulus;
        if (stimulus >= 0 && c->stimulus[stimulus].is_external && index-- == 0) {
            found = &c->device[d];
        }
    }
    return found;
}

const char *dalcs_session_input_name(const struct dalcs_session *session, size_t index) {
    const struct dalcs_device *found = external_at(&session->circuit, index);
    return found != NULL ? found->name : NULL;
}

enum dalcs_status dalcs_session_couple(struct dalcs_session *session,
                                       enum dalcs_status (*exchange)(void *user,
                                                                     struct dalcs_exchange *e),
                                       void *user) {
    if (session->circuit.control.n_externals == 0) {
        dalcs_diag_add(&session->diag, DALCS_ERROR, NULL, "V1 in 0 EXTERNAL",
                       "the netlist has no external source");
        return DALCS_E_OPTION;
    }
    session->outside.exchange = exchange;
    session->outside.user = user;
    return DALCS_OK;
}

enum dalcs_status dalcs_cosimulation_check(const struct dalcs_run *r,
                                           enum dalcs_analysis analysis) {
    const struct dalcs_circuit *c = &r->s->circuit;
    const bool has_orbit =
        (analysis == DALCS_PERIODIC && (c->analyses.periodic.present || r->options->steady)) ||
        (analysis == DALCS_AC &&
         (r->options->bode || (c->analyses.ac.n > 0 && c->analyses.periodic.present))) ||
        (analysis == DALCS_TRANSIENT && (r->options->envelope || c->analyses.envelope.present ||
                                         c->analyses.transient.starts_steady));
    const bool is_tran = analysis == DALCS_TRANSIENT && c->analyses.transient.present && !has_orbit;
    if (c->control.n_externals == 0 ||
        (!has_orbit && (!is_tran || r->s->outside.exchange != NULL))) {
        return DALCS_OK;
    }
    const struct dalcs_device *first = external_at(c, 0);
    const struct dalcs_location *where = dalcs_place_of(c, first->name);
    if (is_tran) {
        dalcs_diag_add(&r->s->diag, DALCS_ERROR, where,
                       "run(netlist, exchange=...) in Python, dalcs_session_couple in C; or give "
                       "it a function of "
                       "its own in place of EXTERNAL",
                       "'%s' is external: its values come from a program that runs the netlist",
                       first->name);
    } else {
        dalcs_diag_add(
            &r->s->diag, DALCS_ERROR, where,
            "only a .tran and an operating point have external sources",
            "'%s' is external: what it will do is not known, and nothing periodic can be "
            "looked for",
            first->name);
    }
    return DALCS_E_NETLIST;
}

/* The program's turn. */
static enum dalcs_status call(struct dalcs_cosimulation *c, double t, const double *value) {
    struct dalcs_session *s = c->run->s;
    struct dalcs_exchange *e = &c->exchange;
    e->time = t;
    e->value = value;
    e->next = INFINITY;
    DALCS_TRY(s->outside.exchange(s->outside.user, e));
    if (!(e->next > t)) {
        dalcs_diag_add(
            &s->diag, DALCS_ERROR, NULL, "say when it is to be called again, or never: INFINITY",
            "the exchange at t = %.9g s asks for one at %.9g s, which is not later", t, e->next);
        return DALCS_E_OPTION;
    }
    for (int k = 0; k < c->inputs.n; k++) {
        if (!isfinite(c->given[k])) {
            dalcs_diag_add(&s->diag, DALCS_ERROR, NULL, NULL,
                           "the exchange at t = %.9g s gives '%s' the value %g", t, c->input[k],
                           c->given[k]);
            return DALCS_E_OPTION;
        }
        c->inputs.source[k].now = c->given[k];
    }
    c->inputs.next = e->next;
    c->inputs.is_given = true;
    return DALCS_OK;
}

static enum dalcs_status allocate(struct dalcs_cosimulation *c) {
    const struct dalcs_run *r = c->run;
    const struct dalcs_circuit *circuit = &r->s->circuit;
    const size_t n = (size_t)circuit->control.n_externals;
    const size_t n_signals = (size_t)circuit->results.n_shown;
    c->inputs.source = dalcs_alloc(n, sizeof(*c->inputs.source));
    c->input = dalcs_alloc(n, sizeof(*c->input));
    c->given = dalcs_alloc(n, sizeof(*c->given));
    c->value = dalcs_alloc(n_signals, sizeof(*c->value));
    if (c->inputs.source == NULL || c->input == NULL || c->given == NULL || c->value == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n; k++) {
        const struct dalcs_device *d = external_at(circuit, k);
        c->inputs.source[k].stimulus = d->stimulus;
        c->input[k] = d->name;
        c->given[k] = circuit->stimulus[d->stimulus].u.pwl.v[0];
    }
    c->inputs.n = (int)n;
    c->exchange = (struct dalcs_exchange){.n_signals = n_signals,
                                          .n_inputs = n,
                                          .name = r->signals.name,
                                          .input = c->input,
                                          .given = c->given};
    return DALCS_OK;
}

enum dalcs_status dalcs_cosimulation_start(struct dalcs_cosimulation *c, struct dalcs_run *r,
                                           struct dalcs_logic_run *logic) {
    c->inputs.next = INFINITY;
    if (r->s->circuit.control.n_externals == 0) {
        return DALCS_OK;
    }
    c->run = r;
    DALCS_TRY(allocate(c));
    DALCS_TRY(call(c, 0.0, NULL));
    logic->inputs = &c->inputs;
    return dalcs_logic_inputs_start(logic);
}

enum dalcs_status dalcs_cosimulation_ask(struct dalcs_cosimulation *c, double t,
                                         const struct dalcs_rows *rows,
                                         const struct dalcs_euler *e) {
    for (size_t k = 0; k < c->exchange.n_signals; k++) {
        c->value[k] = rows != NULL ? rows->value[k].at[0]
                                   : dalcs_gates_read_output(e, &c->run->s->network.output[k]);
    }
    (void)t; /* but for rounding the time that was asked for, which is the one that is told */
    return call(c, c->inputs.next, c->value);
}

bool dalcs_cosimulation_has_changed(const struct dalcs_cosimulation *c) {
    bool has = false;
    for (int k = 0; k < c->inputs.n; k++) {
        const struct dalcs_stimulus *s = &c->run->s->circuit.stimulus[c->inputs.source[k].stimulus];
        has = has || s->u.pwl.v[s->u.pwl.n - 1] != c->inputs.source[k].now;
    }
    return has;
}

void dalcs_cosimulation_finish(struct dalcs_cosimulation *c) {
    for (int k = 0; k < c->inputs.n; k++) {
        free(c->inputs.source[k].time);
        free(c->inputs.source[k].value);
    }
    free(c->inputs.source);
    free(c->input);
    free(c->value);
    free(c->given);
    *c = (struct dalcs_cosimulation){0};
}
