/* steps.c - one netlist, several circuits: .step and what alter changes.
 *
 * A step is the netlist expanded again with other values; nothing else knows of it. */
#include "session_internal.h"

#include "source_conflicts.h"

#include <stdlib.h>
#include <string.h>

size_t dalcs_steps_count(const struct dalcs_circuit *circuit) {
    size_t n = 1;
    for (int k = 0; k < circuit->n_steps; k++) {
        n *= (size_t)circuit->step[k].n;
    }
    return n;
}

bool dalcs_override_of(const struct dalcs_sweep *sweep, double value,
                       struct dalcs_override *override) {
    static const enum dalcs_override_kind kind[] = {[DALCS_SWEEP_ELEMENT] = DALCS_OVERRIDE_ELEMENT,
                                                    [DALCS_SWEEP_PARAMETER] =
                                                        DALCS_OVERRIDE_PARAMETER,
                                                    [DALCS_SWEEP_MODEL] = DALCS_OVERRIDE_MODEL};

    if (sweep->target == DALCS_SWEEP_TEMPERATURE) {
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
    for (size_t k = 0; k < diag->n; k++) {
        if (!was_said(&s->diag, diag->item[k].text)) {
            dalcs_diag_add_text(&s->diag, diag->item[k].severity, diag->item[k].text);
        }
    }
    s->diag.out_of_memory = s->diag.out_of_memory || diag->out_of_memory;
}

enum dalcs_status dalcs_session_build(struct dalcs_session *session,
                                      const struct dalcs_override *more, size_t n_more,
                                      struct dalcs_circuit *circuit,
                                      struct dalcs_network *network) {
    struct dalcs_diag diag = {0};
    const size_t n = session->n_altered + n_more;
    struct dalcs_override *all = dalcs_alloc(n, sizeof *all);
    if (all == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n; k++) {
        all[k] = k < session->n_altered ? session->override[k] : more[k - session->n_altered];
    }
    enum dalcs_status status = dalcs_circuit_build_with(circuit, &session->netlist, all, n, &diag);
    free(all);
    if (status == DALCS_OK) {
        status = dalcs_source_conflicts(circuit, &diag);
        if (status == DALCS_OK) {
            const struct dalcs_network_options options = {
                .silent = true,
                .with_readout = dalcs_circuit_has_waves(circuit) || session->asks_steady};
            status = dalcs_network_build(network, circuit, &options, &diag);
        }
        if (status != DALCS_OK) {
            dalcs_circuit_finish(circuit);
        }
    }
    take_messages(session, &diag);
    dalcs_diag_finish(&diag);
    return status;
}

enum dalcs_status dalcs_session_rebuild(struct dalcs_session *session,
                                        const struct dalcs_override *more, size_t n_more) {
    dalcs_session_forget_run(session);
    struct dalcs_override *own = dalcs_alloc(n_more, sizeof *own);
    bool complete = own != NULL;
    /* The names of the overrides may be of the circuit that goes. */
    for (size_t k = 0; k < n_more && complete; k++) {
        own[k] = more[k];
        own[k].name = dalcs_arena_copy(&session->arena, more[k].name, strlen(more[k].name));
        complete = own[k].name != NULL;
        if (complete && more[k].field != NULL) {
            own[k].field = dalcs_arena_copy(&session->arena, more[k].field, strlen(more[k].field));
            complete = own[k].field != NULL;
        }
    }
    if (session->has_network && complete) {
        dalcs_network_finish(&session->network);
        session->has_network = false;
    }
    if (session->has_circuit && complete) {
        dalcs_circuit_finish(&session->circuit);
        session->has_circuit = false;
    }
    enum dalcs_status status = DALCS_E_NOMEM;
    if (complete) {
        status = dalcs_session_build(session, own, n_more, &session->circuit, &session->network);
        session->has_circuit = session->has_network = status == DALCS_OK;
        session->is_altered = session->is_altered || status != DALCS_OK;
    }
    free(own);
    return status;
}

const char *dalcs_session_step_parameter(const struct dalcs_session *session, size_t step,
                                         size_t index, double *value) {
    const struct dalcs_circuit *circuit = &session->circuit;
    if (step >= dalcs_steps_count(circuit) || index >= (size_t)circuit->n_steps) {
        return NULL;
    }
    for (size_t i = 0; i < index; i++) {
        step /= (size_t)circuit->step[i].n;
    }
    const struct dalcs_sweep *sweep = &circuit->step[index];
    *value = dalcs_sweep_value(sweep, (int)(step % (size_t)sweep->n));
    return sweep->label;
}

enum dalcs_status dalcs_session_take_step(struct dalcs_session *session, size_t k,
                                          struct dalcs_plot *plot) {
    const struct dalcs_circuit *circuit = &session->circuit;
    const size_t n = (size_t)circuit->n_steps;
    struct dalcs_arena *arena = &session->arena;
    struct dalcs_override *override = dalcs_alloc(n, sizeof *override);
    const char **name = dalcs_arena_alloc(arena, n, sizeof *name);
    double *value = dalcs_arena_alloc(arena, n, sizeof *value);
    bool complete = override != NULL && name != NULL && value != NULL;
    size_t n_overrides = 0;
    *plot = (struct dalcs_plot){.step = k,
                                .n_steps = dalcs_steps_count(circuit),
                                .n_parameters = n,
                                .parameter = name,
                                .parameter_value = value};
    for (size_t i = 0; i < n && complete; i++) {
        const struct dalcs_sweep *sweep = &circuit->step[i];
        value[i] = dalcs_sweep_value(sweep, (int)(k % (size_t)sweep->n));
        k /= (size_t)sweep->n;
        name[i] = dalcs_arena_copy(arena, sweep->label, strlen(sweep->label));
        complete = name[i] != NULL;
        n_overrides += dalcs_override_of(sweep, value[i], &override[n_overrides]) ? 1 : 0;
    }
    const enum dalcs_status status =
        complete ? dalcs_session_rebuild(session, override, n_overrides) : DALCS_E_NOMEM;
    free(override);
    return status;
}
