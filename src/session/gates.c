/* gates.c - what is refused of logic, in words; and what samples read. */
#include "gates.h"

#include <stdlib.h>
#include <string.h>

/* Names on one line, the first few of them. */
static const char *list_moving(struct dalcs_run *r, const struct dalcs_logic_run *logic) {
    enum { MOST_NAMED = 12 };

    const char *all = NULL;
    int n = 0;
    for (int k = 0; k < logic->network.n; k++) {
        if (logic->network.moves[k] && n++ < MOST_NAMED) {
            const char *name = logic->network.gate[k].name;
            all = dalcs_arena_printf(&r->s->arena, "%s%s%s", all != NULL ? all : "",
                                     all != NULL ? ", " : "", name);
        }
    }
    return all == NULL ? "gates"
           : n <= MOST_NAMED
               ? all
               : dalcs_arena_printf(&r->s->arena, "%s and %d more", all, n - MOST_NAMED);
}

enum dalcs_status dalcs_refuse_gates(struct dalcs_run *r, const struct dalcs_logic_run *logic,
                                     double t) {
    const char *names = list_moving(r, logic);
    const struct dalcs_location *where = NULL;
    for (int k = 0; k < logic->network.n && where == NULL; k++) {
        where = logic->network.moves[k] ? &logic->network.gate[k].where : NULL;
    }
    dalcs_diag_add(&r->s->diag, DALCS_ERROR, where,
                   "give one of them a delay (Td=), or a comparator in the loop a hysteresis (Vh=)",
                   "at t = %.9g s a loop without delay does not settle: %s", t,
                   names == NULL ? "gates" : names);
    return DALCS_E_NETLIST;
}

enum dalcs_status dalcs_gates_operating_point(struct dalcs_euler *e, struct dalcs_logic_run *logic,
                                              bool sources_at_start) {
    const bool has_logic = logic != NULL && logic->circuit != NULL;
    bool changed = has_logic;
    for (int round = 0; changed && round <= logic->network.n; round++) {
        DALCS_TRY(dalcs_euler_operating_point(e, sources_at_start));
        DALCS_TRY(dalcs_logic_run_rest(logic, &changed));
    }
    return changed || !has_logic ? dalcs_euler_operating_point(e, sources_at_start) : DALCS_OK;
}

void dalcs_warn_of_restless_gates(struct dalcs_run *r, struct dalcs_logic_run *logic) {
    if (dalcs_logic_run_is_at_rest(logic)) {
        return;
    }
    const char *names = list_moving(r, logic);
    dalcs_diag_add(&r->s->diag, DALCS_WARNING, NULL, "a .tran shows how they go on",
                   "gates have no rest at the operating point: %s", names == NULL ? "" : names);
}

enum dalcs_status dalcs_check_gates(struct dalcs_run *r, enum dalcs_analysis analysis) {
    const struct dalcs_circuit *c = &r->s->circuit;
    const bool is_steady =
        analysis == DALCS_PERIODIC ? c->periodic.present || r->options->steady
        : analysis == DALCS_AC
            ? (c->ac.n > 0 && c->periodic.present) || r->options->bode
            : analysis == DALCS_TRANSIENT &&
                  (r->options->envelope ||
                   (c->transient.present && (c->transient.starts_steady || c->envelope.present)));
    const bool is_stepped =
        analysis == DALCS_TRANSIENT && c->transient.present && r->method == DALCS_METHOD_EULER;
    if (c->n_gates == 0 || (!is_steady && !is_stepped)) {
        return DALCS_OK;
    }
    dalcs_diag_add(&r->s->diag, DALCS_ERROR, &c->gate[0].where,
                   is_steady ? "a .tran that is long enough, and .meas over its last period"
                             : "leave method=euler out",
                   is_steady ? "gates and flip-flops ('%s') have states that no steady state is "
                               "looked for with"
                             : "gates and flip-flops ('%s') are decided by events, which implicit "
                               "Euler does not have",
                   c->gate[0].name);
    return DALCS_E_NETLIST;
}

enum dalcs_status dalcs_gate_samples_setup(struct dalcs_gate_samples *s,
                                           const struct dalcs_logic_run *logic) {
    *s = (struct dalcs_gate_samples){0};
    if (logic->n_samples == 0) {
        return DALCS_OK;
    }
    const struct dalcs_circuit *circuit = logic->circuit;
    int *output = dalcs_alloc((size_t)logic->n_samples, sizeof(*output));
    if (output == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < logic->n_samples; k++) {
        output[k] = circuit->measured[circuit->gate[logic->sample[k]].sampled];
    }
    const enum dalcs_status status =
        dalcs_rows_setup(&s->rows, logic->radau, output, logic->n_samples);
    s->are_there = status == DALCS_OK;
    free(output);
    return status;
}

enum dalcs_status dalcs_gate_samples_read(struct dalcs_gate_samples *s,
                                          struct dalcs_logic_run *logic, double t) {
    int n_done;
    if (!s->are_there) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_rows_fill(&s->rows, &t, 1, DALCS_LEFT, &n_done));
    for (int k = 0; k < logic->n_samples; k++) {
        logic->taken[logic->sample[k]] = s->rows.value[k].at[0];
    }
    return DALCS_OK;
}

void dalcs_gate_samples_finish(struct dalcs_gate_samples *s) {
    if (s->are_there) {
        dalcs_rows_finish(&s->rows);
    }
}
