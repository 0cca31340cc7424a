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
    bool has_latch = false;
    for (int k = 0; k < logic->network.n; k++) {
        where = where == NULL && logic->network.moves[k] ? &logic->network.gate[k].where : where;
        has_latch = has_latch ||
                    (logic->network.moves[k] && logic->network.gate[k].kind == DALCS_GATE_LATCH);
    }
    const char *hint =
        has_latch
            ? "its S is still high while what it switches sets and clears its R: let the "
              "pulse at S end earlier, or give the flip-flop a delay (Td=), or the "
              "comparator at R a hysteresis (Vh=)"
            : "give one of them a delay (Td=), or a comparator in the loop a hysteresis (Vh=)";
    dalcs_diag_add(&r->s->diag, DALCS_ERROR, where, hint,
                   "at t = %.9g s a loop without delay does not settle: %s", t,
                   names == NULL ? "gates" : names);
    return DALCS_E_NETLIST;
}

enum dalcs_status dalcs_gates_operating_point(struct dalcs_euler *e, struct dalcs_logic_run *logic,
                                              bool sources_at_start) {
    const bool has_logic = logic != NULL && logic->circuit != NULL;
    bool changed = has_logic;
    for (int round = 0; changed && round <= 2 * logic->network.n + 1; round++) {
        const bool oscillates = round > logic->network.n; /* memory may end it */
        DALCS_TRY(dalcs_euler_operating_point(e, sources_at_start));
        DALCS_TRY(dalcs_logic_run_rest(logic, oscillates, &changed));
        if (!changed && !oscillates) { /* what is on its way to a latch has come */
            DALCS_TRY(dalcs_logic_run_rest(logic, true, &changed));
        }
    }
    return changed || !has_logic ? dalcs_euler_operating_point(e, sources_at_start) : DALCS_OK;
}

void dalcs_warn_of_restless_gates(struct dalcs_run *r, struct dalcs_logic_run *logic) {
    if (dalcs_logic_run_is_at_rest(logic)) {
        return;
    }
    const char *names = list_moving(r, logic);
    dalcs_diag_add(&r->s->diag, DALCS_WARNING, NULL, "a .tran shows how they change",
                   "gates do not settle at the operating point: %s", names == NULL ? "" : names);
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
        output[k] = circuit->results.measured[circuit->control.gate[logic->sample[k]].sampled];
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

static double read_probe(const struct dalcs_euler *e, const struct dalcs_probe *probe) {
    const struct dalcs_component *c = probe->system >= 0 ? &e->component[probe->system] : NULL;
    return c == NULL ? 0.0 : dalcs_probe_value(probe, c->y, c->u + c->system->n_x);
}

double dalcs_gates_read_output(const struct dalcs_euler *e, const struct dalcs_output *output) {
    return read_probe(e, &output->plus) - read_probe(e, &output->minus);
}

void dalcs_gates_read_euler(const struct dalcs_network *network, struct dalcs_logic_run *logic) {
    const struct dalcs_circuit *c = logic->circuit;
    for (int k = 0; k < logic->n_samples; k++) {
        const int gate = logic->sample[k];
        logic->taken[gate] = dalcs_gates_read_output(
            logic->euler, &network->output[c->results.measured[c->control.gate[gate].sampled]]);
    }
}

void dalcs_gate_samples_finish(struct dalcs_gate_samples *s) {
    if (s->are_there) {
        dalcs_rows_finish(&s->rows);
    }
}
