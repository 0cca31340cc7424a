/* logic_effect.c - on which parts of the circuit stimuli act. */
#include "logic_outputs.h"

#include <stdlib.h>
#include <string.h>

/* Calls what is done for each stimulus of the circuit that s is made of, itself or in its formula. */
static void visit(const struct dalcs_circuit *circuit, const struct dalcs_stimulus *s, int *next,
                  int *part, int k) {
    const struct dalcs_stimulus *first = circuit->stimulus;
    if (s >= first && s < first + circuit->n_stimuli) {
        const int at = next[s - first]++;
        if (part != NULL) {
            part[at] = k;
        }
    }
    for (int i = 0; s->kind == DALCS_STIMULUS_FORMULA && i < s->u.formula.argument.n; i++) {
        visit(circuit, s->u.formula.argument.part[i].of, next, part, k);
    }
}

/* part NULL: counts. */
static void visit_all(const struct dalcs_logic_run *l, int *next, int *part) {
    for (int k = 0; k < l->euler->n_components; k++) {
        const struct dalcs_system *s = l->euler->component[k].system;
        for (int i = 1; i < s->n_inputs; i++) {
            if (s->stimulus[i] >= 0) {
                visit(l->circuit, &l->circuit->stimulus[s->stimulus[i]], next, part, k);
            }
        }
    }
}

enum dalcs_status dalcs_logic_effect_setup(struct dalcs_logic_run *l) {
    struct dalcs_logic_effect *e = &l->effect;
    const int n = l->circuit->n_stimuli;
    e->changed = dalcs_alloc((size_t)n, sizeof(*e->changed));
    e->acts = dalcs_alloc((size_t)l->euler->n_components, sizeof(*e->acts));
    e->first = dalcs_alloc((size_t)n + 2, sizeof(*e->first));
    if (e->changed == NULL || e->acts == NULL || e->first == NULL) {
        return DALCS_E_NOMEM;
    }
    int *next = e->first + 1; /* of a stimulus, behind those before it */
    visit_all(l, next + 1, NULL);
    for (int k = 0; k < n; k++) {
        next[k + 1] += next[k];
    }
    e->part = dalcs_alloc((size_t)next[n] + 1, sizeof(*e->part));
    if (e->part == NULL) {
        return DALCS_E_NOMEM;
    }
    visit_all(l, next, e->part);
    return DALCS_OK;
}

void dalcs_logic_effect_finish(struct dalcs_logic_effect *e) {
    free(e->changed);
    free(e->acts);
    free(e->first);
    free(e->part);
    *e = (struct dalcs_logic_effect){0};
}

void dalcs_logic_effect_begin(struct dalcs_logic_run *l) {
    memset(l->effect.changed, 0, (size_t)l->circuit->n_stimuli * sizeof(bool));
    memset(l->effect.acts, 0, (size_t)l->euler->n_components * sizeof(bool));
}

void dalcs_logic_effect_note(struct dalcs_logic_run *l, int stimulus) {
    struct dalcs_logic_effect *e = &l->effect;
    e->changed[stimulus] = true;
    for (int i = e->first[stimulus]; i < e->first[stimulus + 1]; i++) {
        e->acts[e->part[i]] = true;
    }
}
