/* switch_warnings.c - switches that slid, and those that no command agreed with, in words. */
#include "pipeline.h"

/* Columns are computed row by row, from means of signals. */
static void warn_of_columns(struct dalcs_run *r) {
    const struct dalcs_circuit *c = &r->s->circuit;
    int k = 0;
    while (k < c->results.n_computed && c->results.computed[k].formula.is_affine) {
        k++;
    }
    if (k < c->results.n_computed) {
        dalcs_diag_add(&r->s->diag, DALCS_WARNING, NULL, ".meas avg and .losses have mean powers",
                       "'%s' is computed from these means: where a switch slides it is no mean of "
                       "what it is in both positions",
                       c->results.computed[k].name);
    }
}

/* Where no slide is sought, as with the method euler. */
static void warn_of_held(struct dalcs_run *r, const struct dalcs_component *c) {
    if (c->commands.n_held == 0 || c->commands.n_slid > 0) {
        return;
    }
    dalcs_diag_add(&r->s->diag, DALCS_WARNING, NULL,
                   "the method auto has the means of both sides; a hysteresis in its formula makes "
                   "it turn",
                   "in %ld step%s '%s' stands between its sides, and what reads it does not do so "
                   "in the mean: with a small delay they would go from side to side together, and "
                   "have other means than these values",
                   c->commands.n_held, c->commands.n_held == 1 ? "" : "s", c->commands.held);
}

void dalcs_run_warn_of_switches(struct dalcs_run *r, const struct dalcs_component *c, long steps) {
    warn_of_held(r, c);
    if (c->commands.n_slid > 0) {
        const bool has_switches = c->positions.n > 0;
        dalcs_diag_add(
            &r->s->diag, DALCS_WARNING, NULL,
            has_switches
                ? "a hysteresis, Vh=, keeps it from switching without end; .meas and .losses "
                  "have rms values and powers of the positions"
                : "a hysteresis in its formula keeps it from switching without end; .meas and "
                  ".losses have rms values and powers of both sides",
            "in %ld step%s %s; values are means of both %s, and rms "
            "values and products made of rows are those of means",
            c->commands.n_slid, c->commands.n_slid == 1 ? "" : "s",
            has_switches ? "a switch slides along its threshold: closing turns its control off, "
                           "opening turns it on"
                         : "a comparator slides along its threshold, and others read its output: "
                           "each side leads to the other one",
            has_switches ? "positions" : "sides");
        warn_of_columns(r);
    }
    if (c->commands.n_delayed == 0 || c->failure.restless.pair >= 0) { /* an error says it */
        return;
    }
    bool once = (steps == 0 && c->commands.n_delayed == 1) || c->is_static;
    if (once && c->commands.restless != NULL) {
        dalcs_diag_add(
            &r->s->diag, DALCS_WARNING, NULL,
            c->is_static ? NULL : "with uic, and IC= where it matters, a run starts without one",
            "at the operating point '%s' and what controls it do not agree: closed it "
            "opens, open it closes; it is left as it stood",
            c->commands.restless);
    } else {
        dalcs_diag_add(&r->s->diag, DALCS_WARNING, NULL,
                       "a hysteresis, Vh=, keeps it from switching without end",
                       "in %ld one-step problem%s a switch and the voltage that controls it did "
                       "not agree; its last command stood until the next one",
                       c->commands.n_delayed, c->commands.n_delayed == 1 ? "" : "s");
    }
}
