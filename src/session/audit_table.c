/* audit_table.c - a table of waveforms that anybody made under the laws of the session's circuit. */
#include "session_internal.h"

#include "file_audit.h"

#include <math.h>

/* SPICE's own reltol, vntol and abstol: what a simulator that was not asked for more promises of each signal. */
static const struct dalcs_file_promise spice = {
    .tolerance = 1e-3, .vntol = 1e-6, .abstol = 1e-12, .are_shorts_measured = true};

static enum dalcs_status refuse(struct dalcs_session *s, const char *what) {
    dalcs_diag_add(&s->diag, DALCS_ERROR, NULL, NULL, "%s", what);
    return DALCS_E_OPTION;
}

/* The circuit of a step of .step. */
static enum dalcs_status take_run(struct dalcs_session *s, size_t run) {
    struct dalcs_plot plot;
    if (run >= dalcs_steps_count(s)) {
        dalcs_diag_add(&s->diag, DALCS_ERROR, NULL, NULL,
                       "the file has a run number %zu, and the netlist has %zu", run + 1,
                       dalcs_steps_count(s));
        return DALCS_E_OPTION;
    }
    DALCS_TRY(dalcs_steps_find(s));
    return s->source.steps.n > 0 ? dalcs_session_take_step(s, run, &plot) : DALCS_OK;
}

enum dalcs_status dalcs_session_audit_table(struct dalcs_session *s,
                                            const struct dalcs_wave_table *table,
                                            const struct dalcs_table_audit_options *options,
                                            const struct dalcs_table_audit **result) {
    *result = NULL;
    DALCS_TRY(dalcs_session_apply_values(s));
    if (s->circuit.n_devices == 0) {
        return refuse(s,
                      "a system given by its matrices has no elements whose laws could be checked");
    }
    if (!(options->tolerance >= 0.0) || !isfinite(options->tolerance)) {
        return refuse(s, "the tolerance must be positive");
    }
    if (table->n_rows == 0 || table->n_columns < 2) {
        return refuse(s, "the file has no rows of signals");
    }
    DALCS_TRY(take_run(s, options->run));
    dalcs_arena_finish(&s->audited);
    struct dalcs_table_audit *audit = dalcs_arena_alloc(&s->audited, 1, sizeof *audit);
    if (audit == NULL) {
        return DALCS_E_NOMEM;
    }
    struct dalcs_file_promise promise = spice;
    promise.tolerance = options->tolerance > 0.0 ? options->tolerance : spice.tolerance;
    DALCS_TRY(dalcs_file_audit(&s->circuit, table, &promise, &s->audited, &s->diag, audit));
    audit->netlist = s->name;
    audit->title =
        s->circuit.title != NULL ? dalcs_arena_printf(&s->audited, "%s", s->circuit.title) : NULL;
    *result = audit;
    return DALCS_OK;
}
