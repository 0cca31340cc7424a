/* steps.c - one netlist, several circuits: .step and what alter changes.
 *
 * A step is the netlist expanded again with other values; no other file depends on .step. */
#include "session_internal.h"

#include "source_conflicts.h"

#include <stdlib.h>
#include <string.h>

static const char *copy_text(struct dalcs_arena *arena, const char *text, bool *complete) {
    const char *copy = text != NULL ? dalcs_arena_copy(arena, text, strlen(text)) : NULL;
    *complete = *complete && (text == NULL || copy != NULL);
    return copy;
}

static bool copy_sweep(struct dalcs_arena *arena, const struct dalcs_sweep *from,
                       struct dalcs_sweep *to) {
    bool complete = true;
    *to = *from;
    to->where = (struct dalcs_location){0}; /* of the circuit, which goes */
    to->name = copy_text(arena, from->name, &complete);
    to->field = copy_text(arena, from->field, &complete);
    to->label = copy_text(arena, from->label, &complete);
    if (from->spacing == DALCS_LISTED) {
        double *list = dalcs_arena_alloc(arena, (size_t)from->n, sizeof *list);
        if (list != NULL) {
            memcpy(list, from->list, (size_t)from->n * sizeof *list);
        }
        to->list = list;
        complete = complete && list != NULL;
    }
    return complete;
}

enum dalcs_status dalcs_steps_find(struct dalcs_session *session) {
    const struct dalcs_circuit *circuit = &session->circuit;
    struct dalcs_steps *steps = &session->source.steps;
    struct dalcs_arena *arena = &session->arena;
    if (steps->is_known) {
        return DALCS_OK;
    }
    *steps = (struct dalcs_steps){.n = circuit->analyses.n_steps,
                                  .n_drawn = (size_t)circuit->random.n_drawn};
    steps->sweep = dalcs_arena_alloc(arena, (size_t)steps->n, sizeof *steps->sweep);
    steps->drawn = dalcs_arena_alloc(arena, steps->n_drawn, sizeof *steps->drawn);
    bool complete = steps->sweep != NULL && steps->drawn != NULL;
    for (int k = 0; k < steps->n && complete; k++) {
        complete = copy_sweep(arena, &circuit->analyses.step[k], &steps->sweep[k]);
    }
    for (size_t k = 0; k < steps->n_drawn && complete; k++) {
        const char *name = circuit->random.drawn[k].name;
        steps->drawn[k] = dalcs_arena_copy(arena, name, strlen(name));
        complete = steps->drawn[k] != NULL;
    }
    steps->is_known = complete;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

size_t dalcs_steps_count(const struct dalcs_session *session) {
    const bool is_known = session->source.steps.is_known;
    const struct dalcs_sweep *sweep =
        is_known ? session->source.steps.sweep : session->circuit.analyses.step;
    const int n_sweeps = is_known ? session->source.steps.n : session->circuit.analyses.n_steps;
    size_t n = 1;
    for (int k = 0; k < n_sweeps; k++) {
        n *= (size_t)sweep[k].n;
    }
    return n;
}

bool dalcs_override_of(const struct dalcs_sweep *sweep, double value,
                       struct dalcs_override *override) {
    static const enum dalcs_override_kind kind[] = {
        [DALCS_SWEEP_ELEMENT] = DALCS_OVERRIDE_ELEMENT,
        [DALCS_SWEEP_TEMPERATURE] = DALCS_OVERRIDE_PARAMETER,
        [DALCS_SWEEP_PARAMETER] = DALCS_OVERRIDE_PARAMETER,
        [DALCS_SWEEP_MODEL] = DALCS_OVERRIDE_MODEL};

    if (sweep->target == DALCS_SWEEP_RUN) {
        return false;
    }
    *override = (struct dalcs_override){
        .kind = kind[sweep->target], .name = sweep->name, .field = sweep->field, .value = value};
    return true;
}

static bool was_said(const struct dalcs_diag *diag, const char *text) {
    for (size_t k = 0; k < diag->n; k++) {
        if (strcmp(diag->item[k].text, text) == 0) {
            return true;
        }
    }
    return false;
}

/* Messages of a circuit that is built once more; most of them have been said. */
static void take_messages(struct dalcs_session *s, const struct dalcs_diag *diag) {
    s->source.why_unbuilt = NULL;
    for (size_t k = 0; k < diag->n; k++) {
        if (diag->item[k].severity == DALCS_ERROR && s->source.why_unbuilt == NULL) {
            s->source.why_unbuilt =
                dalcs_arena_copy(&s->arena, diag->item[k].text, strlen(diag->item[k].text));
        }
        if (!was_said(&s->diag, diag->item[k].text)) {
            dalcs_diag_add_text(&s->diag, diag->item[k].severity, diag->item[k].text);
        }
    }
    s->diag.out_of_memory = s->diag.out_of_memory || diag->out_of_memory;
}

/* The changes of alter, of the present step and `more`; heap, NULL: out of memory. */
static struct dalcs_override *all_overrides(const struct dalcs_session *session,
                                            const struct dalcs_override *more, size_t n_more,
                                            size_t *n_all) {
    struct dalcs_override *all =
        dalcs_alloc(session->source.n_altered + session->source.n_own + n_more + 1, sizeof *all);
    size_t n = 0;
    for (size_t k = 0; all != NULL && k < session->source.n_altered; k++) {
        all[n++] = session->source.override[k];
    }
    if (all != NULL && session->source.n_resets > 0) {
        all[n++] = (struct dalcs_override){
            .kind = DALCS_OVERRIDE_RUN, .name = "", .value = (double)session->source.n_resets + 1};
    }
    for (size_t k = 0; all != NULL && k < session->source.n_own; k++) {
        all[n++] = session->source.own[k];
    }
    for (size_t k = 0; all != NULL && k < n_more; k++) {
        all[n++] = more[k];
    }
    *n_all = n;
    return all;
}

enum dalcs_status dalcs_session_build(struct dalcs_session *session,
                                      const struct dalcs_override *more, size_t n_more,
                                      struct dalcs_circuit *circuit,
                                      struct dalcs_network *network) {
    struct dalcs_diag diag = {0};
    size_t n;
    struct dalcs_override *all = all_overrides(session, more, n_more, &n);
    if (all == NULL) {
        return DALCS_E_NOMEM;
    }
    enum dalcs_status status =
        dalcs_circuit_build_with(circuit, &session->source.netlist, all, n, &diag);
    if (status == DALCS_OK) {
        dalcs_session_apply_states(session, circuit);
        status = dalcs_source_conflicts(circuit, &diag);
        if (status == DALCS_OK) {
            const struct dalcs_network_options options = {
                .silent = true,
                .with_readout = dalcs_circuit_is_audited(circuit) || session->asks.steady};
            status = dalcs_network_build(network, circuit, &options, &diag);
        }
        if (status != DALCS_OK) {
            dalcs_circuit_finish(circuit);
        }
    }
    if (status == DALCS_E_NETLIST && circuit == &session->circuit) {
        status = dalcs_drawn_keep_unbuilt(session, all, n);
    }
    free(all);
    take_messages(session, &diag);
    dalcs_diag_finish(&diag);
    return status;
}

/* The names of the overrides may be of the circuit that goes. */
static enum dalcs_status keep_own(struct dalcs_session *session, const struct dalcs_override *more,
                                  size_t n_more) {
    struct dalcs_override *own = dalcs_alloc(n_more, sizeof *own);
    bool complete = own != NULL;
    for (size_t k = 0; k < n_more && complete; k++) {
        own[k] = more[k];
        own[k].name = copy_text(&session->arena, more[k].name, &complete);
        own[k].field = copy_text(&session->arena, more[k].field, &complete);
    }
    if (!complete) {
        free(own);
        return DALCS_E_NOMEM;
    }
    free(session->source.own);
    session->source.own = own;
    session->source.n_own = n_more;
    return DALCS_OK;
}

enum dalcs_status dalcs_session_rebuild(struct dalcs_session *session,
                                        const struct dalcs_override *more, size_t n_more) {
    dalcs_session_forget_run(session);
    session->source.n_unbuilt = 0;
    DALCS_TRY(keep_own(session, more, n_more));
    if (session->has_network) {
        dalcs_network_finish(&session->network);
        session->has_network = false;
    }
    if (session->has_circuit) {
        dalcs_circuit_finish(&session->circuit);
        session->has_circuit = false;
    }
    const enum dalcs_status status =
        dalcs_session_build(session, NULL, 0, &session->circuit, &session->network);
    session->has_circuit = session->has_network = status == DALCS_OK;
    session->source.is_altered = session->source.is_altered || status != DALCS_OK;
    return status;
}

const char *dalcs_session_step_parameter(const struct dalcs_session *session, size_t step,
                                         size_t index, double *value) {
    const bool is_known = session->source.steps.is_known;
    const struct dalcs_sweep *sweep =
        is_known ? session->source.steps.sweep : session->circuit.analyses.step;
    const size_t n =
        (size_t)(is_known ? session->source.steps.n : session->circuit.analyses.n_steps);
    if (step >= dalcs_steps_count(session) || index >= n) {
        return NULL;
    }
    for (size_t i = 0; i < index; i++) {
        step /= (size_t)sweep[i].n;
    }
    *value = dalcs_sweep_value(&sweep[index], (int)(step % (size_t)sweep[index].n));
    return sweep[index].label;
}

/* The run of step k: that of .mc, so that all other steps meet the same draws, else one for each step. */
static size_t run_of(const struct dalcs_steps *steps, size_t k) {
    size_t rest = k;
    for (int i = 0; i < steps->n; i++) {
        const size_t n = (size_t)steps->sweep[i].n;
        if (steps->sweep[i].target == DALCS_SWEEP_RUN) {
            return rest % n + 1;
        }
        rest /= n;
    }
    return k + 1;
}

/* Names and values of the step's parameters. */
static enum dalcs_status describe_step(struct dalcs_session *session, size_t k,
                                       struct dalcs_plot *plot) {
    const size_t n = (size_t)session->source.steps.n;
    const char **name = dalcs_arena_alloc(&session->arena, n, sizeof *name);
    double *value = dalcs_arena_alloc(&session->arena, n, sizeof *value);
    if (name == NULL || value == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t i = 0; i < n; i++) {
        name[i] = dalcs_session_step_parameter(session, k, i, &value[i]);
    }
    *plot = (struct dalcs_plot){.step = k,
                                .n_steps = dalcs_steps_count(session),
                                .n_parameters = n,
                                .parameter = name,
                                .parameter_value = value};
    return DALCS_OK;
}

enum dalcs_status dalcs_session_take_step(struct dalcs_session *session, size_t k,
                                          struct dalcs_plot *plot) {
    const struct dalcs_steps *steps = &session->source.steps;
    DALCS_TRY(dalcs_steps_find(session));
    DALCS_TRY(describe_step(session, k, plot));
    struct dalcs_override *override = dalcs_alloc((size_t)steps->n + 1, sizeof *override);
    if (override == NULL) {
        return DALCS_E_NOMEM;
    }
    size_t n = 0;
    for (size_t i = 0; i < plot->n_parameters; i++) {
        n += dalcs_override_of(&steps->sweep[i], plot->parameter_value[i], &override[n]) ? 1 : 0;
    }
    override[n++] = (struct dalcs_override){
        .kind = DALCS_OVERRIDE_RUN, .name = "", .value = (double)run_of(steps, k), .is_step = true};
    const enum dalcs_status status = dalcs_session_rebuild(session, override, n);
    free(override);
    return status;
}
