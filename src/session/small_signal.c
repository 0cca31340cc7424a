/* small_signal.c - .ac: small sinusoids around an operating point.
 *
 * The operating point says on which side each diode and switch stands, and there it stays. What is
 * left of (2.1) is linear, so amplitudes obey
 *     (j omega P_I - A_I) y = E_I s,   -A_II y = E_II s,   C y = -F s where w = 0, else lambda = 0
 * with the AC values of the sources as s: one sparse complex system for each frequency. */
#include "small_signal.h"

#include "measures.h"
#include "orbit_analyses.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NAMED = 12 };

/* ---- One frequency ------------------------------------------------------------------------------ */

static double probe(const struct dalcs_small_signal *a, const struct dalcs_probe *probe,
                    int which) {
    if (probe->system < 0) {
        return 0.0;
    }
    const struct dalcs_small_signal_part *part = &a->part[probe->system];
    return dalcs_probe_value(probe, part->y[which], part->s[which]);
}

enum dalcs_status dalcs_small_signal_solve(struct dalcs_small_signal *a, double frequency) {
    struct dalcs_run *r = a->run;
    const struct dalcs_network *network = &r->s->network;
    for (int p = 0; p < a->n_parts; p++) {
        const enum dalcs_status status =
            dalcs_small_signal_part_solve(&a->part[p], frequency, r->osnsp.rcond_min);
        if (status == DALCS_SINGULAR) {
            dalcs_diag_add(&r->s->diag, DALCS_ERROR, a->where,
                           "an undamped resonance at this frequency, or a loop of conducting ideal "
                           "diodes or closed switches; a resistance in it makes it one",
                           "at %.9g Hz the response is not unique", frequency);
        }
        DALCS_TRY(status);
    }
    for (int i = 0; i < network->n_outputs; i++) {
        const struct dalcs_output *out = &network->output[i];
        for (int which = 0; which < 2; which++) {
            a->row[2 * i + which] = probe(a, &out->plus, which) - probe(a, &out->minus, which);
        }
    }
    return DALCS_OK;
}

/* ---- The operating point ------------------------------------------------------------------------ */

/* Names the diodes that could as well stand on the other side. */
static enum dalcs_status warn_of_degenerate(const struct dalcs_small_signal *a,
                                            const struct dalcs_side_taken *side, size_t n) {
    struct dalcs_run *r = a->run;
    struct dalcs_arena *arena = &r->s->arena;
    const char *list = "";
    size_t n_found = 0;
    for (size_t k = 0; k < n; k++) {
        if (side[k].degenerate && n_found++ < MOST_NAMED) {
            list = dalcs_arena_printf(arena, "%s%s%s as %s", list, n_found > 1 ? ", " : "",
                                      side[k].element, side[k].on ? "conducting" : "blocking");
            if (list == NULL) {
                return DALCS_E_NOMEM;
            }
        }
    }
    if (n_found > 0) {
        dalcs_diag_add(&r->s->diag, DALCS_WARNING, a->where,
                       "give them a current or a reverse voltage at the operating point",
                       "at the operating point %zu diode%s neither current nor voltage; %s takes "
                       "%s%s",
                       n_found, n_found == 1 ? " has" : "s have", a->card, list,
                       n_found > MOST_NAMED ? ", ..." : "");
    }
    return DALCS_OK;
}

/* Which side each pair is on, into the report. */
static enum dalcs_status report_sides(const struct dalcs_small_signal *a, struct dalcs_euler *e) {
    struct dalcs_run *r = a->run;
    size_t n = 0;
    for (int k = 0; k < e->n_components; k++) {
        n += (size_t)e->component[k].system->n_pairs;
    }
    struct dalcs_side_taken *side = dalcs_arena_alloc(&r->s->arena, n, sizeof *side);
    if (side == NULL) {
        return DALCS_E_NOMEM;
    }
    size_t n_sides = 0;
    for (int k = 0; k < e->n_components; k++) {
        struct dalcs_component *c = &e->component[k];
        double scale[2];
        dalcs_osnsp_find_ties(&c->osnsp, c->u, c->y, scale);
        for (int d = 0; d < c->system->n_pairs; d++) {
            const struct dalcs_pair *pair = &c->system->pair[d];
            const bool on = dalcs_osnsp_is_on(&c->osnsp, d);
            if (!pair->is_breakdown || on) {
                const bool is_diode = pair->kind == DALCS_PAIR_DIODE;
                side[n_sides++] = (struct dalcs_side_taken){pair->element, on,
                                                            is_diode && c->osnsp.signs.tied[d]};
            }
        }
    }
    r->s->results.report.n_sides = n_sides;
    r->s->results.report.side = side;
    return warn_of_degenerate(a, side, n_sides);
}

enum dalcs_status dalcs_small_signal_find_point(const struct dalcs_small_signal *a,
                                                struct dalcs_euler *e,
                                                struct dalcs_logic_run *logic) {
    struct dalcs_run *r = a->run;
    e->listener.open_user = &r->nonunique.undetermined;
    e->listener.on_open = dalcs_undetermined_at;
    enum dalcs_status status = dalcs_logic_run_setup(logic, &r->s->circuit, e, NULL);
    if (status == DALCS_OK) {
        status = dalcs_gates_operating_point(e, logic, false);
        dalcs_warn_of_restless_gates(r, logic);
    }
    if (status == DALCS_OK) {
        e->failure.at_operating_point = true;
        status = dalcs_undetermined_several(&r->nonunique.undetermined, e, 0.0);
        e->failure.at_operating_point = false;
    }
    status = dalcs_explain_failure(r, e, status);
    return status == DALCS_OK ? report_sides(a, e) : status;
}

/* ---- The matrices -------------------------------------------------------------------------------- */

enum dalcs_status dalcs_small_signal_setup(struct dalcs_small_signal *a,
                                           const struct dalcs_euler *e,
                                           struct dalcs_logic_run *logic, int n) {
    struct dalcs_session *s = a->run->s;
    const struct dalcs_solved_point point = {
        .circuit = &s->circuit, .network = &s->network, .euler = e, .logic = logic};
    a->part = dalcs_alloc((size_t)e->n_components, sizeof *a->part);
    a->row = dalcs_alloc(2 * (size_t)s->network.n_outputs, sizeof *a->row);
    a->column = dalcs_alloc((size_t)e->n_components, sizeof *a->column);
    if (a->part == NULL || a->row == NULL || a->column == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < e->n_components; k++) {
        a->n_parts = k + 1;
        const enum dalcs_status status =
            dalcs_small_signal_part_setup(&a->part[k], &e->component[k]);
        if (status == DALCS_SINGULAR) {
            dalcs_diag_add(&s->diag, DALCS_ERROR, a->where, NULL,
                           "the circuit around its operating point has no unique response at any "
                           "frequency");
        }
        DALCS_TRY(status);
        a->column[k] = (struct dalcs_response_columns){{a->part[k].y[0], a->part[k].y[1]}};
    }
    return dalcs_audit_response_start(&a->audit, a->run, &point, a->column, n);
}

void dalcs_small_signal_finish(struct dalcs_small_signal *a) {
    for (int k = 0; k < a->n_parts; k++) {
        dalcs_small_signal_part_finish(&a->part[k]);
    }
    dalcs_audit_response_finish(&a->audit);
    free(a->part);
    free(a->row);
    free(a->column);
    a->n_parts = 0;
    a->part = NULL;
    a->row = NULL;
    a->column = NULL;
}

/* ---- All frequencies of .ac ---------------------------------------------------------------------- */

static enum dalcs_status walk(struct dalcs_small_signal *a, struct dalcs_measures *measures) {
    struct dalcs_run *r = a->run;
    const struct dalcs_sweep *f = &r->s->circuit.analyses.ac;
    DALCS_TRY(dalcs_run_announce(
        r, &(struct dalcs_plot){.analysis = DALCS_AC,
                                .scale = "frequency",
                                .scale_unit = DALCS_UNIT_HERTZ,
                                .n_signals = (size_t)r->s->circuit.results.n_shown,
                                .name = r->signals.name,
                                .unit = r->signals.unit,
                                .is_complex = true}));
    DALCS_TRY(dalcs_measures_start_rows(measures, r, DALCS_MEASURED_AC, dalcs_sweep_value(f, 0),
                                        dalcs_sweep_value(f, f->n - 1)));
    for (int k = 0; k < f->n; k++) {
        const double frequency = dalcs_sweep_value(f, k);
        DALCS_TRY(dalcs_small_signal_solve(a, frequency));
        dalcs_measures_complex_row(measures, frequency, a->row);
        DALCS_TRY(r->sink->row(r->sink->user, frequency, a->row));
        DALCS_TRY(dalcs_audit_response_look(&a->audit, k, frequency, a->row));
        DALCS_TRY(dalcs_run_progress(r, k + 1, f->n));
    }
    DALCS_TRY(dalcs_measures_report(measures, r, DALCS_OK));
    return r->sink->end(r->sink->user);
}

enum dalcs_status dalcs_small_signal_run(struct dalcs_run *r) {
    const struct dalcs_sweep *f = &r->s->circuit.analyses.ac;
    struct dalcs_small_signal a = {.run = r, .card = ".ac", .where = &f->where};
    struct dalcs_measures measures = {0};
    struct dalcs_euler e;
    struct dalcs_logic_run logic; /* whose outputs the sources show as long as it is there */
    DALCS_TRY(dalcs_commanded_ac_refuse(r));
    DALCS_TRY(dalcs_euler_setup(&e, &r->s->circuit, &r->s->network, &r->osnsp, 1.0, 1.0));
    enum dalcs_status status = dalcs_small_signal_find_point(&a, &e, &logic);
    if (status == DALCS_OK) {
        status = dalcs_small_signal_setup(&a, &e, &logic, f->n);
    }
    if (status == DALCS_OK) {
        status = walk(&a, &measures);
    }
    dalcs_small_signal_finish(&a);
    dalcs_measures_finish(&measures);
    dalcs_run_add_work(r, &e);
    dalcs_logic_run_finish(&logic);
    dalcs_euler_finish(&e);
    return status;
}
