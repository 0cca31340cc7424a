/* delayed.c - transmission lines and delay() need what was before: a .tran of controlled steps has it. */
#include "delayed.h"

#include "history.h"

void dalcs_delayed_rest(const struct dalcs_circuit *circuit) {
    for (int k = 0; k < circuit->control.n_delayed; k++) {
        dalcs_history_start(circuit->control.delayed[k].history, 0.0);
    }
}

static bool asks_orbit(const struct dalcs_run *r) {
    const struct dalcs_circuit *c = &r->s->circuit;
    return c->analyses.periodic.present || r->options->steady || r->options->bode ||
           r->options->envelope || c->analyses.envelope.present ||
           c->analyses.transient.starts_steady;
}

enum dalcs_status dalcs_delayed_check(const struct dalcs_run *r, enum dalcs_analysis analysis) {
    const struct dalcs_circuit *c = &r->s->circuit;
    const bool is_response = (analysis == DALCS_AC && c->analyses.ac.n > 0) ||
                             (analysis == DALCS_TRANSFER && c->analyses.transfer.present) ||
                             asks_orbit(r);
    const bool is_sweep = analysis == DALCS_DC_SWEEP && c->analyses.n_dc > 0;
    const bool is_fixed = analysis == DALCS_TRANSIENT && c->analyses.transient.present &&
                          (r->method == DALCS_METHOD_EULER || r->radau.fixed_step > 0.0);
    if (c->control.n_delayed == 0 || !(is_response || is_sweep || is_fixed)) {
        return DALCS_OK;
    }
    dalcs_diag_add(&r->s->diag, DALCS_ERROR, NULL,
                   is_fixed ? "leave out the method and the step"
                            : "a .tran and an operating point have delays; ten sections of "
                              "L = Z0 TD/10 and C = TD/(10 Z0) are a line without",
                   "'%s' is a delay: %s", c->control.delayed[0].name,
                   is_fixed      ? "fixed steps do not keep what was before"
                   : is_response ? "responses and steady states with delays are not computed"
                                 : "operating points with delays are not swept");
    return DALCS_E_NETLIST;
}
