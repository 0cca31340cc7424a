/* network_probes.c - how outputs and states are read from the columns of a network. */
#include "network_probes.h"

#include "current.h"
#include "stamp.h"

struct probe_terms {
    int n;
    struct dalcs_probe_term term[1];
};

static void put(struct probe_terms *t, int column, double coefficient) {
    if (column >= 0) {
        t->term[t->n++] = (struct dalcs_probe_term){column, coefficient};
    }
}

static enum dalcs_status keep_probe(struct dalcs_network *network, struct dalcs_probe *probe,
                                    int system, const struct dalcs_probe_term *term, int n_terms,
                                    int n_inputs) {
    if (n_terms + n_inputs == 0) {
        *probe = (struct dalcs_probe){.system = -1};
        return DALCS_OK;
    }
    *probe = (struct dalcs_probe){.system = system, .n_terms = n_terms, .n_inputs = n_inputs};
    size_t n = (size_t)(n_terms + n_inputs);
    probe->term = dalcs_arena_alloc(&network->arena, n, sizeof(*probe->term));
    if (probe->term == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n; k++) {
        probe->term[k] = term[k];
    }
    return DALCS_OK;
}

static enum dalcs_status current_probe(struct dalcs_network *network, const struct dalcs_layout *l,
                                       int device, struct dalcs_probe *probe) {
    int system = l->topology.device_component[device];
    if (system < 0) {
        return keep_probe(network, probe, -1, NULL, 0, 0);
    }
    struct dalcs_current current;
    DALCS_TRY(dalcs_layout_current(l, &network->system[system], device, &network->arena, &current));
    return keep_probe(network, probe, system, current.term, current.n_terms, current.n_inputs);
}

static enum dalcs_status node_probe(struct dalcs_network *network, const struct dalcs_layout *l,
                                    int node, struct dalcs_probe *probe) {
    struct probe_terms t = {0};
    put(&t, dalcs_stamp_node_column(l, node), 1.0);
    int system = l->topology.node_component[l->topology.node_of[node]];
    return keep_probe(network, probe, system, t.term, t.n, 0);
}

enum dalcs_status dalcs_network_build_outputs(struct dalcs_network *network,
                                              const struct dalcs_layout *l) {
    const struct dalcs_circuit *c = l->circuit;
    network->n_outputs = c->results.n_signals;
    network->output =
        dalcs_arena_alloc(&network->arena, (size_t)c->results.n_signals, sizeof(*network->output));
    if (network->output == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < c->results.n_signals; i++) {
        const struct dalcs_signal *signal = &c->results.signal[i];
        struct dalcs_output *out = &network->output[i];
        out->name = signal->name;
        out->is_current = signal->kind == DALCS_SIGNAL_CURRENT;
        out->plus.system = -1;
        out->minus.system = -1;
        if (out->is_current) {
            DALCS_TRY(current_probe(network, l, signal->device, &out->plus));
        } else {
            DALCS_TRY(node_probe(network, l, signal->node[0], &out->plus));
            DALCS_TRY(node_probe(network, l, signal->node[1], &out->minus));
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_network_build_states(struct dalcs_network *network,
                                             const struct dalcs_layout *l) {
    const struct dalcs_circuit *c = l->circuit;
    for (int i = 0; i < c->n_devices; i++) {
        network->n_states +=
            c->device[i].kind == DALCS_CAPACITOR || c->device[i].kind == DALCS_INDUCTOR ? 1 : 0;
    }
    network->state =
        dalcs_arena_alloc(&network->arena, (size_t)network->n_states, sizeof(*network->state));
    if (network->state == NULL) {
        return DALCS_E_NOMEM;
    }
    int k = 0;
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        if (d->kind == DALCS_CAPACITOR) {
            struct dalcs_state *state = &network->state[k++];
            state->element = d->name;
            struct probe_terms t = {0};
            put(&t, l->state_column[i], 1.0);
            DALCS_TRY(keep_probe(network, &state->probe, l->topology.device_component[i], t.term,
                                 t.n, 0));
        } else if (d->kind == DALCS_INDUCTOR) {
            struct dalcs_state *state = &network->state[k++];
            state->element = d->name;
            state->is_current = true;
            DALCS_TRY(current_probe(network, l, i, &state->probe));
        }
    }
    return DALCS_OK;
}
