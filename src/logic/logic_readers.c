/* logic_readers.c - who reads what of a network of gates, and the memory of its rounds. */
#include "logic_network.h"

#include "memory.h"

#include <stdlib.h>

enum dalcs_status dalcs_logic_set_setup(struct dalcs_logic_set *set, int n_gates) {
    set->gate = dalcs_alloc((size_t)n_gates + 1, sizeof(*set->gate));
    set->has = dalcs_alloc((size_t)n_gates + 1, sizeof(*set->has));
    return set->gate != NULL && set->has != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

void dalcs_logic_set_finish(struct dalcs_logic_set *set) {
    free(set->gate);
    free(set->has);
    *set = (struct dalcs_logic_set){0};
}

/* -1: a pin that is open. */
static int source_of(const struct dalcs_logic_network *l, const struct dalcs_logic_input *input) {
    return input->from == DALCS_GATE_GATE         ? input->index
           : input->from == DALCS_GATE_COMPARATOR ? l->n + input->index
                                                  : -1;
}

/* By counting, then by places. */
static enum dalcs_status list_readers(struct dalcs_logic_network *l, int n_comparators) {
    const int n_sources = l->n + n_comparators;
    l->first_reader = dalcs_alloc((size_t)n_sources + 2, sizeof(*l->first_reader));
    if (l->first_reader == NULL) {
        return DALCS_E_NOMEM;
    }
    int *count = l->first_reader + 1; /* of a source, behind those before it */
    for (int k = 0; k < l->n; k++) {
        for (int i = 0; i < l->gate[k].n_inputs; i++) {
            const int source = source_of(l, &l->gate[k].input[i]);
            if (source >= 0) {
                count[source + 1]++;
            }
        }
    }
    for (int source = 0; source < n_sources; source++) {
        count[source + 1] += count[source];
    }
    l->reader = dalcs_alloc((size_t)count[n_sources] + 1, sizeof(*l->reader));
    if (l->reader == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < l->n; k++) {
        for (int i = 0; i < l->gate[k].n_inputs; i++) {
            const int source = source_of(l, &l->gate[k].input[i]);
            if (source >= 0) {
                l->reader[count[source]++] = k;
            }
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_logic_network_setup(struct dalcs_logic_network *l, int n_comparators) {
    const size_t n = (size_t)l->n + 1;
    l->state = dalcs_alloc(n, sizeof(*l->state));
    l->next = dalcs_alloc(n, sizeof(*l->next));
    l->mark = dalcs_alloc(n, sizeof(*l->mark));
    l->moves = dalcs_alloc(n, sizeof(*l->moves));
    l->was = dalcs_alloc(n + (size_t)n_comparators, sizeof(*l->was));
    if (l->was == NULL || l->state == NULL || l->next == NULL || l->mark == NULL ||
        l->moves == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(list_readers(l, n_comparators));
    DALCS_TRY(dalcs_logic_set_setup(&l->asked, l->n));
    DALCS_TRY(dalcs_logic_set_setup(&l->round, l->n));
    DALCS_TRY(dalcs_logic_set_setup(&l->marked, l->n));
    DALCS_TRY(dalcs_logic_set_setup(&l->moved, l->n));
    dalcs_logic_touch_all(l);
    return DALCS_OK;
}

void dalcs_logic_network_finish(struct dalcs_logic_network *l) {
    free(l->state);
    free(l->next);
    free(l->mark);
    free(l->moves);
    free(l->was);
    free(l->first_reader);
    free(l->reader);
    dalcs_logic_set_finish(&l->asked);
    dalcs_logic_set_finish(&l->round);
    dalcs_logic_set_finish(&l->marked);
    dalcs_logic_set_finish(&l->moved);
    *l = (struct dalcs_logic_network){0};
}
