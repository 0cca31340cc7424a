/* reduce_outputs.c - probes and outputs of the network without z. */
#include "eliminate.h"

#include "network.h"

#include <stdlib.h>

static enum dalcs_status reduce_probe(const struct dalcs_elimination *all,
                                      const struct dalcs_probe *from, struct dalcs_network *network,
                                      struct dalcs_probe *to) {
    *to = *from;
    if (from->system < 0 || !all[from->system].is_regular) {
        return DALCS_OK;
    }
    const struct dalcs_elimination *z = &all[from->system];
    const struct dalcs_system *s = z->from;
    double *dense = dalcs_alloc(z->n_right, sizeof *dense);
    to->term = dalcs_arena_alloc(&network->arena, z->n_right, sizeof *to->term);
    if (dense == NULL || to->term == NULL) {
        free(dense);
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < from->n_terms + from->n_inputs; k++) {
        int c = from->term[k].index;
        double factor = from->term[k].coefficient;
        if (k >= from->n_terms) {
            dense[s->n_x + s->n_pairs + c] += factor;
        } else if (c < s->n_x || c >= dalcs_system_n_equations(s)) {
            dense[c < s->n_x ? c : c - s->n_z] += factor;
        } else {
            for (size_t j = 0; j < z->n_right; j++) {
                dense[j] += factor * z->Z[(size_t)(c - s->n_x) * z->n_right + j];
            }
        }
    }
    to->n_terms = 0;
    to->n_inputs = 0;
    for (int j = 0; j < (int)z->n_right; j++) {
        bool is_input = j >= s->n_x + s->n_pairs;
        if (dense[j] != 0.0) {
            to->term[to->n_terms + to->n_inputs] = (struct dalcs_probe_term){
                is_input ? j - s->n_x - s->n_pairs : dalcs_elimination_column(z, j), dense[j]};
            *(is_input ? &to->n_inputs : &to->n_terms) += 1;
        }
    }
    free(dense);
    to->system = to->n_terms + to->n_inputs > 0 ? from->system : -1;
    return DALCS_OK;
}

enum dalcs_status dalcs_eliminate_outputs(const struct dalcs_elimination *all,
                                          const struct dalcs_network *from,
                                          struct dalcs_network *to) {
    to->output = dalcs_arena_alloc(&to->arena, (size_t)from->n_outputs, sizeof *to->output);
    to->state = dalcs_arena_alloc(&to->arena, (size_t)from->n_states, sizeof *to->state);
    if (to->output == NULL || to->state == NULL) {
        return DALCS_E_NOMEM;
    }
    to->n_outputs = from->n_outputs;
    to->n_states = from->n_states;
    for (int i = 0; i < from->n_outputs; i++) {
        to->output[i] = from->output[i];
        DALCS_TRY(reduce_probe(all, &from->output[i].plus, to, &to->output[i].plus));
        DALCS_TRY(reduce_probe(all, &from->output[i].minus, to, &to->output[i].minus));
    }
    for (int i = 0; i < from->n_states; i++) {
        to->state[i] = from->state[i];
        DALCS_TRY(reduce_probe(all, &from->state[i].probe, to, &to->state[i].probe));
    }
    return DALCS_OK;
}
