/* small_signal.c - .ac: small sinusoids around an operating point.
 *
 * The operating point says on which side each diode and switch stands, and there it stays. What is
 * left of (2.1) is linear, so amplitudes obey
 *     (j omega P_I - A_I) y = E_I s,   -A_II y = E_II s,   C y = -F s where w = 0, else lambda = 0
 * with the AC values of the sources as s: one sparse complex system for each frequency. */
#include "audit_response.h"
#include "gates.h"
#include "measures.h"
#include "orbit_analyses.h"
#include "small_signal_part.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NAMED = 12 };

struct small_signal {
    struct dalcs_run *run;
    struct dalcs_small_signal_part *part; /* [n_parts] */
    int n_parts;
    double *row; /* [2 n_outputs] */
    struct dalcs_measures measures;
    struct dalcs_response_columns *columns; /* [n_parts] for the audit */
    struct dalcs_audit_response audit;
};

/* ---- One frequency ------------------------------------------------------------------------------ */

static double probe(const struct small_signal *a, const struct dalcs_probe *probe, int which) {
    if (probe->system < 0) {
        return 0.0;
    }
    const struct dalcs_small_signal_part *part = &a->part[probe->system];
    return dalcs_probe_value(probe, part->y[which], part->s[which]);
}

/* The k-th. */
static enum dalcs_status solve_frequency(struct small_signal *a, int k, double frequency) {
    struct dalcs_run *r = a->run;
    const struct dalcs_network *network = &r->s->network;
    for (int p = 0; p < a->n_parts; p++) {
        const enum dalcs_status status =
            dalcs_small_signal_part_solve(&a->part[p], frequency, r->osnsp.rcond_min);
        if (status == DALCS_SINGULAR) {
            dalcs_diag_add(&r->s->diag, DALCS_ERROR, &r->s->circuit.analyses.ac.where,
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
    dalcs_measures_complex_row(&a->measures, frequency, a->row);
    DALCS_TRY(r->sink->row(r->sink->user, frequency, a->row));
    return dalcs_audit_response_look(&a->audit, k, frequency, a->row);
}

/* ---- The operating point ------------------------------------------------------------------------ */

/* Names the diodes that could as well stand on the other side. */
static enum dalcs_status warn_of_degenerate(struct dalcs_run *r,
                                            const struct dalcs_side_taken *side, size_t n) {
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
        dalcs_diag_add(&r->s->diag, DALCS_WARNING, &r->s->circuit.analyses.ac.where,
                       "give them a current or a reverse voltage at the operating point",
                       "at the operating point %zu diode%s neither current nor voltage; .ac takes "
                       "%s%s",
                       n_found, n_found == 1 ? " has" : "s have", list,
                       n_found > MOST_NAMED ? ", ..." : "");
    }
    return DALCS_OK;
}

/* Which side each pair is on, into the report. */
static enum dalcs_status report_sides(struct dalcs_run *r, struct dalcs_euler *e) {
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
    return warn_of_degenerate(r, side, n_sides);
}

static enum dalcs_status find_operating_point(struct dalcs_run *r, struct dalcs_euler *e,
                                              struct dalcs_logic_run *logic) {
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
    return status == DALCS_OK ? report_sides(r, e) : status;
}

/* ---- All frequencies ---------------------------------------------------------------------------- */

static enum dalcs_status walk(struct small_signal *a) {
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
    DALCS_TRY(dalcs_measures_start_rows(&a->measures, r, DALCS_MEASURED_AC, dalcs_sweep_value(f, 0),
                                        dalcs_sweep_value(f, f->n - 1)));
    for (int k = 0; k < f->n; k++) {
        DALCS_TRY(solve_frequency(a, k, dalcs_sweep_value(f, k)));
        DALCS_TRY(dalcs_run_progress(r, k + 1, f->n));
    }
    DALCS_TRY(dalcs_measures_report(&a->measures, r, DALCS_OK));
    return r->sink->end(r->sink->user);
}

static enum dalcs_status setup(struct small_signal *a, const struct dalcs_euler *e,
                               struct dalcs_logic_run *logic) {
    struct dalcs_session *s = a->run->s;
    const struct dalcs_solved_point point = {
        .circuit = &s->circuit, .network = &s->network, .euler = e, .logic = logic};
    a->part = dalcs_alloc((size_t)e->n_components, sizeof *a->part);
    a->row = dalcs_alloc(2 * (size_t)a->run->s->network.n_outputs, sizeof *a->row);
    a->columns = dalcs_alloc((size_t)e->n_components, sizeof *a->columns);
    if (a->part == NULL || a->row == NULL || a->columns == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < e->n_components; k++) {
        a->n_parts = k + 1;
        const enum dalcs_status status =
            dalcs_small_signal_part_setup(&a->part[k], &e->component[k]);
        if (status == DALCS_SINGULAR) {
            dalcs_diag_add(&a->run->s->diag, DALCS_ERROR, &a->run->s->circuit.analyses.ac.where,
                           NULL,
                           "the circuit around its operating point has no unique response at any "
                           "frequency");
        }
        DALCS_TRY(status);
        a->columns[k] = (struct dalcs_response_columns){{a->part[k].y[0], a->part[k].y[1]}};
    }
    return dalcs_audit_response_start(&a->audit, a->run, &point, a->columns,
                                      s->circuit.analyses.ac.n);
}

enum dalcs_status dalcs_small_signal_run(struct dalcs_run *r) {
    struct small_signal a = {.run = r};
    struct dalcs_euler e;
    struct dalcs_logic_run logic; /* whose outputs the sources show as long as it is there */
    DALCS_TRY(dalcs_commanded_ac_refuse(r));
    DALCS_TRY(dalcs_euler_setup(&e, &r->s->circuit, &r->s->network, &r->osnsp, 1.0, 1.0));
    enum dalcs_status status = find_operating_point(r, &e, &logic);
    if (status == DALCS_OK) {
        status = setup(&a, &e, &logic);
    }
    if (status == DALCS_OK) {
        status = walk(&a);
    }
    for (int k = 0; k < a.n_parts; k++) {
        dalcs_small_signal_part_finish(&a.part[k]);
    }
    dalcs_audit_response_finish(&a.audit);
    dalcs_measures_finish(&a.measures);
    free(a.part);
    free(a.row);
    free(a.columns);
    dalcs_run_add_work(r, &e);
    dalcs_logic_run_finish(&logic);
    dalcs_euler_finish(&e);
    return status;
}
