/* logic_setup.c - what logic keeps during a run: set up and given back. */
#include "logic_outputs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* All switches by their names. */
static enum dalcs_status list_switches(const struct dalcs_euler *euler, struct dalcs_names *names,
                                       struct dalcs_logic_place **place) {
    size_t capacity = 0;
    for (int part = 0; part < euler->n_components; part++) {
        const struct dalcs_system *s = euler->component[part].system;
        for (int d = 0; d < s->n_pairs; d++) {
            if (s->pair[d].kind == DALCS_PAIR_SWITCH) {
                const size_t n = names->n;
                DALCS_TRY(dalcs_grow(place, &capacity, n + 1, sizeof(**place)));
                (*place)[n] = (struct dalcs_logic_place){part, d};
                DALCS_TRY(dalcs_names_set(names, s->pair[d].element, (int)n));
            }
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_logic_find_comparators(const struct dalcs_circuit *circuit,
                                               const struct dalcs_euler *euler,
                                               struct dalcs_logic_place *place) {
    struct dalcs_names names = {0};
    struct dalcs_logic_place *all = NULL;
    enum dalcs_status status = list_switches(euler, &names, &all);
    for (int k = 0; k < circuit->control.n_comparators && status == DALCS_OK; k++) {
        const int at =
            dalcs_names_find(&names, circuit->device[circuit->control.comparator[k]].name);
        status = at >= 0 ? DALCS_OK : DALCS_E_INTERNAL;
        place[k] = at >= 0 ? all[at] : (struct dalcs_logic_place){0};
    }
    dalcs_names_finish(&names);
    free(all);
    return status;
}

static enum dalcs_status allocate(struct dalcs_logic_run *l) {
    const size_t n = (size_t)l->circuit->control.n_gates;
    const size_t n_comparators = (size_t)l->circuit->control.n_comparators;
    const size_t n_stimuli = (size_t)l->circuit->n_stimuli;
    l->bit = dalcs_alloc(n_comparators + 1, sizeof(*l->bit));
    l->change = dalcs_alloc(n_comparators + 1, sizeof(*l->change));
    l->place = dalcs_alloc(n_comparators + 1, sizeof(*l->place));
    l->output = dalcs_alloc(n, sizeof(*l->output));
    l->sample = dalcs_alloc(n, sizeof(*l->sample));
    l->pulse = dalcs_alloc(n, sizeof(*l->pulse));
    l->taken = dalcs_alloc(n, sizeof(*l->taken));
    l->as_built = dalcs_alloc(n_stimuli, sizeof(*l->as_built));
    bool complete = l->bit != NULL && l->change != NULL && l->place != NULL && l->output != NULL &&
                    l->sample != NULL && l->pulse != NULL && l->taken != NULL &&
                    l->as_built != NULL;
    if (complete) {
        memcpy(l->as_built, l->circuit->stimulus, n_stimuli * sizeof(*l->as_built));
    }
    DALCS_TRY(complete ? DALCS_OK : DALCS_E_NOMEM);
    DALCS_TRY(dalcs_logic_effect_setup(l));
    l->network.bit = l->bit;
    DALCS_TRY(dalcs_logic_set_setup(&l->waits, l->network.n));
    return dalcs_logic_network_setup(&l->network, l->n_comparators);
}

enum dalcs_status dalcs_logic_run_setup(struct dalcs_logic_run *l, struct dalcs_circuit *circuit,
                                        struct dalcs_euler *euler, struct dalcs_radau *radau) {
    *l = (struct dalcs_logic_run){.euler = euler, .radau = radau};
    if (circuit->control.n_gates == 0 && circuit->control.n_externals == 0) {
        return DALCS_OK;
    }
    l->circuit = circuit;
    if (radau != NULL) {
        radau->decider =
            (struct dalcs_radau_decider){.user = l, .decide = dalcs_logic_decide_early};
    }
    l->n_comparators = circuit->control.n_comparators;
    l->network.n = circuit->control.n_gates;
    l->network.gate = circuit->control.gate;
    enum dalcs_status status = allocate(l);
    status = status == DALCS_OK ? dalcs_logic_find_comparators(circuit, euler, l->place) : status;
    status = status == DALCS_OK ? dalcs_logic_effect_find_readers(l) : status;
    for (int k = 0; k < l->network.n && status == DALCS_OK; k++) {
        struct dalcs_logic_state *state = &l->network.state[k];
        state->q = state->seen = circuit->control.gate[k].initial;
        state->count = circuit->control.gate[k].first;
        l->output[k].ends = INFINITY;
        if (circuit->control.gate[k].sampled >= 0) {
            l->sample[l->n_samples++] = k;
        }
        if (circuit->control.gate[k].kind == DALCS_GATE_MONOSTABLE) {
            l->pulse[l->n_pulses++] = k;
        }
    }
    if (status != DALCS_OK) {
        dalcs_logic_run_finish(l);
    }
    return status;
}

void dalcs_logic_run_finish(struct dalcs_logic_run *l) {
    for (int k = 0; l->output != NULL && k < l->network.n; k++) {
        struct dalcs_logic_output *o = &l->output[k];
        free(o->time);
        free(o->value);
        free(o->time_bar);
        free(o->value_bar);
        free(o->due);
    }
    if (l->as_built != NULL) {
        memcpy(l->circuit->stimulus, l->as_built,
               (size_t)l->circuit->n_stimuli * sizeof(*l->as_built));
    }
    free(l->bit);
    free(l->change);
    free(l->place);
    free(l->output);
    free(l->sample);
    free(l->pulse);
    free(l->taken);
    dalcs_logic_effect_finish(&l->effect);
    free(l->as_built);
    dalcs_logic_set_finish(&l->waits);
    dalcs_logic_network_finish(&l->network);
    if (l->radau != NULL) {
        l->radau->decider = (struct dalcs_radau_decider){0};
    }
    *l = (struct dalcs_logic_run){0};
}
