/* set_state.c - states that a program gives for the start of a run. */
#include "session_internal.h"

#include "lower_case.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct dalcs_device *find_storage(const struct dalcs_circuit *c, const char *name) {
    struct dalcs_device *found = NULL;
    for (int d = 0; d < c->n_devices && found == NULL; d++) {
        const enum dalcs_device_kind kind = c->device[d].kind;
        const bool stores = kind == DALCS_CAPACITOR || kind == DALCS_INDUCTOR;
        found = stores && strcmp(c->device[d].name, name) == 0 ? &c->device[d] : NULL;
    }
    return found;
}

static const char *nearest_storage(const struct dalcs_circuit *c, const char *name) {
    const char *nearest = NULL;
    for (int d = 0; d < c->n_devices && nearest == NULL; d++) {
        const enum dalcs_device_kind kind = c->device[d].kind;
        if (kind == DALCS_CAPACITOR || kind == DALCS_INDUCTOR) {
            nearest = dalcs_names_nearest_of(&c->device[d].name, 1, name);
        }
    }
    return nearest;
}

static enum dalcs_status refuse(struct dalcs_session *s, const char *name) {
    const char *nearest = nearest_storage(&s->circuit, name);
    char *hint =
        nearest != NULL ? dalcs_arena_printf(&s->arena, "did you mean '%s'?", nearest) : NULL;
    dalcs_diag_add(&s->diag, DALCS_ERROR, NULL, hint,
                   "there is no capacitor and no coil '%s' whose state could be set", name);
    return DALCS_E_OPTION;
}

enum dalcs_status dalcs_session_set_state(struct dalcs_session *session, const char *element,
                                          double value) {
    if (!session->source.has_netlist || !isfinite(value)) {
        dalcs_diag_add(
            &session->diag, DALCS_ERROR, NULL, session->source.has_netlist ? NULL : DALCS_KEEP_HINT,
            session->source.has_netlist ? "the state of '%s' cannot be %g"
                                        : "the state of '%s' cannot be set to %g: no netlist was "
                                          "read that keeps its cards",
            element, value);
        return DALCS_E_OPTION;
    }
    char *name = dalcs_arena_copy(&session->arena, element, strlen(element));
    if (name == NULL) {
        return DALCS_E_NOMEM;
    }
    if (find_storage(&session->circuit, dalcs_lower_text(name)) == NULL) {
        return refuse(session, name);
    }
    size_t at = 0;
    while (at < session->initial.n && strcmp(session->initial.state[at].element, name) != 0) {
        at++;
    }
    DALCS_TRY(dalcs_grow(&session->initial.state, &session->initial.capacity, at + 1,
                         sizeof(*session->initial.state)));
    session->initial.state[at] = (struct dalcs_set_state){name, value};
    session->initial.n = at == session->initial.n ? at + 1 : session->initial.n;
    session->source.is_altered = true;
    return DALCS_OK;
}

void dalcs_session_apply_states(const struct dalcs_session *session,
                                struct dalcs_circuit *circuit) {
    for (size_t k = 0; k < session->initial.n; k++) {
        struct dalcs_device *d = find_storage(circuit, session->initial.state[k].element);
        if (d != NULL) {
            d->initial = session->initial.state[k].value;
            d->has_initial = true;
            circuit->analyses.transient.use_initial_conditions = true;
        }
    }
}
