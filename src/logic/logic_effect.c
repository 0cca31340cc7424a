/* logic_effect.c - on which parts of the circuit stimuli act. */
#include "logic_outputs.h"

#include "memory.h"

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
    e->reads = dalcs_alloc((size_t)l->euler->n_components, sizeof(*e->reads));
    e->looked = dalcs_alloc((size_t)l->euler->n_components, sizeof(*e->looked));
    e->disturbed = dalcs_alloc((size_t)l->euler->n_components, sizeof(*e->disturbed));
    if (e->changed == NULL || e->acts == NULL || e->first == NULL || e->reads == NULL ||
        e->looked == NULL || e->disturbed == NULL) {
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

static bool is_read_by_one_that_meets(const struct dalcs_logic_network *n, int source,
                                      const bool *meets) {
    bool is = false;
    for (int i = n->first_reader[source]; i < n->first_reader[source + 1] && !is; i++) {
        is = meets[n->reader[i]];
    }
    return is;
}

static bool acts_on_what_is_read(const struct dalcs_logic_effect *e, int stimulus) {
    bool acts = false;
    for (int i = stimulus >= 0 ? e->first[stimulus] : 0;
         stimulus >= 0 && i < e->first[stimulus + 1] && !acts; i++) {
        acts = e->reads[e->part[i]];
    }
    return acts;
}

/* Two inputs, or one and what a gate remembers, meet in it, or in one that what it shows passes at once. */
static bool meets_another(const struct dalcs_logic_run *l, int k, const bool *meets) {
    const struct dalcs_logic_gate *g = &l->network.gate[k];
    int n_wired = 0;
    for (int i = 0; i < g->n_inputs; i++) {
        n_wired += g->input[i].from != DALCS_GATE_OPEN ? 1 : 0;
    }
    if (n_wired > 1 || g->kind == DALCS_GATE_LATCH || dalcs_gate_has_clock(g)) {
        return true;
    }
    return !dalcs_gate_has_delay(g) && (is_read_by_one_that_meets(&l->network, k, meets) ||
                                        acts_on_what_is_read(&l->effect, g->output[0]) ||
                                        acts_on_what_is_read(&l->effect, g->output[1]));
}

static bool is_of_the_circuit(const struct dalcs_logic_run *l, const struct dalcs_logic_place *at) {
    const struct dalcs_positions *p = &l->euler->component[at->part].positions;
    bool is = false;
    for (int i = 0; i < p->n && !is; i++) {
        is = p->pair[i] == at->pair;
    }
    return is;
}

/* It counts when a comparator changes, against what else does at the instant, where its bit meets another one. */
enum dalcs_status dalcs_logic_effect_find_readers(struct dalcs_logic_run *l) {
    bool *meets = dalcs_alloc((size_t)l->network.n + 1, sizeof(*meets));
    if (meets == NULL) {
        return DALCS_E_NOMEM;
    }
    for (bool any = true; any;) {
        any = false;
        for (int k = l->network.n - 1; k >= 0; k--) {
            if (!meets[k] && meets_another(l, k, meets)) {
                any = meets[k] = true;
            }
        }
        for (int i = 0; i < l->n_comparators; i++) {
            bool *reads = &l->effect.reads[l->place[i].part];
            if (!*reads && is_read_by_one_that_meets(&l->network, l->network.n + i, meets) &&
                is_of_the_circuit(l, &l->place[i])) {
                any = *reads = true;
            }
        }
    }
    free(meets);
    return DALCS_OK;
}

void dalcs_logic_effect_finish(struct dalcs_logic_effect *e) {
    free(e->changed);
    free(e->acts);
    free(e->reads);
    free(e->looked);
    free(e->disturbed);
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
